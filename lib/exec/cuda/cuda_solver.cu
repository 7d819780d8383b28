// The CUDA solver; compiled once for each variant of the arithmetic (kernels/hd.h).
#include <algorithm>
#include <utility>

#include "lib/base/error.h"
#include "lib/exec/cuda/cuda_exec.cuh"
#include "lib/exec/cuda/cuda_variants.h"
#include "lib/solver/step_solver.h"

namespace pbf::inline PBF_VARIANT {
namespace {

/// Updates after which the host looks whether a list outgrew its room (and waits for the device).
/// Few at first and after lists grew, for lists that grow once often do so again, and what is done
/// again then is short.
constexpr int kFirstBatch = 8;
int largest_batch(int n) { return n < 20000 ? 256 : n < 500000 ? 64 : 16; }

template <class Real>
class CudaSolver final : public Solver {
 public:
  CudaSolver(const Scene& scene, const Plan& plan, Particles particles, ListRoom room)
      : scene_(scene), plan_(plan), n_(int(particles.size())), exec_(room) {
    Stopwatch watch;
    InternalState<Real> s = to_internal<Real>(scene, plan.axes, std::move(particles));
    stepper_ = std::make_unique<Stepper<Real, CudaExec>>(
        exec_, make_params<Real>(scene, plan), scene.solver.kernels, scene.solver.iterations, plan,
        std::move(s.position), std::move(s.velocity), std::move(s.id));
    while (grow_if_needed()) stepper_->relist();
    init_seconds_ = watch.seconds();
  }
  ~CudaSolver() override {
    cudaStreamSynchronize(exec_.stream());
    drop_graphs();
    if (copy_stream_) {
      cudaStreamSynchronize(copy_stream_);
      cudaEventDestroy(exported_);
      cudaStreamDestroy(copy_stream_);
    }
  }

  void step(int updates) override {
    const Stopwatch watch;
    for (; fault_ && updates > 0; --updates) checked_step(nullptr);
    advance(std::int64_t(updates) << level_);
    count(updates);
    step_seconds_ += watch.seconds();
  }
  void set_step_level(int level) override {
    if (level == level_) return;
    level_ = level;
    use(params_at_level(scene_, plan_, level, stepper_->params()));
  }
  void relax(int steps, double damping) override {
    const Stopwatch watch;
    const Params<Real> p = stepper_->params();
    use(without_time(p, damping));
    advance(steps);
    use(p);
    steps_ += steps;
    step_seconds_ += watch.seconds();
  }

  std::vector<double> positions() override { return stepper_->positions(); }
  Snapshot download(const std::vector<std::string>& fields, ScalarType type) override {
    start_download(fields, type);
    return finish_download();
  }

  void start_download(const std::vector<std::string>& fields, ScalarType type) override {
    pending_ = empty_snapshot(fields, type, std::size_t(n_), updates_, time());
    type == ScalarType::f64 ? stage<double>() : stage<float>();
    PBF_CUDA_CHECK(cudaEventRecord(exported_, exec_.stream()));
    PBF_CUDA_CHECK(cudaStreamWaitEvent(copy_stream_, exported_, 0));
    PBF_CUDA_CHECK(cudaMemcpyAsync(staging_host_.data(), staging_.data(), staging_.bytes(),
                                   cudaMemcpyDeviceToHost, copy_stream_));
  }

  Snapshot finish_download() override {
    PBF_CUDA_CHECK(cudaStreamSynchronize(copy_stream_));
    const char* from = staging_host_.data();
    for (FieldArray& f : pending_.fields) {
      if (f.name == "id") continue;
      std::copy_n(from, f.bytes.size(), reinterpret_cast<char*>(f.bytes.data()));
      from += f.bytes.size();
    }
    return std::move(pending_);
  }

  Measures measure() override {
    find_pairs();
    return to_measures(stepper_->measure(), scene_, plan_, updates_, steps_);
  }

  SolverState state() override { return stepper_->state(updates_, steps_); }
  void set_state(const SolverState& s) override {
    check_state(s, n_);
    stepper_->set_state(s);
    updates_ = s.updates;
    steps_ = s.steps;
  }
  StepTrace trace(const TraceOptions& options) override {
    refuse_trace(level_);
    stepper_->save(saved_);
    StepTrace t = stepper_->trace(options);
    while (grow_if_needed()) {
      stepper_->restore(saved_);
      t = stepper_->trace(options);
    }
    count(1);
    return t;
  }

