#include "lib/exec/ranks/communicator.h"

#include <array>
#include <thread>

namespace pbf::exec_module {

void Communicator::wait_until(const std::function<bool()>& done) {
  while (!done()) std::this_thread::yield();
}

void Communicator::fail(const std::string& why, int code) noexcept {
  tell_failure(why, code);
  for (const auto& [owner, end] : end_waiting) end();
}

std::vector<char> scatter(Communicator& ranks, const std::function<std::vector<char>(int)>& part) {
  std::vector<char> bytes;
  std::uint64_t n = 0;
  if (ranks.rank() != 0) {
    ranks.exchange(std::span<const Outgoing>(), std::array{Incoming{0, &n, sizeof n}});
    bytes.resize(n);
    ranks.exchange(std::span<const Outgoing>(), std::array{Incoming{0, bytes.data(), n}});
    return bytes;
  }
  for (int r = 1; r < ranks.size(); ++r) {
    bytes = part(r);
    n = bytes.size();
    ranks.exchange(std::array{Outgoing{r, &n, sizeof n}}, std::span<const Incoming>());
    ranks.exchange(std::array{Outgoing{r, bytes.data(), n}}, std::span<const Incoming>());
  }
  return part(0);
}

}  // namespace pbf::exec_module
