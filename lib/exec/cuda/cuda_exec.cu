#include "lib/exec/cuda/cuda_exec.cuh"

#include <cub/device/device_radix_sort.cuh>

namespace pbf::PBF_VARIANT {

namespace {
struct NumberPass {
  int* row;
  PBF_HD void operator()(int i) const { row[i] = i; }
};
struct AddOnePass {
  unsigned long long* count;
  PBF_HD void operator()(int) const { ++*count; }
};
struct InversePass {
  const int* from;
  int* place;
  PBF_HD void operator()(int k) const { place[from[k]] = k; }
};
}  // namespace

void DeviceLists::allocate(int n) {
  words_.resize(std::size_t(list_stride(n)) * std::size_t(capacity_.first));
  overflows_.resize(std::size_t(capacity_.overflows) * std::size_t(capacity_.overflow));
  count_.resize(std::size_t(n));
  overflow_of_.resize(std::size_t(n));
}

void DeviceLists::ask_state(cudaStream_t stream) {
  PBF_CUDA_CHECK(cudaMemcpyAsync(state_host_.data(), state_.data(), sizeof(ListState),
                                 cudaMemcpyDeviceToHost, stream));
}

ListDemand DeviceLists::demand() const {
  const ListState& s = *state_host_.data();
  return {s.wanted > 0 ? std::max(s.used, s.wanted) : 0,
          s.longest > capacity_.longest() ? s.longest : 0};
}

bool DeviceLists::grow(int n, const ListDemand& elsewhere, cudaStream_t stream) {
  const ListDemand lacked = demand();
  if (!lacked.any() && !elsewhere.any()) return false;
  const bool short_of = lacked.any() || elsewhere.overflows > capacity_.overflows;
  const std::int64_t used = state_host_.data()->used;
  clear_state(stream);
  if (!short_of) return false;
  use(larger_list_capacity(capacity_, std::max({used, lacked.overflows, elsewhere.overflows}),
                           int(lacked.longest), n),
      n);
  return true;
}

bool DeviceLists::enlarge(int n, cudaStream_t stream) {
  const ListState& s = *state_host_.data();
  if (s.longest == 0 && s.used <= capacity_.nearly_overflows()) return false;
  clear_state(stream);
  use(larger_list_capacity(capacity_, s.used, s.longest, n), n);
  return true;
}

void DeviceLists::use(const ListCapacity& capacity, int n) {
  capacity_ = capacity;
  words_.resize(0);  // first, because old and new lists may not fit together
  overflows_.resize(0);
  allocate(n);
}

CudaExec::CudaExec(ListCapacity capacity, std::int64_t total, std::int64_t rows)
    : CudaPasses(total, rows), lists_(capacity) {
  int device = 0, driver = 0;
  cudaDeviceProp p{};
  PBF_CUDA_CHECK(cudaGetDevice(&device));
  PBF_CUDA_CHECK(cudaGetDeviceProperties(&p, device));
  PBF_CUDA_CHECK(cudaDriverGetVersion(&driver));
  launcher_.overlap = p.major >= 9;
  device_ = p.name;
  driver_ = "CUDA " + std::to_string(driver / 1000) + "." + std::to_string(driver % 100 / 10);
  PBF_CUDA_CHECK(cudaStreamCreateWithFlags(&launcher_.stream, cudaStreamNonBlocking));
  lists_.clear_state(launcher_.stream);
  turns_.prepare(device, launcher_.stream);
}

CudaExec::~CudaExec() {
  link_.reset();  // after an error the stream may wait for ranks that are gone
  if (launcher_.stream) cudaStreamSynchronize(launcher_.stream);
  recorded_.drop();
  for (cudaEvent_t e : events_) cudaEventDestroy(e);
  if (launcher_.stream) cudaStreamDestroy(launcher_.stream);
  if (other_stream_) cudaStreamDestroy(other_stream_);
}

void CudaExec::begin() {
  if (!profiling_) return;
  stages_.clear();
  mark("");
}

void CudaExec::mark(const char* stage) {
  if (!profiling_) return;
  if (events_.size() <= stages_.size()) {
    events_.emplace_back();
    PBF_CUDA_CHECK(cudaEventCreate(&events_.back()));
  }
  PBF_CUDA_CHECK(cudaEventRecord(events_[stages_.size()], launcher_.ready()));
  stages_.push_back(stage);
}

void CudaExec::book(double scale) {
  synchronize();
  for (std::size_t k = 1; k < stages_.size(); ++k) {
    float ms = 0;
    PBF_CUDA_CHECK(cudaEventElapsedTime(&ms, events_[k - 1], events_[k]));
    clock_.add(stages_[k], double(ms) * 1e-3 * scale);
  }
  stages_.clear();
}

void CountingSort::scan(const BinRange& bins, int* start, cudaStream_t stream) {
  // The count behind the last bin is 0, so the scan ends with the number of rows.
  with_scratch(scan_, [&](void* scratch, std::size_t& bytes) {
    return cub::DeviceScan::ExclusiveSum(scratch, bytes, counts_.data() + bins.begin,
                                         start + bins.begin, bins.end - bins.begin + 1, stream);
  });
}

void CudaExec::rank(int n, const int* id, int* place) {
  const auto size = std::size_t(n);
  DeviceBuffer<int> sorted, rows, by_id;
  DeviceBuffer<char> scratch;
  sorted.resize(size), rows.resize(size), by_id.resize(size);
  items(n, NumberPass{rows.data()});
  with_scratch(scratch, [&](void* memory, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortPairs(memory, bytes, id, sorted.data(), rows.data(),
                                           by_id.data(), n, 0, 31, launcher_.ready());
  });
  items(n, InversePass{by_id.data(), place});
  synchronize();
}

void CudaExec::connect(Communicator& ranks) {
  link_ = make_device_link(ranks);
  if (link_->in_stream()) edges_ = std::make_unique<EdgeStream>();
  driver_ += ", " + link_->name();
}

void CudaRows::move_down(char* begin, std::size_t by, std::size_t bytes) {
  if (by == 0 || bytes == 0) return;
  const std::size_t piece = std::min<std::size_t>(bytes, 64 << 20);
  DeviceBuffer<char> between;  // pieces may overlap with what they move to
  if (by < piece) between.resize(piece);
  for (std::size_t done = 0; done < bytes; done += piece) {
    const std::size_t n = std::min(piece, bytes - done);
    const char* from = begin + by + done;
    if (by < piece) {
      copy(from, between.data(), n);
      from = between.data();
    }
    copy(from, begin + done, n);
  }
  synchronize();
}

void CudaExec::add_one(unsigned long long* count) { items(1, AddOnePass{count}); }

bool CudaExec::new_condition(cudaGraphConditionalHandle& handle) {
  cudaStreamCaptureStatus status;
  cudaGraph_t graph = nullptr;
  PBF_CUDA_CHECK(cudaStreamGetCaptureInfo(launcher_.stream, &status, nullptr, &graph));
  if (status != cudaStreamCaptureStatusActive) return false;
  PBF_CUDA_CHECK(cudaGraphConditionalHandleCreate(&handle, graph));
  return true;
}

void CudaExec::begin_repeated(cudaGraphConditionalHandle handle) {
  cudaStreamCaptureStatus status;
  cudaGraph_t graph = nullptr;
  const cudaGraphNode_t* before = nullptr;
  const cudaGraphEdgeData* edges = nullptr;
  std::size_t count = 0;
  PBF_CUDA_CHECK(cudaStreamGetCaptureInfo(launcher_.stream, &status, nullptr, &graph, &before,
                                          &edges, &count));
  cudaGraphNodeParams params{};
  params.type = cudaGraphNodeTypeConditional;
  params.conditional.handle = handle;
  params.conditional.type = cudaGraphCondTypeWhile;
  params.conditional.size = 1;
  cudaGraphNode_t node = nullptr;
  PBF_CUDA_CHECK(cudaGraphAddNode(&node, graph, before, edges, count, &params));
  PBF_CUDA_CHECK(cudaStreamUpdateCaptureDependencies(launcher_.stream, &node, nullptr, 1,
                                                     cudaStreamSetCaptureDependencies));
  if (!other_stream_)
    PBF_CUDA_CHECK(cudaStreamCreateWithFlags(&other_stream_, cudaStreamNonBlocking));
  std::swap(launcher_.stream, other_stream_);
  launcher_.alone = true;
  PBF_CUDA_CHECK(cudaStreamBeginCaptureToGraph(launcher_.stream, params.conditional.phGraph_out[0],
                                               nullptr, nullptr, 0,
                                               cudaStreamCaptureModeThreadLocal));
}

void CudaExec::end_repeated() {
  cudaGraph_t body = nullptr;
  PBF_CUDA_CHECK(cudaStreamEndCapture(launcher_.stream, &body));
  std::swap(launcher_.stream, other_stream_);
  launcher_.alone = true;
}

bool CudaExec::asked_to_repeat() {
  unsigned go = 0;
  to_host(&repeat_.data()->go, 1, &go);
  return go != 0;
}

ListDemand CudaExec::list_demand() {
  lists_.ask_state(launcher_.ready());
  synchronize();
  return lists_.demand();
}

bool CudaExec::grow_lists(int n, const ListDemand& elsewhere) {
  const bool grown = lists_.grow(n, elsewhere, launcher_.ready());
  launcher_.alone = true;
  if (grown) forget_recorded();  // it holds the old addresses
  return grown;
}

void CudaExec::enlarge_lists(int n) {
  if (!lists_.enlarge(n, launcher_.ready())) return;
  launcher_.alone = true;
  forget_recorded();  // it holds the old addresses
}

double CudaExec::hidden_exchange() const {
  if (!edges_ || edges_->hidden() == 0) return 0;
  const auto& entries = clock_.entries();
  const auto exchange = std::ranges::find(entries, "exchange", &StageTime::name);
  if (exchange == entries.end()) return 0;
  const double of_update = exchange->seconds / (double(kSampleEvery) * stage_samples_);
  return std::min(edges_->hidden() / of_update, 1.0);
}

std::vector<StageTime> CudaExec::stages(double seconds) const {
  double sampled = 0;
  for (const auto& e : clock_.entries()) sampled += e.seconds;
  std::vector<StageTime> out;
  for (const auto& e : clock_.entries())
    out.push_back({e.name, e.seconds * (seconds / sampled), e.calls});
  return out;
}

void CudaExec::describe(SolverInfo& info) const {
  info.backend = "cuda";
  info.device = device_;
  info.driver = driver_;
  info.launches = recorded_.launches();
  info.recordings = recorded_.recordings();
  info.hidden_exchange = hidden_exchange();
}

}  // namespace pbf::PBF_VARIANT
