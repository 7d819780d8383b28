// Updates recorded as CUDA graphs and replayed.
#pragma once

#include <cuda_runtime.h>

#include <map>
#include <utility>

#include "lib/exec/cuda/check.h"

namespace pbf::inline exec_module {

class RecordedUpdates {
 public:
  RecordedUpdates() = default;
  RecordedUpdates(const RecordedUpdates&) = delete;
  RecordedUpdates& operator=(const RecordedUpdates&) = delete;
  ~RecordedUpdates() { drop(); }

  /// Makes them with u.step(updates) while the stream is captured, where they are not there yet.
  template <class Updates>
  void repeat(int left, Updates& u, cudaStream_t stream) {
    for (const int size : {0, 1, 2})
      for (; left >= kUpdates[size]; left -= kUpdates[size]) {
        cudaGraphExec_t& graph = graph_[{size, u.placement()}];
        if (!graph) record(graph, kUpdates[size], u, stream);
        PBF_CUDA_CHECK(cudaGraphLaunch(graph, stream));
        u.moved();
      }
    if (left) u.step(1);
  }
  void drop() {
    for (const auto& [key, graph] : graph_)
      if (graph) cudaGraphExecDestroy(graph);
    graph_.clear();
  }
  /// Kernels and fills of one step; 0 before one was recorded.
  double launches() const { return launches_; }

 private:
  /// Buffers trade places in an update, so what can be replayed holds an even number of them, and
  /// there is one for each placement. Long ones spare the gaps between graphs.
  static constexpr int kUpdates[3] = {64, 8, 2};

  template <class Updates>
  void record(cudaGraphExec_t& out, int updates, Updates& u, cudaStream_t stream) {
    cudaGraph_t graph = nullptr;
    PBF_CUDA_CHECK(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal));
    u.step(updates);
    PBF_CUDA_CHECK(cudaStreamEndCapture(stream, &graph));
    std::size_t nodes = 0;
    PBF_CUDA_CHECK(cudaGraphGetNodes(graph, nullptr, &nodes));
    launches_ = double(nodes) / updates;
    const cudaError_t made = cudaGraphInstantiate(&out, graph, 0);
    cudaGraphDestroy(graph);
    PBF_CUDA_CHECK(made);
  }

  std::map<std::pair<int, int>, cudaGraphExec_t> graph_;  ///< by size and placement
  double launches_ = 0;
};

}  // namespace pbf::inline exec_module
