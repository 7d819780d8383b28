#include "lib/exec/ranks/id_ranges.h"

#include <algorithm>
#include <cstring>

#include "lib/base/error.h"

namespace pbf::exec_module {

ToRanges::ToRanges(Communicator& ranks, const IdRanges& ranges,
                   const std::vector<std::int64_t>& ids)
    : ranks_(ranks),
      first_(ranges.first(ranks.rank())),
      count_(ranges.first(ranks.rank() + 1) - first_) {
  const auto size = std::size_t(ranks.size()), me = std::size_t(ranks.rank());
  std::vector<std::uint64_t> to(size), table(size * size);
  for (std::size_t r = 0; r <= size; ++r)
    cut_.push_back(std::size_t(std::ranges::lower_bound(ids, ranges.first(int(r))) - ids.begin()));
  for (std::size_t r = 0; r < size; ++r) to[r] = cut_[r + 1] - cut_[r];
  const std::vector<char> all = ranks.all_gather(to.data(), size * sizeof to[0]);
  std::memcpy(table.data(), all.data(), all.size());
  coming_.push_back(0);
  for (std::size_t r = 0; r < size; ++r) coming_.push_back(coming_[r] + table[r * size + me]);
  std::vector<std::int32_t> mine(ids.size());
  for (std::size_t r = 0; r < size; ++r)
    for (std::size_t k = cut_[r]; k < cut_[r + 1]; ++k)
      mine[k] = std::int32_t(ids[k] - ranges.first(int(r)));
  bool whole =
      coming_.back() == std::size_t(count_) && cut_.front() == 0 && cut_.back() == ids.size();
  if (whole) {
    place_.resize(coming_.back());
    for (std::size_t k = 0; k < place_.size(); ++k) place_[k] = std::int32_t(k);
    const std::vector<std::byte> places = move(std::as_bytes(std::span(mine)), sizeof mine[0]);
    if (!places.empty()) std::memcpy(place_.data(), places.data(), places.size());
    std::vector<bool> seen(place_.size());
    for (const std::int32_t p : place_) {
      whole = whole && !seen[std::size_t(p)];
      seen[std::size_t(p)] = true;
    }
  }
  if (!whole)
    throw Error(ExitCode::internal, "not every particle is on one of the ranks, and only there");
}

std::vector<std::byte> ToRanges::move(std::span<const std::byte> rows, std::size_t size) {
  const int me = ranks_.rank();
  std::vector<std::byte> came(coming_.back() * size), sorted(came.size());
  std::vector<Outgoing> out;
  std::vector<Incoming> in;
  for (int r = 0; r < ranks_.size(); ++r) {
    const std::size_t k = std::size_t(r), to = (cut_[k + 1] - cut_[k]) * size,
                      from = (coming_[k + 1] - coming_[k]) * size;
    if (r != me && to > 0) out.push_back({r, rows.data() + cut_[k] * size, to});
    if (r != me && from > 0) in.push_back({r, came.data() + coming_[k] * size, from});
    if (r == me && to > 0)
      std::memcpy(came.data() + coming_[k] * size, rows.data() + cut_[k] * size, to);
  }
  ranks_.exchange(out, in);
  for (std::size_t k = 0; k < place_.size(); ++k)
    std::memcpy(sorted.data() + std::size_t(place_[k]) * size, came.data() + k * size, size);
  return sorted;
}

}  // namespace pbf::exec_module
