// RunOutput: what is made once (groups, provenance, fields) and the tables of parts.
#include <algorithm>
#include <numeric>

#include "lib/base/error.h"
#include "lib/io/run_layout.h"
#include "lib/io/run_output.h"

namespace pbf::inline io_module {
namespace {

using h5::check;
using h5::Column;
using run_layout::step_rows;

constexpr hsize_t max_chunk_rows = hsize_t{1} << 22;  // 50 MB of float positions

hid_t file_type(ScalarType t) {
  if (t == ScalarType::i32) return H5T_STD_I32LE;
  return t == ScalarType::f64 ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
}

}  // namespace

void RunOutput::create_steps() {
  const std::int64_t none = 0;
  steps_ = h5::make_group(vtk_, "Steps");
  h5::write_numbers(steps_, "NSteps", &none);
  const auto table = [](hid_t parent, const std::string& name, int components = 0) {
    return Column(parent, name, H5T_STD_I64LE, {step_rows, components, false, ""});
  };
  times_ = Column(steps_, "Values", H5T_IEEE_F64LE, {step_rows, 0, false, "s"});
  part_offsets_ = table(steps_, "PartOffsets");
  part_counts_ = table(steps_, "NumberOfParts");
  point_offsets_ = table(steps_, "PointOffsets");
  cell_offsets_ = table(steps_, "CellOffsets", 4);
  id_starts_ = table(steps_, "ConnectivityIdOffsets", 4);
  points_per_part_ = table(vtk_, "NumberOfPoints");
  for (std::size_t t = 0; t < topologies_.size(); ++t) {
    const std::string group = run_layout::topologies[t];
    topologies_[t].cells = table(vtk_, group + "/NumberOfCells");
    topologies_[t].ids = table(vtk_, group + "/NumberOfConnectivityIds");
    topologies_[t].ends = table(vtk_, group + "/Offsets");
    if (t > 0) table(vtk_, group + "/Connectivity");  // stays empty
  }
}

void RunOutput::write_info(const RunInfo& info) {
  h5::write_text(pbf_, "status", "running");
  h5::write_numbers(pbf_, "format_version", &run_layout::format_version);
  const auto write = [&](const char* name, const std::string& text) {
    h5::write_text(pbf_, name, text);
  };
  run_layout::for_each_text(info, write);
  run_layout::for_each_newer_text(info, write);
  h5::write_texts(pbf_, "overrides", info.overrides);
  write_warnings(info.warnings);
  const std::int64_t threads = info.solver.threads;
  const std::uint64_t bytes = info.solver.bytes;
  h5::write_numbers(pbf_, "threads", &threads);
  h5::write_numbers(pbf_, "solver_bytes", &bytes);
  h5::write_numbers(pbf_, "particles", &info.particles);
  const auto quantity = [this](const char* name, const char* unit, const double* value,
                               hsize_t count) {
    const h5::Space space(count > 1 ? H5Screate_simple(1, &count, nullptr) : H5Screate(H5S_SCALAR));
    const h5::Dataset d(
        H5Dcreate2(pbf_, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    check(H5Dwrite(d, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value));
    h5::write_text(d, "units", unit);
  };
  quantity("domain_min", "m", info.domain_min.data(), 3);
  quantity("domain_max", "m", info.domain_max.data(), 3);
  quantity("spacing", "m", &info.spacing, 1);
  quantity("smoothing_length", "m", &info.smoothing_length, 1);
  quantity("rest_density", "kg/m^3", &info.rest_density, 1);
  quantity("particle_weight", "1", &info.solver.vol, 1);
  quantity("wall_scale", "1", &info.solver.wall_scale, 1);
}

/// One a line: a text is replaced in place, a list of another length could not be.
void RunOutput::write_warnings(const std::vector<std::string>& warnings) {
  std::string lines;
  for (const std::string& w : warnings) lines += w + "\n";
  h5::write_text(pbf_, "warnings", lines);
}

void RunOutput::create_fields(const Snapshot& first) {
  const hsize_t rows = std::max<hsize_t>(1, std::max(expected_, first.count));
  const hsize_t chunks = (rows + max_chunk_rows - 1) / max_chunk_rows;
  chunk_rows_ = (rows + chunks - 1) / chunks;
  const auto offsets = [this](const std::string& name) {
    return Column(steps_, "PointDataOffsets/" + name, H5T_STD_I64LE, {step_rows, 0, false, ""});
  };
  for (const FieldArray& f : first.fields) {
    if (f.name == "id") continue;
    const bool points = fields_.empty();  // VTK wants three components there, one-row arrays flat
    const int components = points || f.components > 1 ? f.components : 0;
    fields_.push_back({f.name, f.unit, f.type, f.components,
                       Column(vtk_, points ? "Points" : "PointData/" + f.name, file_type(f.type),
                              {chunk_rows_, components, gzip_, f.unit}),
                       points ? Column() : offsets(f.name)});
  }
  // Row i is particle i in every frame, so ids and the vertices' points are stored once.
  ids_ = Column(vtk_, "PointData/id", H5T_STD_I32LE, {chunk_rows_, 0, gzip_, "1"});
  id_offsets_ = offsets("id");
  connectivity_ = Column(vtk_, "Vertices/Connectivity", H5T_STD_I64LE, {chunk_rows_, 0, gzip_, ""});
}

void RunOutput::check_fields(const Snapshot& s) const {
  const auto fail = [](const std::string& why) {
    throw Error(ExitCode::internal, "run file: bad snapshot: " + why);
  };
  if (s.fields.empty() || s.fields[0].name != "position" || s.fields[0].components != 3)
    fail("its first field is not position with 3 components");
  std::size_t k = 0;
  for (const FieldArray& f : s.fields) {
    const std::size_t values = s.count * static_cast<std::size_t>(f.components);
    if (f.components < 1 || f.bytes.size() != values * size_of(f.type))
      fail("field " + f.name + " has " + std::to_string(f.bytes.size()) + " bytes for " +
           std::to_string(s.count) + " particles");
    if (f.name == "id") {
      if (f.type != ScalarType::i32 || f.components != 1) fail("id is not one 32-bit integer");
      const auto ids = f.as<std::int32_t>();
      for (std::size_t i = 0; i < ids.size(); ++i)
        if (ids[i] != static_cast<std::int32_t>(i)) fail("rows are not in id order");
      continue;
    }
    if (!fields_.empty() && (k >= fields_.size() || f.name != fields_[k].name ||
                             f.type != fields_[k].type || f.components != fields_[k].components))
      fail("field " + f.name + " is not what the first frame had in its place");
    ++k;
  }
  if (!fields_.empty() && k != fields_.size()) fail("a field of the first frame is missing");
}

/// The row of the tables of parts for frames of `count` particles, made when there is none.
RunOutput::Part RunOutput::part_of(std::size_t count) {
  for (const Part& p : parts_)
    if (p.count == count) return p;
  const auto index = static_cast<std::int64_t>(parts_.size());
  const auto n = static_cast<std::int64_t>(count);
  points_per_part_.append(n);
  for (std::size_t t = 0; t < topologies_.size(); ++t) {
    topologies_[t].cells.append(std::int64_t{t == 0});
    topologies_[t].ids.append(t == 0 ? n : 0);
    topologies_[t].ends.append(t == 0 ? std::vector<std::int64_t>{0, n}
                                      : std::vector<std::int64_t>{0});
  }
  parts_.push_back({count, index, index});
  return parts_.back();
}

void RunOutput::grow_ids(std::size_t count) {
  const std::size_t have = ids_.rows();
  if (count <= have) return;
  std::vector<std::int64_t> next(count - have);
  std::iota(next.begin(), next.end(), static_cast<std::int64_t>(have));
  connectivity_.append(next);
  ids_.append(next);
}

}  // namespace pbf::inline io_module
