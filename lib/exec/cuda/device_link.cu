#include "lib/exec/cuda/device_link.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <set>
#include <string_view>
#include <utility>

#include "lib/exec/cuda/check.h"
#include "lib/exec/cuda/nccl.h"
#include "lib/exec/ranks/pieces.h"

namespace pbf::exec_module {
namespace {

class HostLink final : public DeviceLink {
 public:
  explicit HostLink(Communicator& ranks) : ranks_(ranks) {}
  std::string name() const override { return "through the host"; }
  bool in_stream() const override { return false; }
  void wait(cudaStream_t stream) override { PBF_CUDA_CHECK(cudaStreamSynchronize(stream)); }
  void wait(cudaEvent_t event) override { PBF_CUDA_CHECK(cudaEventSynchronize(event)); }
  void exchange(const std::vector<Outgoing>& out, const std::vector<Incoming>& in,
                cudaStream_t stream) override {
    const auto copy = [&](cudaMemcpyKind kind) {
      return [stream, kind](const char* from, std::size_t bytes, char* to) {
        if (bytes == 0) return;
        PBF_CUDA_CHECK(cudaMemcpyAsync(to, from, bytes, kind, stream));
        PBF_CUDA_CHECK(cudaStreamSynchronize(stream));
      };
    };
    exchange_joined(ranks_, out, in, copy(cudaMemcpyDeviceToHost), copy(cudaMemcpyHostToDevice));
  }

 private:
  Communicator& ranks_;
};

class NcclLink final : public DeviceLink {
 public:
  NcclLink(const Nccl& nccl, Communicator& ranks) : nccl_(nccl), ranks_(ranks) {
    Nccl::Id id{};
    if (ranks.rank() == 0) check(nccl_.get_unique_id(&id), "ncclGetUniqueId");
    std::vector<char> bytes(sizeof id);
    std::memcpy(bytes.data(), &id, sizeof id);
    ranks.broadcast(bytes);
    std::memcpy(&id, bytes.data(), sizeof id);
    check(nccl_.init_rank(&comm_, ranks.size(), id, ranks.rank()), "ncclCommInitRank");
    ranks.end_waiting[this] = [this] { abort(); };
  }
  ~NcclLink() override {
    ranks_.end_waiting.erase(this);
    // After an error other ranks may be gone, and an orderly end would wait for them.
    if (std::uncaught_exceptions() > 0) abort();
    if (comm_) nccl_.destroy(comm_);
  }
  bool in_stream() const override { return true; }
  void wait(cudaStream_t stream) override {
    wait_for([stream] { return cudaStreamQuery(stream); });
  }
  void wait(cudaEvent_t event) override {
    wait_for([event] { return cudaEventQuery(event); });
  }
  std::string name() const override {
    int v = 0;
    nccl_.get_version(&v);
    return "NCCL " + std::to_string(v / 10000) + "." + std::to_string(v / 100 % 100) + "." +
           std::to_string(v % 100);
  }
  void exchange(const std::vector<Outgoing>& out, const std::vector<Incoming>& in,
                cudaStream_t stream) override {
    check(nccl_.group_start(), "ncclGroupStart");
    std::vector<bool> told(std::size_t(ranks_.size()));
    for (const Outgoing& o : out) {
      if (o.bytes == 0) continue;
      check(nccl_.send(o.data, o.bytes, Nccl::kBytes, o.to, comm_, stream), "ncclSend");
      ranks_.sent.messages += !told[std::size_t(o.to)];
      told[std::size_t(o.to)] = true;
      ranks_.sent.bytes += std::int64_t(o.bytes);
    }
    for (const Incoming& i : in)
      if (i.bytes > 0)
        check(nccl_.receive(i.data, i.bytes, Nccl::kBytes, i.from, comm_, stream), "ncclRecv");
    check(nccl_.group_end(), "ncclGroupEnd");
  }

 private:
  template <class Query>
  void wait_for(const Query& query) {
    ranks_.wait_until([&] {
      const cudaError_t now = query();
      if (now != cudaErrorNotReady) PBF_CUDA_CHECK(now);
      return now == cudaSuccess;
    });
  }
  void abort() {
    if (comm_) nccl_.abort(std::exchange(comm_, nullptr));
  }
  void check(int result, const char* call) const {
    if (result != 0)
      throw Error(ExitCode::unavailable,
                  std::string(call) + " failed: " + nccl_.error_text(result) +
                      " (the environment variable NCCL_DEBUG=WARN says more; PBF_NCCL=off "
                      "exchanges through the host)");
  }
  const Nccl& nccl_;
  Communicator& ranks_;
  Nccl::Comm comm_ = nullptr;
};

int devices() {
  int count = 0;
  PBF_CUDA_CHECK(cudaGetDeviceCount(&count));
  return std::max(count, 1);
}

/// Whether two ranks have one device, which NCCL refuses. A launcher may show each rank another
/// device as its only one, so their numbers do not tell.
bool share_devices(Communicator& ranks) {
  int device = 0;
  cudaDeviceProp mine{};
  PBF_CUDA_CHECK(cudaGetDevice(&device));
  PBF_CUDA_CHECK(cudaGetDeviceProperties(&mine, device));
  const std::vector<char> all = ranks.all_gather(&mine.uuid, sizeof mine.uuid);
  std::set<std::string> different;
  for (std::size_t at = 0; at < all.size(); at += sizeof mine.uuid)
    different.emplace(all.data() + at, sizeof mine.uuid);
  return int(different.size()) < ranks.size();
}

}  // namespace

void use_device_of_rank(Communicator& ranks) {
  PBF_CUDA_CHECK(cudaSetDevice(std::max(ranks.local_rank(), 0) % devices()));
}

std::unique_ptr<DeviceLink> make_device_link(Communicator& ranks) {
  const char* wanted = std::getenv("PBF_NCCL");
  const Nccl* nccl = open_nccl(nullptr);
  std::int64_t against =
      share_devices(ranks) || !nccl || (wanted && std::string_view(wanted) == "off");
  ranks.sum({&against, 1});
  if (against > 0) return std::make_unique<HostLink>(ranks);
  setenv("NCCL_NVLS_ENABLE", "0", 0);  // multicast between devices: not needed for messages
  return std::make_unique<NcclLink>(*nccl, ranks);
}

}  // namespace pbf::exec_module