  void keep() override {
    stepper_->save(kept_);
    kept_updates_ = updates_;
    kept_steps_ = steps_;
  }
  SolverState kept() override {
    if (kept_.id.size() == 0) throw Error(ExitCode::internal, "kept() before keep()");
    return stepper_->state(kept_, kept_updates_, kept_steps_);
  }
  void watch_speed(double speed) override {
    stepper_->watch_speed(speed / scene_.h());
    drop_graphs();  // they hold the parameters
  }
  std::optional<StageEvent> step_checked(const StageLimits& limits) override {
    return checked_step(&limits);
  }
  void inject(const Fault& fault) override { fault_ = fault; }

  std::vector<StageTime> timings() const override {
    std::vector<StageTime> out{{"init", init_seconds_, 1}};
    // The stages of the sampled updates, which run without the graph and so take longer, share the
    // time that all updates took.
    double sampled = 0;
    for (const auto& e : exec_.clock().entries()) sampled += e.seconds;
    for (const auto& e : exec_.clock().entries())
      out.push_back({e.name, e.seconds * (step_seconds_ / sampled), e.calls});
    return out;
  }

  SolverInfo info() const override {
    SolverInfo i;
    int device = 0, driver = 0;
    cudaDeviceProp p{};
    PBF_CUDA_CHECK(cudaGetDevice(&device));
    PBF_CUDA_CHECK(cudaGetDeviceProperties(&p, device));
    PBF_CUDA_CHECK(cudaDriverGetVersion(&driver));
    i.backend = "cuda";
    i.precision = sizeof(Real) == 8 ? "double" : "float";
    i.device = p.name;
    i.driver = "CUDA " + std::to_string(driver / 1000) + "." + std::to_string(driver % 100 / 10);
    i.vol = plan_.vol;
    i.wall_scale = plan_.wall_scale;
    i.bytes = stepper_->bytes() + saved_.bytes() + kept_.bytes() + staging_.bytes();
    i.launches = launches_;
    return i;
  }

  std::int64_t updates_done() const override { return updates_; }
  double time() const override { return double(updates_) * scene_.time.step; }

 private:
  /// So many steps, in pieces after which the host looks for lists that outgrew their room.
  void advance(std::int64_t left) {
    while (left > 0) {
      int batch = int(std::min<std::int64_t>(left, batch_));
      stepper_->save(saved_);
      run(batch);
      while (grow_if_needed()) {  // nothing was lost: the batch is done again with more room
        stepper_->restore(saved_);
        batch = batch_ = std::min(batch, kFirstBatch);
        run(batch);
      }
      left -= batch;
      batch_ = std::min(2 * batch_, largest_batch(n_));
    }
  }
  void use(const Params<Real>& p) {
    stepper_->set_params(p);
    drop_graphs();  // they hold the parameters
  }
  void count(int updates) {
    updates_ += updates;
    steps_ += std::int64_t(updates) << level_;
  }

  /// One step in a while is timed stage by stage, outside the graph; it stands for the others.
  int profile_every() const { return n_ < 100000 ? 1024 : 64; }

  void run(int batch) {
    int left = batch;
    if (since_profile_ <= 0) {
      exec_.set_profiling(true);
      stepper_->step(1);
      exec_.book(profile_every());
      exec_.set_profiling(false);
      since_profile_ = profile_every();
      --left;
    }
    since_profile_ -= batch;
    for (const int size : {0, 1, 2})
      for (; left >= kGraphUpdates[size]; left -= kGraphUpdates[size]) {
        cudaGraphExec_t& graph = graph_[size][stepper_->placement()];
        if (!graph) capture(graph, kGraphUpdates[size]);
        PBF_CUDA_CHECK(cudaGraphLaunch(graph, exec_.stream()));
        stepper_->moved();
      }
    if (left) stepper_->step(1);
  }

  /// limits may be null. Done again where lists outgrew their room.
  std::optional<StageEvent> checked_step(const StageLimits* limits) {
    const Fault* fault = fault_ ? &*fault_ : nullptr;
    std::optional<StageEvent> first, event;
    for (int s = 0; s < 1 << level_; ++s) {
      stepper_->save(saved_);
      do {
        event = stepper_->step_checked(updates_ + 1, limits, fault);
      } while (grow_if_needed() && (stepper_->restore(saved_), true));
      if (!first) first = event;
    }
    count(1);
    return first;
  }

