// A frame whose rows are on several ranks, written as SplitFrames has it written.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lib/base/part_file.h"
#include "lib/io/run_file.h"
#include "tests/support/run_file_samples.h"

namespace pbf::test {

constexpr std::int64_t kSplitRows = 40;
inline Snapshot split_sample(std::int64_t k) { return sample(k, kSplitRows); }

inline Snapshot without_bytes(Snapshot s) {
  for (FieldArray& f : s.fields) f.bytes.clear();
  return s;
}
/// Rows from `first` to `last` - 1 of a field.
inline FieldArray rows_of(const FieldArray& f, std::int64_t first, std::int64_t last) {
  FieldArray rows{f.name, f.unit, f.type, f.components, {}};
  const auto row = std::int64_t(size_of(f.type)) * f.components;
  rows.bytes.assign(f.bytes.begin() + first * row, f.bytes.begin() + last * row);
  return rows;
}
/// The parts of the first, second ... of so many ranks: each row where it belongs.
inline std::vector<std::vector<PartFile::Part>> parts_of(const Snapshot& s,
                                                         const FramePlaces& places, int ranks) {
  std::vector<std::vector<PartFile::Part>> all(static_cast<std::size_t>(ranks));
  std::size_t field = 0;
  for (const FieldArray& f : s.fields) {
    if (f.name == "id") continue;
    const std::size_t row = size_of(f.type) * std::size_t(f.components);
    for (std::size_t i = 0; i < s.count; ++i) {
      const std::size_t chunk = i / std::size_t(places.chunk_rows);
      const std::size_t rank = i * std::size_t(ranks) / s.count;
      const std::uint64_t at =
          places.chunks.at(field).at(chunk) + (i - chunk * std::size_t(places.chunk_rows)) * row;
      const std::span<const std::byte> bytes = std::span(f.bytes).subspan(i * row, row);
      if (auto& parts = all[rank];
          !parts.empty() && parts.back().at + parts.back().bytes.size() == at &&
          parts.back().bytes.data() + parts.back().bytes.size() == bytes.data())
        parts.back().bytes = {parts.back().bytes.data(), parts.back().bytes.size() + row};
      else
        parts.push_back({at, bytes});
    }
    ++field;
  }
  return all;
}
inline void write_split(RunWriter& writer, const std::string& path, const Snapshot& s, int ranks) {
  const FramePlaces places = writer.begin_frame(without_bytes(s));
  if (places.chunks.empty()) {
    std::size_t field = 0;
    for (const FieldArray& f : s.fields) {
      if (f.name == "id") continue;
      for (std::int64_t at = 0; at < std::int64_t(s.count); at += places.chunk_rows)
        writer.rows(field, at,
                    rows_of(f, at, std::min(std::int64_t(s.count), at + places.chunk_rows)));
      ++field;
    }
  } else {
    const auto owner = std::make_shared<const Snapshot>(s);
    for (auto& parts : parts_of(*owner, places, ranks)) {
      PartFile file(path);
      file.write(std::move(parts), owner);
      file.done(true);
    }
  }
  writer.commit_frame();
}

}  // namespace pbf::test
