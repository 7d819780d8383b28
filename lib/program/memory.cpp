#include "lib/program/memory.h"

#include <algorithm>
#include <cmath>

#include "kernels/cell_index.h"
#include "kernels/compression_bins.h"
#include "kernels/measure.h"
#include "kernels/smoothing.h"
#include "lib/base/text.h"
#include "lib/program/list_capacity.h"
#include "lib/program/plan.h"
#include "lib/program/threads.h"

namespace pbf::inline program_module {
namespace {

std::int64_t size_of(const std::string& type) {
  if (type == "byte") return 1;
  return type == "double" || type == "int64" ? 8 : 4;
}

/// Adds arrays to a plan, one kind of lifetime and place at a time.
struct Adder {
  MemoryPlan& memory;
  bool on_device;
  Held held;
  void operator()(const char* name, const std::string& type, int components,
                  std::int64_t elements) const {
    if (elements > 0)
      memory.arrays.push_back({name, type, components, elements,
                               size_of(type) * components * elements, on_device, held});
  }
};

bool has_field(const Scene& s, const char* name) {
  if (s.output) {
    const auto& f = s.output->fields;
    if (std::find(f.begin(), f.end(), name) != f.end()) return true;
  }
  if (!s.render || s.render->color == ColorBy::id) return false;
  return std::string(name) == (s.render->color == ColorBy::speed ? "velocity" : "density");
}

/// Scalars of one particle that a download brings, the id apart.
int downloaded_scalars(const Scene& s) {
  if (!s.output && !s.render) return 0;
  return 3 + (has_field(s, "velocity") ? 3 : 0) + (has_field(s, "density") ? 1 : 0);
}

void add_state(const Plan& plan, std::int64_t bins, bool guard, const std::string& real,
               const Adder& add) {
  // The lists name one particle more, far away, and lanes read further (padding of the executors).
  const std::int64_t n = plan.particles, padded = n + (add.on_device ? 1 : 16);
  for (const FieldInfo* f : plan.program.fields) {
    if (f == &field::order && !add.on_device) continue;  // it stands in id'
    const std::int64_t rows = f->rows == Rows::bins     ? bins + 1
                              : f->rows == Rows::padded ? padded
                                                        : n;
    for (const char* which : {"", "'"})
      if (*which == '\0' || f->doubled)
        add((std::string(f->name) + which).c_str(), f->type == Type::real ? real : "int32",
            f->components, rows);
  }
  if (guard) {  // the last good state
    add("kept position", real, 4, n);
    add("kept velocity", real, 4, n);
    add("kept id", "int32", 1, n);
  }
  if (add.on_device)
    add("sums of a measure by block", "int64",
        int((sizeof(MeasureCounts) + sizeof(MeasureTerms)) / 8), reduce_blocks(n) + 1);
  add("histogram of compression", "int64", 1, kCompressionBins);
}

bool has_random_places(const Scene& s) {
  return std::any_of(s.bodies.begin(), s.bodies.end(),
                     [](const Body& b) { return b.shape == Shape::random_box; });
}

/// The largest of 8 or 16 random numbers is 1.42 or 1.77 standard deviations above their mean.
double deviations_of_longest(const Scene& s) { return s.precision == Precision::dbl ? 1.42 : 1.77; }

/// Entries of one list, what fills up its group included: of the longest, and on average. 0 where
/// the start was not counted.
struct StartEntries {
  double mean = 0, most = 0;
};
StartEntries start_entries(const Scene& s, const Plan& plan) {
  StartEntries e;
  const bool random = has_random_places(s);
  const double n = double(plan.start.count.size()), deviations = deviations_of_longest(s);
  for (std::size_t i = 0; i < plan.start.count.size(); ++i) {
    // Random places scatter like Poisson's numbers at least, others by a fifth, from the surface of
    // a body to its inside.
    const double m = plan.start.count[i], poisson = deviations * std::sqrt(m);
    const double entries = m + std::max(random ? poisson : std::min(poisson, 0.2 * m),
                                        deviations * plan.start.scatter[i]);
    e.mean += entries / n;
    e.most = std::max(e.most, entries);
  }
  return e;
}

void add_cpu_lists(const Scene& s, const Plan& plan, const Adder& add) {
  const std::int64_t n = plan.particles, chunks = (n + 1023) / 1024;
  const int entries = cpu_list_entries(s), threads = solver_threads(s, n);
  const StartEntries start = start_entries(s, plan);
  add("lists", "int32", 1, std::int64_t(double(n) * std::max(double(entries), start.mean)));
  add("groups of lists", "int32", 2, chunks * 1024 / 8);
  add("table of lists", "int64", 3, chunks);
  add("neighbours found by each thread", "int32", 1,
      std::min<std::int64_t>(threads, chunks) *
          std::max(cpu_scratch_entries(entries),  // grows by a quarter more than it must
                   std::int64_t(1.25 * double(std::min<std::int64_t>(n, 1024)) * start.most)));
}

/// At first, and grown to the start's lists as the solver does.
ListCapacity list_capacity(const Scene& s, const Plan& plan) {
  const std::int64_t n = plan.particles;
  ListCapacity capacity = first_list_capacity(rest_neighbors(s), n);
  const std::vector<int>& sample = plan.start.count;
  if (sample.empty()) return capacity;
  const int longest = *std::max_element(sample.begin(), sample.end());
  for (;;) {
    const auto more = std::count_if(sample.begin(), sample.end(),
                                    [&](int entries) { return entries > 4 * capacity.first; });
    const auto overflows = std::int64_t(double(more) * double(n) / double(sample.size()));
    if (overflows <= capacity.overflows && longest <= capacity.longest()) return capacity;
    capacity =
        larger_list_capacity(capacity, overflows, longest > capacity.longest() ? longest : 0, n);
  }
}

void add_cuda_lists(const Scene& s, const Plan& plan, std::int64_t bins, const std::string& real,
                    const Adder& add) {
  const std::int64_t n = plan.particles;
  const ListCapacity capacity = list_capacity(s, plan);
  if (n > kSortParticles || bins > kSortBins) {
    add("particles of each bin", "int32", 1, bins + 1);
    add("scratch of the scan", "byte", 1, bins / 240 + 1024);  // CUB: 16 bytes a tile
  }
  add("slot", "int32", 1, n);
  add("lists", "int32", 4, std::int64_t(list_stride(int(n))) * capacity.first);
  add("overflow of long lists", "int32", 4, std::int64_t(capacity.overflows) * capacity.overflow);
  add("length of a list", "int32", 1, n);
  add("overflow of a list", "int32", 1, n);
  add("saved position", real, 4, n);  // a batch of updates is done again when a list outgrows it
  add("saved velocity", real, 4, n);
  add("saved id", "int32", 1, n);
}

/// While the solver is made. Emission and conversion let go of each array as soon as it is used.
std::int64_t add_start(const Scene& s, const Plan& plan, const std::string& real,
                       MemoryPlan& memory) {
  const std::int64_t n = plan.particles, r = size_of(real);
  const Adder add{memory, false, Held::start};
  add("emitted position", "double", 3, n);
  add("emitted velocity", "double", 3, n);
  add("initial position", real, 4, n);
  add("initial velocity", real, 4, n);
  add("initial id", "int32", 1, n);
  std::int64_t peak = n * std::max(48 + 4 * r, 24 + 8 * r + 4);
  for (const Body& b : s.bodies)
    if (b.shape == Shape::file) peak = n * 96;  // a file's particles, and those of all bodies
  return peak;
}

/// While the compression is taken out of the start (lib/run/prestabilize.h): what that takes
/// beside the solver, which keeps no good state yet.
std::int64_t add_prestabilize(const Scene& s, const Plan& plan, const std::string& real,
                              MemoryPlan& memory) {
  if (!s.solver.prestabilize || s.solver.iterations == 0) return 0;
  const std::int64_t n = plan.particles, kept = n * (8 * size_of(real) + 4);
  Adder{memory, false, Held::start}("positions around steps without time", "double", 3, 2 * n);
  return 48 * n - (s.guard && s.backend == Backend::cpu ? kept : 0);
}

/// What frames and pictures take: on the host beside the solver, and the staging on the device.
void add_output(const Scene& s, const Plan& plan, MemoryPlan& memory) {
  const int scalars = downloaded_scalars(s);
  if (scalars == 0) return;
  const std::int64_t n = plan.particles;
  const bool cuda = s.backend == Backend::cuda;
  const std::string real = s.output && s.output->precision == Precision::dbl ? "double" : "float";
  if (cuda) {
    Adder{memory, true, Held::solver}("staging of a download", real, scalars, n);
    Adder{memory, false, Held::solver}("pinned copy of a download", real, scalars, n);
  }
  // Updates on a device outrun the writer, which lets two frames wait; those of a CPU do not.
  const int frames = cuda ? 3 : 1;
  const Adder add{memory, false, Held::output};
  add("frames under way", real, scalars, frames * n);
  add("ids of frames under way", "int32", 1, frames * n);
  if (s.output) add("vertex numbers of the first frame", "int64", 1, n);
  if (s.output && s.output->compression == Compression::gzip)
    add("chunk before and after compression", real, 3, 2 * std::min<std::int64_t>(n, 1 << 22));
  if (!s.render) return;
  const int colored = s.render->color == ColorBy::speed     ? 6
                      : s.render->color == ColorBy::density ? 4
                                                            : 3;
  add("pictures waiting", real, colored, frames * n);
  add("vertices, and the driver's copy", "byte", 16, 2 * n);
  const std::int64_t pixels = std::int64_t(s.render->size[0]) * s.render->size[1];
  add("2 x 2 samples, colour and depth", "byte", 8, 4 * pixels);
  add("picture, read back and as RGB", "byte", 11, pixels);
  // llvmpipe's lists of what covers each tile: a fit to its growth from 8 000 to 500 000 particles.
  add("tiles of the software rasteriser", "byte", 1,
      std::int64_t(std::max(0.0, 6000 * std::pow(double(n), 0.8) - 8e6)));
}

/// Measured: see tests/regression/lean_check and the table in the README.
void add_fixed(const Scene& s, MemoryPlan& memory) {
  const auto mb = [](double x) { return std::int64_t(x * 1e6); };
#ifdef PBF_HAS_CUDA
  const double program = 19;  // with the device's code
#else
  const double program = 17;
#endif
  memory.fixed.push_back({"program and libraries", mb(program)});
  if (s.output) memory.fixed.push_back({"HDF5 and the writer's thread", mb(10), false, true});
  if (s.render) memory.fixed.push_back({"OpenGL and LLVM in software", mb(81), false, true});
  if (s.backend == Backend::cuda) {
    memory.fixed.push_back({"CUDA driver on the host", mb(129 - program)});
    memory.fixed.push_back({"CUDA kernels and graphs on the host", mb(27), false, true});
    memory.fixed.push_back({"CUDA context on the device", mb(560), true});
  }
}

std::int64_t sum(const MemoryPlan& m, bool on_device, Held held) {
  std::int64_t bytes = 0;
  for (const PlanArray& a : m.arrays)
    if (a.on_device == on_device && a.held == held) bytes += a.bytes;
  return bytes;
}

}  // namespace

const char* held_name(Held held) {
  switch (held) {
    case Held::start:
      return "start";
    case Held::solver:
      return "solver";
    case Held::output:
      return "output";
  }
  return "";
}

std::int64_t MemoryPlan::solver_bytes() const {
  const std::int64_t device = sum(*this, true, Held::solver);
  return device > 0 ? device : sum(*this, false, Held::solver);
}

std::int64_t MemoryPlan::fixed_bytes(bool on_device) const {
  std::int64_t bytes = 0;
  for (const FixedMemory& f : fixed)
    if (f.on_device == on_device) bytes += f.bytes;
  return bytes;
}

double rest_neighbors(const Scene& s) {
  const double ratio = s.fluid.smoothing_ratio;
  return s.dimensions == 2 ? kPi * ratio * ratio : 4.0 / 3.0 * kPi * std::pow(ratio, 3);
}

int cpu_list_entries(const Scene& s) {
  const double mean = rest_neighbors(s);
  const double spread = deviations_of_longest(s) * std::sqrt(mean);
  const double entries = has_random_places(s) ? mean + spread : 1.1 * mean;
  return std::clamp(int(std::ceil(entries)), 1, 1 << 20);
}

StartCrowd start_crowd(const Scene& s, const Plan& plan) {
  StartCrowd crowd;
  for (const int m : plan.start.count) crowd.neighbors += m / double(plan.start.count.size());
  crowd.decides = start_entries(s, plan).mean > cpu_list_entries(s);
  return crowd;
}

std::string memory_remedy(const Scene& s, const Plan& plan) {
  const StartCrowd crowd = start_crowd(s, plan);
  if (!crowd.decides) return "increase fluid.spacing";
  return format(
      "its particles start so close that each has about %.0f neighbours within h = %g m, where "
      "fluid at rest has %.0f, and each takes room in a list: spread the bodies (bodies[].min, "
      "max), "
      "give fewer particles (bodies[].count)",
      crowd.neighbors, s.h(), rest_neighbors(s));
}

MemoryPlan plan_memory(const Scene& s, const Plan& plan) {
  MemoryPlan memory;
  const bool cuda = s.backend == Backend::cuda;
  const std::string real = s.precision == Precision::dbl ? "double" : "float";
  const std::int64_t bins =
      std::int64_t(plan.cells[0]) * plan.cells[1] * plan.cells[2] * bins_per_cell(s.dimensions);
  const Adder solver{memory, cuda, Held::solver};
  add_state(plan, bins, bool(s.guard), real, solver);
  if (cuda)
    add_cuda_lists(s, plan, bins, real, solver);
  else
    add_cpu_lists(s, plan, solver);
  add_output(s, plan, memory);
  const std::int64_t start = add_start(s, plan, real, memory);
  const std::int64_t relieved = add_prestabilize(s, plan, real, memory);
  add_fixed(s, memory);
  std::int64_t later = 0;
  for (const FixedMemory& f : memory.fixed) later += f.after_start ? f.bytes : 0;
  memory.host_arrays =
      std::max(start - later, sum(memory, false, Held::solver) +
                                  std::max(sum(memory, false, Held::output), relieved - later));
  memory.device_arrays = sum(memory, true, Held::solver);
  return memory;
}

}  // namespace pbf::inline program_module
