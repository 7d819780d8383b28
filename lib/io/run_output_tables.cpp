// RunOutput: what is made once (groups, provenance, fields) and the tables of parts.
#include <algorithm>
#include <numeric>

#include "lib/base/error.h"
#include "lib/io/run_layout.h"
#include "lib/io/run_output.h"

namespace pbf::io_module {
namespace {

using run_layout::step_rows;

constexpr hsize_t max_chunk_rows = hsize_t{1} << 22;  // 50 MB of float positions

}  // namespace

RunOutput::RunOutput(const RunInfo& info, bool gzip)
    : gzip_(gzip),
      expected_(
          static_cast<std::size_t>(std::max({std::int64_t{0}, info.particles, info.capacity}))),
      body_names_(info.bodies),
      columns_(info.columns) {}

h5::Column RunOutput::column(hid_t parent, const std::string& path, hid_t type,
                             const h5::Layout& layout, hsize_t rows) const {
  if (!opening_) return h5::Column(parent, path, type, layout);
  h5::Column c = h5::Column::existing(parent, path);
  c.truncate(rows);
  return c;
}

/// Of `frames` frames and the parts that these name.
void RunOutput::make_tables(hsize_t frames) {
  const hsize_t parts = parts_.size();
  const auto table = [&](hid_t parent, const std::string& name, hsize_t rows, int components = 0) {
    return column(parent, name, H5T_STD_I64LE, {step_rows, components, false, ""}, rows);
  };
  times_ = column(steps_, "Values", H5T_IEEE_F64LE, {step_rows, 0, false, "s"}, frames);
  part_offsets_ = table(steps_, "PartOffsets", frames);
  part_counts_ = table(steps_, "NumberOfParts", frames);
  point_offsets_ = table(steps_, "PointOffsets", frames);
  cell_offsets_ = table(steps_, "CellOffsets", frames, 4);
  id_starts_ = table(steps_, "ConnectivityIdOffsets", frames, 4);
  points_per_part_ = table(vtk_, "NumberOfPoints", parts);
  for (std::size_t t = 0; t < topologies_.size(); ++t) {
    const std::string group = run_layout::topologies[t];
    topologies_[t].cells = table(vtk_, group + "/NumberOfCells", parts);
    topologies_[t].ids = table(vtk_, group + "/NumberOfConnectivityIds", parts);
    topologies_[t].ends = table(vtk_, group + "/Offsets", t == 0 ? 2 * parts : parts);
    if (t > 0) table(vtk_, group + "/Connectivity", 0);  // stays empty
  }
}

h5::Column RunOutput::offsets(const std::string& field, hsize_t frames) const {
  return column(steps_, "PointDataOffsets/" + field, H5T_STD_I64LE, {step_rows, 0, false, ""},
                frames);
}

/// The vertices' points, 0, 1, 2 ..., are stored once, `rows` so far; ids as write_ids() says.
void RunOutput::make_ids(ScalarType type, hsize_t frames, hsize_t ids, hsize_t rows) {
  id_type_ = type;
  ids_ = column(vtk_, "PointData/id", h5::file_type(type), {chunk_rows_, 0, gzip_, "1"}, ids);
  id_offsets_ = offsets("id", frames);
  connectivity_ =
      column(vtk_, "Vertices/Connectivity", H5T_STD_I64LE, {chunk_rows_, 0, gzip_, ""}, rows);
}

void RunOutput::make_log(hsize_t frames, hsize_t rows) {
  updates_ = column(pbf_, "frames/update", H5T_STD_I64LE, {step_rows, 0, false, "1"}, frames);
  for (const auto& c : run_layout::log_columns())
    log_[c.name] =
        column(pbf_, std::string("log/") + c.name, c.real ? H5T_IEEE_F64LE : H5T_STD_I64LE,
               {run_layout::log_rows, 0, false, c.unit}, rows);
}

void RunOutput::write_info(const RunInfo& info) {
  h5::write_text(pbf_, "status", "running");
  h5::write_number(pbf_, "format_version", run_layout::format_version);
  const auto write = [&](const char* name, const std::string& text, bool = false) {
    h5::write_text(pbf_, name, text);
  };
  run_layout::for_each_text(info, write);
  h5::write_texts(pbf_, "overrides", info.overrides);
  write_warnings(info.warnings);
  h5::write_number(pbf_, "threads", std::int64_t{info.solver.threads});
  h5::write_number(pbf_, "solver_bytes", std::uint64_t{info.solver.bytes});
  h5::write_number(pbf_, "particles", info.particles);
  if (info.capacity > 0) h5::write_number(pbf_, "capacity", info.capacity);
  run_layout::for_each_quantity(info, [this](const char* name, const char* unit,
                                             std::span<const double> values, bool) {
    const std::vector<hsize_t> shape(values.size() > 1 ? 1 : 0, values.size());
    h5::write_dataset(pbf_, name, H5T_IEEE_F64LE, shape, H5T_NATIVE_DOUBLE, values.data(), unit);
  });
}

/// One a line: a text is replaced in place, a list of another length could not be.
void RunOutput::write_warnings(const std::vector<std::string>& warnings) {
  std::string lines;
  for (const std::string& w : warnings) lines += w + "\n";
  // Rewriting many of them would touch pages that a power cut may then tear.
  if (h5::has_attribute(pbf_, "warnings") && h5::read_text(pbf_, "warnings") == lines) return;
  h5::write_text(pbf_, "warnings", lines);
}

void RunOutput::write_comparisons(const std::vector<StoredComparison>& comparisons) {
  if (h5::has_link(pbf_, run_layout::compare))  // of a run that is gone on with
    check(H5Ldelete(pbf_, run_layout::compare, H5P_DEFAULT));
  if (comparisons.empty()) return;
  const h5::Group all = h5::make_group(pbf_, run_layout::compare);
  for (const StoredComparison& c : comparisons) {
    const h5::Group group = h5::make_group(all, c.name.c_str());
    for (const auto& [name, text] : c.texts) h5::write_text(group, name.c_str(), text);
    for (const StoredComparison::Number& n : c.numbers)
      h5::write_dataset(group, n.name.c_str(), H5T_IEEE_F64LE, {}, H5T_NATIVE_DOUBLE, &n.value,
                        n.unit.c_str());
  }
}

void RunOutput::create_fields(const Snapshot& first) {
  const hsize_t rows = std::max<hsize_t>(1, std::max(expected_, first.count));
  const hsize_t chunks = (rows + max_chunk_rows - 1) / max_chunk_rows;
  chunk_rows_ = (rows + chunks - 1) / chunks;
  for (const FieldArray& f : first.fields) {
    if (f.name == "id") continue;
    const bool points = fields_.empty();  // VTK wants three components there, one-row arrays flat
    const int components = points || f.components > 1 ? f.components : 0;
    fields_.push_back({f.name, f.unit, f.type, f.components,
                       h5::Column(vtk_, points ? "Points" : "PointData/" + f.name,
                                  h5::file_type(f.type), {chunk_rows_, components, gzip_, f.unit}),
                       points ? h5::Column() : offsets(f.name, 0)});
  }
  make_ids(first.find("id")->type, 0, 0, 0);
}

void RunOutput::check_fields(const Snapshot& s, bool split) const {
  const auto fail = [](const std::string& why) {
    throw Error(ExitCode::internal, "run file: bad snapshot: " + why);
  };
  if (s.fields.empty() || s.fields[0].name != "position" || s.fields[0].components != 3)
    fail("its first field is not position with 3 components");
  if (!s.find("id")) fail("it has no ids");
  std::size_t k = 0;
  for (const FieldArray& f : s.fields) {
    const std::size_t values = (split ? 0 : s.count) * static_cast<std::size_t>(f.components);
    if (f.components < 1 || f.bytes.size() != values * size_of(f.type))
      fail("field " + f.name + " has " + std::to_string(f.bytes.size()) + " bytes for " +
           std::to_string(s.count) + " particles");
    if (f.name == "id") {
      if (!is_whole(f.type) || f.components != 1) fail("id is not one whole number");
      if (!fields_.empty() && f.type != id_type_)
        fail("ids are not of the type of the first frame");
      for (std::size_t i = 0; i < s.count && !split; ++i)
        if (f.whole(i) <= (i > 0 ? f.whole(i - 1) : -1)) fail("rows are not in id order");
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
std::int64_t RunOutput::part_of(std::size_t count) {
  const auto n = static_cast<std::int64_t>(count);
  const auto found = std::ranges::find(parts_, n);
  const std::int64_t index = found - parts_.begin();
  if (found != parts_.end()) return index;
  points_per_part_.append(n);
  for (std::size_t t = 0; t < topologies_.size(); ++t) {
    topologies_[t].cells.append(std::int64_t{t == 0});
    topologies_[t].ids.append(t == 0 ? n : 0);
    topologies_[t].ends.append(t == 0 ? std::vector<std::int64_t>{0, n}
                                      : std::vector<std::int64_t>{0});
  }
  parts_.push_back(n);
  return index;
}

/// The row at which the ids of a frame begin. The column begins with 0, 1, 2 ..., as far as a run
/// has particles at most, for all frames that have these ids, and with them the vertices' points.
/// Behind them lie the ids of each frame that has others.
std::int64_t RunOutput::write_ids(const Snapshot& s, bool split) {
  const auto count_up = [this](h5::Column& column, hsize_t first, hsize_t end) {
    for (hsize_t next = first; first < end; first = next) {  // in whole chunks
      next = std::min(end, (first / chunk_rows_ + 1) * chunk_rows_);
      std::vector<std::int64_t> list(next - first);
      std::iota(list.begin(), list.end(), static_cast<std::int64_t>(first));
      column.append(list);
    }
  };
  const hsize_t wanted = std::max<hsize_t>(s.count, numbered_ > 0 ? 0 : expected_);
  if (const hsize_t have = connectivity_.rows(); wanted > have)
    count_up(connectivity_, have, wanted);
  if (wanted > numbered_ && ids_.rows() == numbered_) {
    count_up(ids_, numbered_, wanted);
    numbered_ = wanted;
  }
  const FieldArray& id = *s.find("id");
  const bool counts_up =
      s.count == 0 || split || id.whole(s.count - 1) == std::int64_t(s.count) - 1;
  if (counts_up && s.count <= numbered_) return 0;
  const hsize_t first = whole_chunks(std::max<hsize_t>(ids_.rows(), 1));
  ids_.write(first, s.count, h5::memory_type(id.type), id.bytes.data());
  return static_cast<std::int64_t>(first);
}

}  // namespace pbf::io_module
