#include "lib/program/memory.h"

#include <algorithm>

#include "kernels/cell_index.h"
#include "kernels/compression_bins.h"
#include "kernels/measure.h"
#include "kernels/smoothing.h"
#include "lib/base/text.h"
#include "lib/program/list_capacity.h"
#include "lib/program/list_memory.h"
#include "lib/program/loads.h"
#include "lib/program/plan.h"
#include "lib/program/rank_plan.h"
#include "lib/program/solid_maps.h"
#include "lib/program/threads.h"

namespace pbf::program_module {
namespace {

std::int64_t sum(const MemoryPlan& m, bool on_device, Held held) {
  std::int64_t bytes = 0;
  for (const PlanArray& a : m.arrays)
    if (a.on_device == on_device && a.held == held) bytes += a.bytes;
  return bytes;
}

bool has_field(const Scene& s, const char* name) {
  if (s.output) {
    const auto& f = s.output->fields;
    if (std::find(f.begin(), f.end(), name) != f.end()) return true;
  }
  return s.render && std::string(name) == about(s.render->color).field;
}

/// Scalars per particle of a download, without the id.
int downloaded_scalars(const Scene& s) {
  if (!s.output && !s.render) return 0;
  return 3 + (has_field(s, "velocity") ? 3 : 0) + (has_field(s, "density") ? 1 : 0);
}

void add_fields(const Scene& s, const Plan& plan, std::int64_t bins, const Adder& add) {
  const BackendInfo& backend = about(s.backend);
  const Sizes sizes{s, plan, plan.capacity, backend.padding, bins};
  const auto add_field = [&](const std::string& name, const FieldInfo& f, std::int64_t rows) {
    const int row = f.bytes(s.precision);
    const char* type = f.type == Type::real    ? word(s.precision)
                       : f.type == Type::int64 ? "int64"
                       : f.type == Type::int32 ? "int32"
                                               : "byte";
    add(name.c_str(), type, f.type == Type::object ? row : f.components, rows);
  };
  for (const FieldInfo* f : plan.program.fields) {
    if (f == &field::order && backend.order_in_place) continue;
    add_field(f->name, *f, f->rows(sizes));
    if (f->pair) add_field(f->name + std::string("'"), *f, f->rows(sizes));
  }
  // The last good state of the guard, and the state from which a batch of updates is repeated.
  for (const FieldInfo* f : plan.program.state) {
    if (s.guard) add_field("kept " + std::string(f->name), *f, f->kept_rows(sizes));
    if (add.on_device) add_field("saved " + std::string(f->name), *f, f->kept_rows(sizes));
  }
  const std::int64_t n = plan.capacity;
  if (changes_rows(s)) add("order of ids", "int32", 1, n);
  if (plan.images > 0) {
    add("images beyond periodic faces, now and next", "int32", 2 * 3, plan.images);
    add("row of each particle", "int32", 1, plan.particles);
  }
  if (add.on_device)
    add("sums of a measure by block", "int64",
        int((sizeof(MeasureCounts) + sizeof(MeasureTerms)) / 8), reduce_blocks(n) + 1);
  add("histogram of compression", "int64", 1, kCompressionBins);
  if (add.on_device)  // CUB: a histogram per block of some 6000 particles, at most 396 on an H200
    add("scratch of the histogram", "int64", kCompressionBins,
        std::min<std::int64_t>(n / 6000, 396) + 1);
}

/// While the solver is created. Emission and conversion free each array as soon as it was used.
std::int64_t add_start(const Scene& s, const Plan& plan, const std::string& real,
                       MemoryPlan& memory) {
  const std::int64_t n = plan.most_particles(), r = size_of(real);
  const Adder add{memory, false, Held::start};
  add("emitted position", "double", 3, n);
  add("emitted velocity", "double", 3, n);
  add("initial position", real, 4, n);
  add("initial velocity", real, 4, n);
  add("initial id", "int32", 1, n);
  std::int64_t peak = n * std::max(48 + 4 * r, 24 + 8 * r + 4);
  for (const Body& b : s.bodies)
    if (b.from_file()) peak = n * 96;  // particles of the file and of all bodies
  return s.settle ? peak + 48 * n : peak;
}

bool is_relieved(const Scene& s, const Plan& plan) {
  if (!s.solver.prestabilize || s.solver.iterations == 0) return false;
  // A single body on its lattice has no compression.
  return !plan.start.empty() || s.bodies.size() > 1 || !s.obstacles.empty();
}

/// Additional memory beside the solver while the start settles (lib/run/settle.h) or is relieved of
/// compression (lib/run/prestabilize.h). The solver has no kept state yet.
std::int64_t add_before_run(const Scene& s, const Plan& plan, const std::string& real,
                            MemoryPlan& memory) {
  const Adder add{memory, false, Held::start};
  std::int64_t start = 0;
  if (s.settle) {  // the solver that settles is gone before that of the run is made
    add("particles while the start settles", "double", 6, plan.most_particles());
    add("positions of the settled start", "double", 3, plan.most_particles());
    start = 72 * plan.most_particles();
  }
  if (!is_relieved(s, plan)) return start;
  const std::int64_t n = plan.most_particles(), kept = n * (8 * size_of(real) + 4);
  add("positions around steps without time", "double", 3, 2 * n);
  if (s.settle) return std::max(start, 96 * n);
  return 48 * n - (s.guard && !about(s.backend).on_device ? kept : 0);
}

/// The same of a rank, for positions on their way to ranges of ids.
std::int64_t add_moves(const Scene& s, const Plan& plan, MemoryPlan& memory) {
  if (!s.settle && !is_relieved(s, plan)) return 0;
  const std::int64_t n = plan.capacity;
  Adder{memory, false, Held::start}("positions around steps without time", "double", 13, n);
  return 104 * n;
}
/// Frames of a rank: its rows, those of its range of ids, and a field on the way.
void add_split_output(const Scene& s, const Plan& plan, MemoryPlan& memory) {
  const int scalars = downloaded_scalars(s);
  if (scalars == 0) return;
  const std::int64_t n = plan.capacity;
  const std::string real = word(s.output ? s.output->precision : Precision::single);
  if (about(s.backend).on_device) {
    Adder{memory, true, Held::solver}("staging of a download", real, scalars, n);
    Adder{memory, false, Held::solver}("pinned copy of a download", real, scalars, n);
  }
  const Adder add{memory, false, Held::output};
  add("frame under way", real, scalars, n);
  add("a field on its way to ranges of ids", real, 6, n);
  add("ids of frames under way", "int64", 2, n);
}

/// Memory of frames and pictures: on the host beside the solver, and staging on the device. Returns
/// the bytes that stay allocated between them.
std::int64_t add_output(const Scene& s, const Plan& plan, MemoryPlan& memory) {
  const int scalars = downloaded_scalars(s);
  if (scalars == 0) return 0;
  const std::int64_t n = plan.most_particles();
  const bool on_device = about(s.backend).on_device;
  const std::string real = word(s.output ? s.output->precision : Precision::single);
  if (on_device) {
    Adder{memory, true, Held::solver}("staging of a download", real, scalars, n);
    Adder{memory, false, Held::solver}("pinned copy of a download", real, scalars, n);
  }
  // A device is faster than the writer, whose queue holds two frames; a CPU is slower.
  const int frames = on_device ? 3 : 1;
  const Adder add{memory, false, Held::output};
  add("frames under way", real, scalars, frames * n);
  add("ids of frames under way", "int32", 1, frames * n);
  if (s.output) add("vertex numbers of the first frame", "int64", 1, n);
  // Chunks before and after, of several sizes; malloc holds as much unused memory as is in use.
  if (s.output && s.output->compression == Compression::gzip)
    add("chunks before and after compression", real, 3, 4 * std::min<std::int64_t>(n, 1 << 22));
  if (!s.render) return 0;
  const int colored = 3 + about(s.render->color).components;
  add("pictures waiting", real, colored, frames * n);
  const std::int64_t before = sum(memory, false, Held::output);
  add("vertices, and the driver's copy", "byte", 16, 2 * n);
  const std::int64_t pixels = std::int64_t(s.render->size[0]) * s.render->size[1];
  add("2 x 2 samples, colour and depth", "byte", 8, 4 * pixels);
  add("picture, read back and as RGB", "byte", 11, pixels);
  if (s.dimensions == 3)
    add("shadow map, at most", "byte", 4, std::int64_t(kShadowTexels) * kShadowTexels);
  if (const int bytes = about(s.render->style).bytes_per_pixel)
    add("depth and thickness of the surface", "byte", bytes, pixels);
  // llvmpipe keeps a list of primitives per tile and empties it at this size. Measured with 3 500
  // to 460 000 particles.
  add("tiles of the software rasteriser", "byte", 1, std::min<std::int64_t>(700 * n, 28 << 20));
  return sum(memory, false, Held::output) - before;
}

/// A checkpoint: the state in the form of io/checkpoint.h, and a chunk with its checksum.
void add_checkpoint(const Scene& s, const Plan& plan, const std::string& real, MemoryPlan& memory) {
  if (!s.checkpoint) return;
  const Adder add{memory, false, Held::checkpoint};
  const std::int64_t n = plan.most_particles();
  add("state for a checkpoint", "double", 6, n);
  add("ids for a checkpoint", "int64", 1, n);
  add("chunk before and after its checksum", real, 3, 2 * std::min<std::int64_t>(n, 1 << 18));
}

/// Measured: see tests/regression/lean_check and tests/regression/lean/README.md.
void add_fixed(const Scene& s, const Plan& plan, MemoryPlan& memory) {
  const auto mb = [](double x) { return std::int64_t(x * 1e6); };
#ifdef PBF_HAS_CUDA
  // The device's code is mapped, and read only by a run on a device. 18.4 where it is compiled for
  // one architecture with -O3, 19.8 with -O1.
  const double program = 19;
#else
  const double program = 17.4;
#endif
  memory.fixed.push_back({"program and libraries", mb(program)});
  if (has_solids(s) && s.backend == Backend::cpu)
    memory.fixed.push_back({"code of walls with loads and obstacles", mb(0.5)});
  if (s.output || s.checkpoint) memory.fixed.push_back({"HDF5", mb(4.5), false, true});
  if (s.output)  // per dataset two nodes with keys, and HDF5's data about each
    memory.fixed.push_back(
        {"indices of the run file", mb(0.068 * run_file_datasets(plan, s)), false, true});
  if (s.output && s.output->compression == Compression::gzip)
    memory.fixed.push_back({"zlib", mb(0.8), false, true});
  if (s.render) {
    // Mesa 22.3 takes 9 MB less (with a surface 12 MB) if it finds the shaders of an earlier run on
    // disk, and OSMesa 5 MB less than EGL. The value is in the upper half of this range.
    memory.fixed.push_back({"OpenGL and LLVM in software", mb(91.3), false, true});
    if (s.render->style == RenderStyle::surface)
      memory.fixed.push_back({"shaders of the surface", mb(6), false, true});
    if (!s.obstacles.empty())
      memory.fixed.push_back({"shaders of the obstacles", mb(2), false, true});
  }
  if (s.backend == Backend::cuda) {
    memory.fixed.push_back({"CUDA driver on the host", mb(129 - program)});
    memory.fixed.push_back({"CUDA kernels and graphs on the host", mb(27), false, true});
    memory.fixed.push_back({"CUDA context on the device", mb(560), true});
  }
}

}  // namespace

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

namespace {

MemoryPlan memory_of(const Scene& s, const Plan& plan, bool rank) {
  MemoryPlan memory;
  const std::string real = word(s.precision);
  const std::int64_t bins =
      std::int64_t(plan.cells[0]) * plan.cells[1] * plan.cells[2] * bins_per_cell(s.dimensions);
  const Adder solver{memory, about(s.backend).on_device, Held::solver};
  add_fields(s, plan, bins, solver);
  if (solver.on_device)
    add_cuda_lists(s, plan, bins, rank, solver);
  else
    add_cpu_lists(s, plan, solver);
  std::int64_t stays = 0;
  if (rank)
    add_split_output(s, plan, memory);
  else
    stays = add_output(s, plan, memory);
  add_checkpoint(s, plan, real, memory);
  const std::int64_t start = add_start(s, plan, real, memory);
  const std::int64_t relieved =
      rank ? add_moves(s, plan, memory) : add_before_run(s, plan, real, memory);
  add_fixed(s, plan, memory);
  std::int64_t maps = 0;  // on the host, in double
  for_each_map(plan.solids, 8, [&](std::size_t, const auto& map, const MapRows&, bool first) {
    if (first) maps += 40 * map.nodes() + 4 * map.all_bricks();
  });
  if (maps > 0) memory.fixed.push_back({"maps of surfaces", maps});
  std::int64_t later = 0;
  for (const FixedMemory& f : memory.fixed) later += f.after_start ? f.bytes : 0;
  const std::int64_t beside =
      std::max({sum(memory, false, Held::output), stays + sum(memory, false, Held::checkpoint),
                relieved - later});
  memory.host_arrays = std::max(start - later, sum(memory, false, Held::solver) + beside);
  memory.device_arrays = sum(memory, true, Held::solver);
  return memory;
}

}  // namespace

MemoryPlan plan_memory(const Scene& s, const Plan& plan) { return memory_of(s, plan, false); }
MemoryPlan plan_memory_of_rank(const Scene& s, const Plan& plan) {
  return memory_of(s, plan, true);
}

std::vector<MemoryChoice> memory_choices(const Scene& scene, const Plan& plan) {
  std::vector<MemoryChoice> out;
  for (const Backend backend : all_of<Backend>())
    for (const Precision precision : all_of<Precision>()) {
      Scene choice = scene;
      choice.backend = backend;
      choice.precision = precision;
      out.push_back({backend, precision, plan_memory(choice, plan)});
    }
  return out;
}

}  // namespace pbf::program_module
