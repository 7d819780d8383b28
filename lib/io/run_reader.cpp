// RunReader: what a run was, and its frames.
#include <algorithm>
#include <sstream>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/io/h5_output.h"
#include "lib/io/h5_read.h"
#include "lib/io/run_file.h"
#include "lib/io/run_layout.h"
#include "lib/io/with_run_file.h"

namespace pbf::io_module {
namespace {

const std::string kBodies = std::string("pbf/") + run_layout::bodies;

FrameTable::Field describe(hid_t vtk, const std::string& name, const std::string& path,
                           std::size_t n) {
  FrameTable::Field f{name, "", path};
  const h5::Dataset d = h5::open_dataset(vtk, path);
  f.type = h5::scalar_type(d, path);
  const auto dims = h5::shape(d);
  if (dims.empty() || dims.size() > 2 || (dims.size() == 2 && (dims[1] < 1 || dims[1] > 64)))
    throw h5::Failure(path + " has a shape that this program does not write");
  f.components = dims.size() == 2 ? static_cast<int>(dims[1]) : 1;
  if (h5::has_attribute(d, "units")) f.unit = h5::read_text(d, "units");
  f.offsets = h5::read_all<std::int64_t>(
      vtk, name == "position" ? "Steps/PointOffsets" : "Steps/PointDataOffsets/" + name, n);
  return f;
}

FieldArray read_rows(hid_t vtk, const FrameTable::Field& place, std::size_t frame,
                     std::size_t count) {
  FieldArray f{place.name, place.unit, place.type, place.components, {}};
  const h5::Dataset d = h5::open_dataset(vtk, place.path);
  const auto dims = h5::shape(d);
  const auto first = static_cast<hsize_t>(place.offsets[frame]);
  if (place.offsets[frame] < 0 || first > dims[0] || count > dims[0] - first)
    throw h5::Failure(place.path + " ends before the frame does");
  std::vector<hsize_t> block = dims;
  block[0] = count;
  f.bytes.resize(h5::claimed(d, block, size_of(f.type)) * size_of(f.type));
  if (count) h5::read_block(d, first, block, h5::memory_type(f.type), f.bytes.data());
  return f;
}

/// The shape of the dataset of the free bodies. Failure for one that this program does not write.
std::vector<hsize_t> shape_of_bodies(hid_t bodies) {
  const auto dims = h5::shape(bodies);
  if (dims.size() != 3 || dims[1] < 1 || dims[1] > h5::Column::most_groups ||
      dims[2] != BodyMotion::kNumbers)
    throw h5::Failure("/" + kBodies + " has a shape that this program does not write");
  return dims;
}

std::vector<BodyMotion> read_bodies(hid_t file, std::size_t frame, std::size_t count) {
  std::vector<BodyMotion> bodies(count);
  if (count == 0) return bodies;
  const h5::Dataset d = h5::open_dataset(file, kBodies);
  const auto dims = shape_of_bodies(d);
  if (frame >= dims[0] || dims[1] != count)
    throw h5::Failure("/" + kBodies + " ends before the frame does");
  const std::vector<hsize_t> block{1, dims[1], dims[2]};
  std::vector<double> numbers(h5::claimed(d, block, sizeof(double)));
  h5::read_block(d, frame, block, H5T_NATIVE_DOUBLE, numbers.data());
  auto next = numbers.begin();
  for (BodyMotion& body : bodies) BodyMotion::each(body, [&](double& x) { x = *next++; });
  return bodies;
}

RunInfo read_info(hid_t pbf) {
  RunInfo info;
  run_layout::for_each_text(info, [&](const char* name, std::string& text, bool newer = false) {
    if (!newer || h5::has_attribute(pbf, name)) text = h5::read_text(pbf, name);
  });
  info.overrides = h5::read_texts(pbf, "overrides");
  if (h5::has_attribute(pbf, "warnings")) {  // older files have none
    std::istringstream lines(h5::read_text(pbf, "warnings"));
    for (std::string line; std::getline(lines, line);) info.warnings.push_back(line);
  }
  info.solver.threads = static_cast<int>(h5::read_number<std::int64_t>(pbf, "threads"));
  info.solver.bytes = h5::read_number<std::uint64_t>(pbf, "solver_bytes");
  info.particles = h5::read_number<std::int64_t>(pbf, "particles");
  if (h5::has_attribute(pbf, "capacity"))
    info.capacity = h5::read_number<std::int64_t>(pbf, "capacity");
  if (h5::has_link(pbf, run_layout::bodies))
    info.bodies = h5::read_texts(h5::open_dataset(pbf, run_layout::bodies), "names");
  run_layout::for_each_quantity(
      info, [&](const char* name, const char*, std::span<double> out, bool newer) {
        if (newer && !h5::has_link(pbf, name)) return;
        const auto values = h5::read_all<double>(pbf, name);
        if (values.size() != out.size())
          throw h5::Failure(std::string("/pbf/") + name + " has the wrong size");
        std::copy(values.begin(), values.end(), out.begin());
      });
  return info;
}

FrameTable scan(hid_t file) {
  if (!h5::has_link(file, "pbf") || !h5::has_link(file, "VTKHDF/Steps"))
    throw h5::Failure("an HDF5 file, but not one that pbf wrote (no /pbf or no /VTKHDF/Steps)");
  const h5::Group pbf = h5::open_group(file, "pbf");
  const h5::Group vtk = h5::open_group(file, "VTKHDF");
  if (!h5::has_attribute(pbf, "format_version"))
    throw h5::Failure("an HDF5 file, but not one that pbf wrote (no /pbf format_version)");
  const auto version = h5::read_number<std::int64_t>(pbf, "format_version");
  if (version != run_layout::format_version)
    throw h5::Failure("format version " + std::to_string(version) +
                      "; this program reads version " + std::to_string(run_layout::format_version));
  const h5::Group steps = h5::open_group(vtk, "Steps");
  // What lies beyond the NSteps committed rows may be half written: it is not looked at.
  auto n = static_cast<std::size_t>(
      std::max<std::int64_t>(0, h5::read_number<std::int64_t>(steps, "NSteps")));
  FrameTable in;
  in.times = h5::read_all<double>(steps, "Values", n);
  in.updates = h5::read_all<std::int64_t>(pbf, "frames/update", n);
  const auto parts = h5::read_all<std::int64_t>(steps, "PartOffsets", n);
  const auto points = h5::read_all<std::int64_t>(vtk, "NumberOfPoints");
  n = std::min({n, in.times.size(), in.updates.size(), parts.size()});
  if (n > 0) {
    in.fields.push_back(describe(vtk, "position", "Points", n));
    const h5::Group data = h5::open_group(vtk, "PointData");
    for (const auto& name : h5::children(data, H5O_TYPE_DATASET))
      in.fields.push_back(describe(vtk, name, "PointData/" + name, n));
  }
  for (const auto& f : in.fields) n = std::min(n, f.offsets.size());
  if (h5::has_link(file, kBodies)) {
    const auto dims = shape_of_bodies(h5::open_dataset(file, kBodies));
    in.bodies = static_cast<std::int64_t>(dims[1]);
    n = std::min<std::size_t>(n, dims[0]);
  }
  in.times.resize(n);
  in.updates.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    if (parts[k] < 0 || static_cast<std::size_t>(parts[k]) >= points.size() ||
        points[static_cast<std::size_t>(parts[k])] < 0)
      throw h5::Failure("frame " + std::to_string(k) + " has no number of points");
    in.counts.push_back(points[static_cast<std::size_t>(parts[k])]);
  }
  return in;
}

}  // namespace

