// Exchanges of pieces of memory, joined to one message for each pair of ranks.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "lib/exec/ranks/communicator.h"

namespace pbf::exec_module {

/// Whether at most one piece goes to or comes from each rank.
inline bool single(const std::vector<Outgoing>& out, const std::vector<Incoming>& in) {
  std::set<int> to, from;
  for (const Outgoing& o : out) to.insert(o.to);
  for (const Incoming& i : in) from.insert(i.from);
  return to.size() == out.size() && from.size() == in.size();
}

/// Pieces are in the same order on both ranks. read(from, bytes, to) copies them to memory of the
/// host, write(from, bytes, to) back.
template <class Read, class Write>
void exchange_joined(Communicator& ranks, const std::vector<Outgoing>& out,
                     const std::vector<Incoming>& in, const Read& read, const Write& write) {
  std::map<int, std::vector<char>> sent, received;
  for (const Outgoing& o : out) {
    std::vector<char>& all = sent[o.to];
    all.resize(all.size() + o.bytes);
    read(static_cast<const char*>(o.data), o.bytes, all.data() + all.size() - o.bytes);
  }
  for (const Incoming& i : in) received[i.from].resize(received[i.from].size() + i.bytes);
  std::vector<Outgoing> to;
  std::vector<Incoming> from;
  for (const auto& [rank, all] : sent) to.push_back({rank, all.data(), all.size()});
  for (auto& [rank, all] : received) from.push_back({rank, all.data(), all.size()});
  ranks.exchange(to, from);
  std::map<int, std::size_t> at;
  for (const Incoming& i : in) {
    write(received[i.from].data() + at[i.from], i.bytes, static_cast<char*>(i.data));
    at[i.from] += i.bytes;
  }
}

}  // namespace pbf::exec_module
