// An executor that sees what passes touch: every array lies on pages of its own, and all of them
// are closed before a pass. The first touch of each opens it, and is written down. Contents that no
// declaration promises are replaced by nonsense.
#pragma once

#include <signal.h>
#include <sys/mman.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lib/exec/cpu/cpu_exec.h"
#include "lib/solver/granted.h"

namespace pbf {

/// Fills memory with numbers that are NaN as float and double, and as integers no index and no id.
inline void fill_with_nonsense(char* begin, std::size_t bytes) {
  constexpr std::uint32_t word = 0x7ff1f1f1;
  for (std::size_t k = 0; k < bytes; ++k) begin[k] = char(word >> 8 * (k % sizeof(word)));
}

/// As HostBuffer, on pages of its own. New pages hold nonsense.
template <class T>
class PageBuffer {
 public:
  PageBuffer() = default;
  PageBuffer(PageBuffer&& o) noexcept { swap(o); }
  PageBuffer& operator=(PageBuffer&& o) noexcept {
    swap(o);
    return *this;
  }
  ~PageBuffer() { free(); }

  void resize(std::size_t n) {
    if (n == size_) return;
    free();
    size_ = n;
    if (n == 0) return;
    const auto page = std::size_t(sysconf(_SC_PAGESIZE));
    mapped_ = (n * sizeof(T) + page - 1) / page * page;
    data_ = static_cast<T*>(
        mmap(nullptr, mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    if (data_ == MAP_FAILED) throw std::bad_alloc();
    fill_with_nonsense(reinterpret_cast<char*>(data_), mapped_);
  }
  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }

 private:
  void free() {
    if (mapped_) munmap(data_, mapped_);
    data_ = nullptr;
    size_ = mapped_ = 0;
  }
  void swap(PageBuffer& o) {
    std::swap(data_, o.data_);
    std::swap(size_, o.size_);
    std::swap(mapped_, o.mapped_);
  }
  T* data_ = nullptr;
  std::size_t size_ = 0, mapped_ = 0;
};

/// How a pass has touched an array, in the order of first touches, and what it declares (enum How).
/// What is read after it has been written is not seen.
struct Touch {
  bool read = false, written = false;
  unsigned declared = 0;
};
/// By name of pass and of field ("position'": the second array).
using Touches = std::map<std::string, std::map<std::string, Touch>>;

class PageExec : public CpuExec {
 public:
  template <class T>
  using Buffer = PageBuffer<T>;
  /// plan: of the solver. forgets: name of the one field whose contents become nonsense; empty:
  /// all.
  PageExec(Touches& touches, const Plan& plan, std::string forgets = "")
      : CpuExec(1), touches_(touches), plan_(plan), forgets_(std::move(forgets)) {}

  /// Throws Error(internal) if a field of Life::update is not 0 between two updates.
  template <class Updates>
  void repeat(int updates, Updates& u) {
    expect_zeros();
    u.step(updates);
    expect_zeros();
    // What the state does not hold and no life promises: also the second arrays of pairs.
    for (const FieldMemory& a : arrays_)
      if (a.field->life == Life::pass || a.second) forget(a);
  }

  /// Called around every pass, also those of hooks (lib/solver/granted.h).
  template <class Launch>
  void watched(const PassInfo& given, const std::vector<FieldMemory>& arrays,
               const Launch& launch) {
    // A program adds to a sort what it carries.
    const std::vector<PassInfo>& all = plan_.program.passes;
    const auto known = std::find_if(all.begin(), all.end(), [&](const PassInfo& p) {
      return p.name == std::string_view(given.name);
    });
    const PassInfo& pass = known == all.end() ? given : *known;
    State& s = state();
    s = {pass.name, &touches_[pass.name], arrays};
    arrays_ = arrays;
    for (const AccessInfo& need : pass.needs)
      if (need.field->rows) (*s.touched)[name_of(*need.field)].declared |= need.how;
    forget_what_is_replaced(pass);
    const std::vector<Hidden> hidden = hide_fourth_numbers(pass);
    struct sigaction now {
    }, before{};
    now.sa_sigaction = &fault;
    now.sa_flags = SA_SIGINFO;
    sigaction(SIGSEGV, &now, &before);
    for (const FieldMemory& a : arrays) mprotect(a.begin, a.bytes, PROT_NONE);
    const struct Opened {  // also when the launch throws
      const std::vector<FieldMemory>& arrays;
      const struct sigaction& before;
      const std::vector<Hidden>& hidden;
      ~Opened() {
        for (const FieldMemory& a : arrays) mprotect(a.begin, a.bytes, PROT_READ | PROT_WRITE);
        sigaction(SIGSEGV, &before, nullptr);
        for (const Hidden& h : hidden) *h.at = h.value;
      }
    } opened{arrays, before, hidden};
    launch();
  }

