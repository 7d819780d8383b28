// Updates recorded as CUDA graphs and replayed.
#pragma once

#include <cuda_runtime.h>

#include <map>
#include <utility>

#include "lib/exec/cuda/check.h"

namespace pbf::exec_module {

class RecordedUpdates {
 public:
  RecordedUpdates() = default;
  RecordedUpdates(const RecordedUpdates&) = delete;
  RecordedUpdates& operator=(const RecordedUpdates&) = delete;
  ~RecordedUpdates() { drop(); }

  /// Runs `left` updates. Missing graphs are recorded: u.step(updates) with the stream captured.
  /// ready(): the stream, behind all that was launched.
  template <class Updates, class Ready>
  void repeat(int left, Updates& u, const Ready& ready) {
    for (const int size : {0, 1, 2})
      for (; left >= kUpdates[size]; left -= kUpdates[size]) {
        cudaGraphExec_t& graph = graph_[{size, u.launch()}];
        if (!graph) record(graph, kUpdates[size], u, ready);
        PBF_CUDA_CHECK(cudaGraphLaunch(graph, ready()));
        u.moved();
      }
    if (left) u.step(1);
  }
  void drop() {
    for (const auto& [key, graph] : graph_)
      if (graph) cudaGraphExecDestroy(graph);
    graph_.clear();
  }
  /// Kernels and fills of one update; 0 before the first recording.
  double launches() const { return launches_; }
  int recordings() const { return recordings_; }

 private:
  /// Updates per graph. An update swaps buffers, so a graph has an even number of updates, and each
  /// placement of buffers and number of launched rows has its own graphs. Long graphs avoid gaps
  /// between graphs.
  static constexpr int kUpdates[3] = {64, 8, 2};

  template <class Updates, class Ready>
  void record(cudaGraphExec_t& out, int updates, Updates& u, const Ready& ready) {
    cudaGraph_t graph = nullptr;
    PBF_CUDA_CHECK(cudaStreamBeginCapture(ready(), cudaStreamCaptureModeThreadLocal));
    u.step(updates);
    PBF_CUDA_CHECK(cudaStreamEndCapture(ready(), &graph));
    std::size_t nodes = 0;
    PBF_CUDA_CHECK(cudaGraphGetNodes(graph, nullptr, &nodes));
    launches_ = double(nodes) / updates;
    ++recordings_;
    // Else all run with the priority of the stream that the graph is launched in.
    const cudaError_t made =
        cudaGraphInstantiate(&out, graph, cudaGraphInstantiateFlagUseNodePriority);
    cudaGraphDestroy(graph);
    PBF_CUDA_CHECK(made);
  }

  std::map<std::pair<int, std::pair<int, int>>, cudaGraphExec_t> graph_;  ///< by size and launch()
  double launches_ = 0;
  int recordings_ = 0;
};

}  // namespace pbf::exec_module
