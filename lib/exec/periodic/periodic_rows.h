// The rows of a scene with periodic axes: those of particles, and those of images.
//
// At every sort the particles are put into the domain, and those within the range of pairs of a
// periodic face get images beyond the other one. What is copied to them, and when, follows from the
// declarations of passes (lib/program/exchanges.h), as between ranks: a scene is its own neighbor.
// Passes run for particles alone. All rows are in the memory of an executor.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "kernels/pass_images.h"
#include "lib/base/error.h"
#include "lib/program/exchanges.h"
#include "lib/program/features/solids.h"

namespace pbf::PBF_VARIANT {

template <class Exec>
class PeriodicRows {
 public:
  int particles() const { return particles_; }
  int all() const { return all_; }                  ///< rows, with those of images
  int before_sort() const { return before_sort_; }  ///< rows before the last sort
  /// The ids of all rows if some are images, else null.
  const int* ids() const { return images_ > 0 ? ids_ : nullptr; }
  /// Whether the last before() has copied anything.
  bool copied() const { return copied_; }

  std::size_t bytes() const {
    return list_.bytes() + next_.bytes() + row_of_.bytes() + count_.bytes();
  }

  /// Rows 0 ... n - 1 are all particles, and there are no images.
  void begin(int n) { particles_ = all_ = n, images_ = 0; }
  template <class C>
  void all_own(C& c, int n) {
    begin(n);
    forget_near(c);
  }
  /// Puts the particles into the domain. To be called before each update, and before a state is
  /// read, so that updates have the same bits whether or not it is.
  template <class C>
  void wrap(C& c) {
    c.exec.items(c.rows(), WrapRowsPass<typename C::Real>{c.p.period, c.position()});
  }
  /// Whether there are images. The next sort then leaves them out, and makes none.
  template <class C>
  bool leave(C& c) {
    if (images_ == 0) return false;
    forget_near(c);
    return leaves_ = true;
  }

  /// Before each launch of pass P: copies what it needs to the images, and makes those of a sort.
  template <class P, class C>
  void before(C& c) {
    const Program& program = c.plan.program;
    const PassInfo& pass = program.passes[std::size_t(C::Passes::template index_of<P>())];
    const Exchange e = fresh_.before(pass, !c.iterating || c.iteration == 0, program);
    copied_ = images_ > 0 && !e.ghosts.empty();
    for (const FieldInfo* f : pass.flips) c.flip(*f);  // named as they are after the flips
    if (copied_) copy(c, e.ghosts);
    for (const FieldInfo* f : pass.flips) c.flip(*f);
    sorts_ = !e.rows.empty();
    if (sorts_) make(c, e.rows);
  }
  /// After it.
  template <class C>
  void after(C& c) {
    if (sorts_) find(c);
    sorts_ = false;
  }

 private:
  using Fields = Exchange::Fields;
  template <class T>
  using Buffer = typename Exec::template Buffer<T>;

  /// No row counts as near a solid: the features mark those that they know of.
  template <class C>
  static void forget_near(C& c) {
    auto* way = c.data(field::near_way_left);
    if (!way) return;
    c.exec.clear(reinterpret_cast<char*>(way), std::size_t(c.capacity()) * sizeof *way);
    c.exec.clear(reinterpret_cast<char*>(c.data(field::near_count)), sizeof(int));
  }

  /// Makes the images of the next sort in the rows of the last ones and in rows behind all others.
  template <class C>
  void make(C& c, const Fields& fields) {
    wrap(c);
    const int next = leaves_ ? 0 : list_images(c);
    leaves_ = false;
    if (all_ + std::max(next - images_, 0) > c.capacity())
      throw Error(ExitCode::guard,
                  "there is memory for " + std::to_string(c.capacity() - particles_) +
                      " images of particles beyond periodic faces, and " + std::to_string(next) +
                      " are needed: the fluid there is more than twice as dense as at rest");
    if (next < images_) c.exec.items(images_ - next, LeaveImagesPass{list_.data() + next, c.ids()});
    if (next > 0) {
      c.exec.items(next, TakeImageRowsPass{next_.data(), list_.data(), images_, all_});
      std::swap(list_, next_);
    }
    all_ += std::max(next - images_, 0);
    images_ = next;
    before_sort_ = all_;
    copy(c, fields);
  }
  /// Lists them in next_, without their rows, with more room where it is needed.
  template <class C>
  int list_images(C& c) {
    using Real = typename C::Real;
    for (;;) {
      if (next_.size() < std::size_t(room_)) next_.resize(std::size_t(room_));
      if (count_.size() == 0) count_.resize(1);
      c.exec.clear(reinterpret_cast<char*>(count_.data()), sizeof(int));
      c.exec.items(c.rows(), FindImagesPass<Real>{c.p.period, c.position(), next_.data(),
                                                  count_.data(), room_});
      int needed = 0;
      c.exec.to_host(count_.data(), 1, &needed);
      if (needed <= room_) return needed;
      room_ = needed + needed / 4;
    }
  }

  /// After a sort: which rows are images, and of which rows.
  template <class C>
  void find(C& c) {
    using Real = typename C::Real;
    ids_ = c.ids();
    all_ = c.exec.values(c.data(field::bin_start) + bin_count(c.p), 1)[0];
    if (all_ != particles_ + images_)
      throw Error(ExitCode::internal, "a sort has lost particles or images");
    if (images_ == 0) return;
    if (list_.size() < std::size_t(room_)) list_.resize(std::size_t(room_));
    row_of_.resize(std::size_t(particles_));
    c.exec.clear(reinterpret_cast<char*>(count_.data()), sizeof(int));
    c.exec.items(all_, RowsOfIdsPass{ids_, row_of_.data()});
    c.exec.items(all_, ListImagesPass<Real>{c.p.period, c.position(), ids_, row_of_.data(),
                                            list_.data(), count_.data()});
  }

  template <class C>
  void copy(C& c, const Fields& fields) {
    using Real = typename C::Real;
    if (images_ == 0) return;
    CopyToImagesPass<Real> pass{list_.data(), c.p.period};
    const auto launch = [&] {
      c.exec.items(images_, pass);
      pass = {list_.data(), c.p.period};
    };
    for (const FieldInfo* f : fields) {
      char* rows = c.bytes_of(*f);
      if (!rows || f == &field::bin) continue;  // the sort computes bins of images
      if (&f->primary() == &field::position) {
        pass.position = reinterpret_cast<Vec4<Real>*>(rows);
      } else if (&f->primary() == &field::id) {
        pass.id = reinterpret_cast<int*>(rows);
      } else {
        pass.part[pass.parts++] = {reinterpret_cast<std::uint32_t*>(rows),
                                   f->bytes(C::precision) / 4};
        if (pass.parts == pass.most) launch();
      }
    }
    launch();
  }

  int particles_ = 0, all_ = 0, images_ = 0, room_ = 1024, before_sort_ = 0;
  const int* ids_ = nullptr;
  bool sorts_ = false, copied_ = false, leaves_ = false;
  RankState fresh_;
  Buffer<ImageRow> list_, next_;
  Buffer<int> row_of_, count_;
};

}  // namespace pbf::PBF_VARIANT