RunReader::RunReader(const std::string& path) : path_(path) {
  note_input(path);
  in_ = with_file(path, "cannot read the run file",
                  [](const h5::Reading& file) { return scan(file); });
}

std::vector<std::string> RunReader::fields() const {
  std::vector<std::string> names;
  for (const auto& f : in_.fields)
    if (f.name != "position" && f.name != "id") names.push_back(f.name);
  return names;
}

void RunReader::require_frame(std::int64_t k) const {
  if (k < 0 || k >= frames())
    bad_input(path_, "there is no frame " + std::to_string(k) +
                         (frames() ? "; the frames are 0.." + std::to_string(frames() - 1)
                                   : "; the file has no frames yet"));
}

std::vector<BodyMotion> RunReader::bodies(std::int64_t k) const {
  require_frame(k);
  return with_file(
      path_, "cannot read the bodies of frame " + std::to_string(k), [&](const h5::Reading& file) {
        return read_bodies(file, static_cast<std::size_t>(k), static_cast<std::size_t>(in_.bodies));
      });
}

Snapshot RunReader::frame(std::int64_t k) const {
  require_frame(k);
  const auto at = static_cast<std::size_t>(k);
  const auto count = static_cast<std::size_t>(in_.counts[at]);
  return with_file(path_, "cannot read frame " + std::to_string(k), [&](const h5::Reading& file) {
    const h5::Group vtk = h5::open_group(file, "VTKHDF");
    Snapshot s{in_.updates[at], in_.times[at], count, {}};
    for (const auto& f : in_.fields) s.fields.push_back(read_rows(vtk, f, at, count));
    s.bodies = read_bodies(file, at, static_cast<std::size_t>(in_.bodies));
    return s;
  });
}

RunInfo RunReader::info() const {
  return with_file(path_, "cannot read what the run was",
                   [](const h5::Reading& file) { return read_info(h5::open_group(file, "pbf")); });
}

std::string RunReader::status() const {
  return with_file(path_, "cannot read the status", [](const h5::Reading& file) {
    return h5::read_text(h5::open_group(file, "pbf"), "status");
  });
}

std::vector<RunSession> RunReader::sessions() const {
  return with_file(path_, "cannot read the sessions", [](const h5::Reading& file) {
    std::vector<RunSession> all;
    if (!h5::has_link(file, "pbf/sessions")) return all;
    const h5::Group group = h5::open_group(file, "pbf/sessions");
    all.resize(h5::read_all<std::int64_t>(group, "last_update").size());  // written last
    for (std::size_t k = 0; k < all.size(); ++k) {
      run_layout::for_each_text(all[k], [&](const char* name, std::string& text) {
        const auto column = h5::read_fixed_texts(group, name, run_layout::session_text);
        if (k < column.size()) text = column[k];
      });
      run_layout::for_each_integer(all[k], [&](const char* name, std::int64_t& value) {
        const auto column = h5::read_all<std::int64_t>(group, name);
        if (k < column.size()) value = column[k];
      });
    }
    return all;
  });
}

}  // namespace pbf::io_module