  void find_pairs() {
    if (!stepper_->find_pairs()) return;
    while (grow_if_needed()) stepper_->relist();
  }

  /// Buffers trade places in an update, so a graph that can be replayed holds an even number of
  /// them, and there is one for each placement. Long ones spare the gaps between graphs.
  static constexpr int kGraphUpdates[3] = {64, 8, 2};
  void capture(cudaGraphExec_t& out, int updates) {
    cudaGraph_t graph = nullptr;
    PBF_CUDA_CHECK(cudaStreamBeginCapture(exec_.stream(), cudaStreamCaptureModeThreadLocal));
    stepper_->step(updates);
    PBF_CUDA_CHECK(cudaStreamEndCapture(exec_.stream(), &graph));
    std::size_t nodes = 0;
    PBF_CUDA_CHECK(cudaGraphGetNodes(graph, nullptr, &nodes));
    launches_ = double(nodes) / updates;
    const cudaError_t made = cudaGraphInstantiate(&out, graph, 0);
    cudaGraphDestroy(graph);
    PBF_CUDA_CHECK(made);
  }
  void drop_graphs() {
    for (auto& size : graph_)
      for (cudaGraphExec_t& g : size) {
        if (g) cudaGraphExecDestroy(g);
        g = nullptr;
      }
  }

  bool grow_if_needed() {
    const ListState short_of = exec_.overflow();
    if (short_of.wanted == 0 && short_of.longest == 0) return false;
    exec_.set_room(n_, larger_list_room(exec_.room(), std::max(short_of.used, short_of.wanted),
                                        short_of.longest, n_));
    exec_.clear_overflow();
    drop_graphs();  // they hold the old room
    return true;
  }

  template <class Out>
  void stage() {
    std::size_t bytes = 0;
    for (const FieldArray& f : pending_.fields)
      if (f.name != "id") bytes += f.bytes.size();
    if (!copy_stream_) {
      PBF_CUDA_CHECK(cudaStreamCreateWithFlags(&copy_stream_, cudaStreamNonBlocking));
      PBF_CUDA_CHECK(cudaEventCreateWithFlags(&exported_, cudaEventDisableTiming));
    }
    staging_.resize(bytes);
    staging_host_.resize(bytes);
    Out *at = reinterpret_cast<Out*>(staging_.data()), *position = at, *velocity = nullptr,
        *density = nullptr;
    at += 3 * std::size_t(n_);
    if (pending_.find("velocity")) {
      velocity = at;
      at += 3 * std::size_t(n_);
    }
    if (pending_.find("density")) {
      density = at;
      find_pairs();
    }
    stepper_->export_to(scene_.h(), scene_.fluid.rest_density, scene_.origin(), position, velocity,
                        density);
  }

  Scene scene_;
  Plan plan_;
  int n_;
  CudaExec exec_;
  std::unique_ptr<Stepper<Real, CudaExec>> stepper_;
  typename Stepper<Real, CudaExec>::Saved saved_, kept_;
  std::optional<Fault> fault_;
  cudaGraphExec_t graph_[3][4] = {};  ///< by size and placement
  int batch_ = kFirstBatch;
  cudaStream_t copy_stream_ = nullptr;
  cudaEvent_t exported_ = nullptr;
  DeviceBuffer<char> staging_;
  PinnedBuffer<char> staging_host_;
  Snapshot pending_;
  double init_seconds_ = 0, step_seconds_ = 0, launches_ = 0;
  int level_ = 0;
  std::int64_t updates_ = 0, steps_ = 0, kept_updates_ = 0, kept_steps_ = 0;
  int since_profile_ = 0;
};

}  // namespace

std::unique_ptr<Solver> make_stepping_solver(const Scene& scene, const Plan& plan,
                                             Particles particles, ListRoom room) {
  if (scene.precision == Precision::dbl)
    return std::make_unique<CudaSolver<double>>(scene, plan, std::move(particles), room);
  return std::make_unique<CudaSolver<float>>(scene, plan, std::move(particles), room);
}

}  // namespace pbf::inline PBF_VARIANT
