// Updates recorded as CUDA graphs and replayed.
#pragma once

#include <cuda_runtime.h>

#include <array>
#include <map>

#include "lib/exec/cuda/check.h"

namespace pbf::exec_module {

class RecordedUpdates {
 public:
  RecordedUpdates() = default;
  RecordedUpdates(const RecordedUpdates&) = delete;
  RecordedUpdates& operator=(const RecordedUpdates&) = delete;
  ~RecordedUpdates() { drop(); }

  /// Runs `left` updates (lib/solver/batch.h). Missing graphs are recorded: u.step(n) with the
  /// stream captured. ready(): the stream, behind all that was launched.
  template <class Updates, class Ready>
  void repeat(int left, Updates& u, const Ready& ready) {
    while (left > 0) {
      const int n = most_updates(left, u);
      if (n == 1) {
        u.step(1);
      } else {
        cudaGraphExec_t& graph = graph_[u.recording(n)];
        if (!graph) record(graph, n, u, ready);
        PBF_CUDA_CHECK(cudaGraphLaunch(graph, ready()));
        u.replayed(n);
      }
      left -= n;
    }
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
  /// Updates of the next graph, at most `left`; 1: none. An update swaps buffers, so a graph has an
  /// even number of updates, and each placement of buffers and number of launched rows has its own
  /// graphs. Long graphs avoid gaps between graphs.
  template <class Updates>
  static int most_updates(int left, const Updates& u) {
    for (const int n : {64, 8, 4, 2})
      if (n <= left && u.has_form(n)) return n;
    return 1;
  }

  template <class Updates, class Ready>
  void record(cudaGraphExec_t& out, int updates, Updates u, const Ready& ready) {
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

  std::map<std::array<int, 4>, cudaGraphExec_t> graph_;  ///< by Batch::recording()
  double launches_ = 0;
  int recordings_ = 0;
};

}  // namespace pbf::exec_module
