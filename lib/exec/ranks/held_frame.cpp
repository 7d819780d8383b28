#include "lib/exec/ranks/held_frame.h"

#include <algorithm>

#include "lib/base/error.h"

namespace pbf::exec_module {
namespace {

std::size_t bytes_of_row(const FieldArray& f) {
  return std::size_t(f.components) * size_of(f.type);
}

/// The parts of a file at which the rows of a field from `first` on have room.
void add_parts(const FieldArray& f, std::int64_t first, std::int64_t chunk_rows,
               const std::vector<std::uint64_t>& chunks, std::vector<PartFile::Part>& parts) {
  const std::size_t row = bytes_of_row(f);
  const std::int64_t last = first + std::int64_t(f.bytes.size() / row);
  for (std::int64_t at = first; at < last;) {
    const std::int64_t chunk = at / chunk_rows, end = std::min(last, (chunk + 1) * chunk_rows);
    if (std::size_t(chunk) >= chunks.size())
      throw Error(ExitCode::internal, "a frame has more rows than room in its file");
    parts.push_back(
        {chunks[std::size_t(chunk)] + std::uint64_t(at - chunk * chunk_rows) * row,
         std::span(f.bytes).subspan(std::size_t(at - first) * row, std::size_t(end - at) * row)});
    at = end;
  }
}

}  // namespace

Snapshot HeldFrame::hold(const std::function<Snapshot()>& copy) {
  rows_.reset();  // those that are being written stay
  Snapshot mine = copy();
  Snapshot head{mine.update, mine.time, std::size_t(ranges_.particles()), {}};
  for (const FieldArray& f : mine.fields)
    head.fields.push_back({f.name, f.unit, f.type, f.components, {}});
  ToRanges to(ranks_, ranges_, ids_of(mine));
  for (FieldArray& f : mine.fields) {
    if (f.name == "id")
      std::vector<std::byte>().swap(f.bytes);  // those of the range
    else
      f.bytes = to.move(f.bytes, bytes_of_row(f));
  }
  rows_ = std::make_shared<const Snapshot>(std::move(mine));
  return head;
}

void HeldFrame::held(std::size_t field, std::int64_t most, const TakeRows& take) {
  const FieldArray& f = rows_->fields.at(field);
  const std::size_t row = bytes_of_row(f);
  const std::int64_t first = ranges_.first(ranks_.rank()), last = ranges_.first(ranks_.rank() + 1);
  for (std::int64_t at = 0; at < ranges_.particles(); at += most) {
    const std::int64_t low = std::clamp(at, first, last), high = std::clamp(at + most, first, last);
    const auto* begin = reinterpret_cast<const char*>(f.bytes.data());
    std::vector<char> mine(begin + std::size_t(low - first) * row,
                           begin + std::size_t(high - first) * row);
    FieldArray piece{f.name, f.unit, f.type, f.components, {}};
    ranks_.gather(std::move(mine), [&](const std::vector<char>& part) {
      const auto* bytes = reinterpret_cast<const std::byte*>(part.data());
      piece.bytes.insert(piece.bytes.end(), bytes, bytes + part.size());
    });
    if (ranks_.rank() == 0) take(at, std::move(piece));
  }
}

bool HeldFrame::share_file(const std::string& path, std::uint64_t inode) {
  std::int64_t blind = inode == 0 || inode_of(path) != inode;
  ranks_.sum({&blind, 1});
  file_.reset();
  if (blind == 0) file_ = std::make_unique<PartFile>(path);
  return blind == 0;
}

void HeldFrame::write(const FramePlaces& places) {
  std::vector<PartFile::Part> parts;
  std::size_t k = 0;
  for (const FieldArray& f : rows_->fields)
    if (f.name != "id")
      add_parts(f, ranges_.first(ranks_.rank()), places.chunk_rows, places.chunks.at(k++), parts);
  file_->write(std::move(parts), rows_);
}

bool HeldFrame::written(bool wait) {
  std::int64_t left = file_ && !file_->done(wait);
  ranks_.sum({&left, 1});
  return left == 0;
}

}  // namespace pbf::exec_module