 private:
  struct State {
    const char* pass = "";
    std::map<std::string, Touch>* touched = nullptr;
    std::vector<FieldMemory> arrays{};
  };
  static State& state() {
    static State s;
    return s;
  }
  static void fault(int, siginfo_t* info, void* context) {
    constexpr int error_register = 19, of_write = 2;  // REG_ERR, x86-64
    const auto* at = static_cast<const char*>(info->si_addr);
    const auto* machine = static_cast<const ucontext_t*>(context);
    const bool writes = machine->uc_mcontext.gregs[error_register] & of_write;
    for (const FieldMemory& a : state().arrays) {
      const auto page = std::size_t(sysconf(_SC_PAGESIZE));
      if (at < a.begin || at >= a.begin + (a.bytes + page - 1) / page * page) continue;
      Touch& t = (*state().touched)[std::string(a.field->name) + (a.second ? "'" : "")];
      (writes ? t.written : t.read) = true;
      mprotect(a.begin, a.bytes, writes ? PROT_READ | PROT_WRITE : PROT_READ);
      return;
    }
    // Outside of all arrays: says in which pass. The fault comes again and ends the process.
    for (const char* text : {"pass '", state().pass, "' leaves the arrays of its fields\n"})
      if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
    signal(SIGSEGV, SIG_DFL);
  }

  /// The former contents of what the pass writes completely, or places without reading it.
  /// A pass that adds rows, and with them their number, keeps those that are there.
  void forget_what_is_replaced(const PassInfo& pass) const {
    const auto adds = [](const AccessInfo& a) {
      return a.field == &field::row_state && (a.how & kPlaces);
    };
    if (!pass.reorders_rows() && std::ranges::any_of(pass.needs, adds)) return;
    for (const AccessInfo& need : pass.needs) {
      const FieldInfo& f = *need.field;
      const bool places = f.life == Life::pass && (need.how & kPlaces) && !(need.how & kReading);
      if (need.how != kWrites && !places) continue;
      for (const FieldMemory& a : arrays_)
        if (is(a, f)) forget(a);
    }
  }
  static bool is(const FieldMemory& a, const FieldInfo& f) {
    return a.field == &f.primary() && a.second == (f.first != nullptr);
  }
  /// The fourth numbers of positions, which a pass that only reads them may read if it says what
  /// they are. Without that, they are nonsense during the pass.
  struct Hidden {
    float* at;
    float value;
  };
  static bool may_read_fourth(const PassInfo& pass, const FieldInfo* position) {
    return std::any_of(pass.declared.begin(), pass.declared.end(), [&](const AccessInfo& a) {
      const bool carries =  // from one array of positions to the other (lib/program/program.cpp)
          &a.field->primary() == &field::position && (a.how & kPlaces) && a.w == W::any;
      return carries || (a.field == position && a.w != W::any);
    });
  }
  std::vector<Hidden> hide_fourth_numbers(const PassInfo& pass) const {
    std::vector<Hidden> hidden;
    for (const AccessInfo& need : pass.needs)
      for (const FieldMemory& a : arrays_) {
        if (&need.field->primary() != &field::position || !is(a, *need.field)) continue;
        if ((need.how & kWriting) || may_read_fourth(pass, need.field)) continue;
        if (!forgets_.empty() && forgets_ != a.field->name) continue;
        auto* number = reinterpret_cast<float*>(a.begin) + 3;
        for (std::int64_t i = 0; i < plan_.particles; ++i, number += 4) {
          hidden.push_back({number, *number});
          *number = std::numeric_limits<float>::quiet_NaN();
        }
      }
    return hidden;
  }
  /// Not the rows after the last particle: they keep their contents from the start.
  void forget(const FieldMemory& a) const {
    if (!forgets_.empty() && forgets_ != a.field->name) return;
    const std::size_t rows = std::size_t(plan_.particles);
    const std::size_t all = rows + std::size_t(about(backend).padding);
    fill_with_nonsense(a.begin, a.field->rows == per_padded_row ? a.bytes / all * rows : a.bytes);
  }
  void expect_zeros() const {
    for (const FieldMemory& a : arrays_)
      if (a.field->life == Life::update &&
          std::any_of(a.begin, a.begin + a.bytes, [](char c) { return c != 0; }))
        throw Error(ExitCode::internal, name_of(*a.field) + " is not 0 between two updates");
  }

  Touches& touches_;
  const Plan& plan_;
  std::string forgets_;
  std::vector<FieldMemory> arrays_{};  ///< as of the last pass
};

}  // namespace pbf
