#include "lib/io/run_output.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <numeric>

#include "lib/base/error.h"
#include "lib/io/run_layout.h"

namespace pbf {
namespace {

using h5::check;
using h5::Column;
using h5::Layout;

constexpr hsize_t max_chunk_rows = hsize_t{1} << 22;  // 50 MB of float positions
// Half the number of chunks that one node of a dataset's index holds. A node that is full splits,
// which HDF5 does in an order that makes the dataset unreadable for the microseconds in between;
// a process killed there loses it. With frames of one chunk no node splits before frame 512, at
// the price of 17 kB a dataset. The tables of steps have their first chunk full at that frame.
constexpr unsigned index_rank = 256;
constexpr hsize_t step_rows = 512;  // chunks of the tables of steps
constexpr hsize_t log_rows = 1024;  // chunks of the log's columns
constexpr std::size_t max_waiting_rows = 256;
constexpr double max_waiting_seconds = 5;

hid_t file_type(ScalarType t) {
  if (t == ScalarType::i32) return H5T_STD_I32LE;
  return t == ScalarType::f64 ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
}

hid_t memory_type(ScalarType t) {
  if (t == ScalarType::i32) return H5T_NATIVE_INT32;
  return t == ScalarType::f64 ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT;
}

/// Rows go to the disk at once, so that a full disk is noticed before anything refers to them; what
/// refers to them stays in memory until a flush, so that the file is as the last flush left it.
h5::Properties writer_access() {
  h5::Properties p = h5::file_access();
  check(H5Pset_cache(p, 0, 0, 0, 0));
  H5AC_cache_config_t cache;
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  check(H5Pget_mdc_config(p, &cache));
  cache.evictions_enabled = false;
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  check(H5Pset_mdc_config(p, &cache));
  return p;
}

int descriptor(hid_t file) {
  void* handle = nullptr;
  check(H5Fget_vfd_handle(file, H5P_DEFAULT, &handle));
  return *static_cast<int*>(handle);
}

h5::Group make_group(hid_t parent, const char* name) {
  return h5::Group(H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
}

}  // namespace

RunOutput::RunOutput(const std::string& path, const RunInfo& info, bool gzip)
    : RunOutput(gzip) {  // from here on the destructor runs when this throws
  expected_ = static_cast<std::size_t>(std::max<std::int64_t>(0, info.particles));
  const h5::Properties create(H5Pcreate(H5P_FILE_CREATE));
  check(H5Pset_istore_k(create, index_rank));
  const h5::Properties access = writer_access();
  file_ = h5::File(H5Fcreate(path.c_str(), H5F_ACC_EXCL, create, access));
  vtk_ = make_group(file_, "VTKHDF");
  const std::int64_t version[2] = {2, 2};
  h5::write_numbers(vtk_, "Version", version, 2);
  h5::write_ascii(vtk_, "Type", "PolyData");
  create_steps();
  pbf_ = make_group(file_, "pbf");
  write_info(info);
  updates_ = Column(pbf_, "frames/update", H5T_STD_I64LE, {step_rows, 0, false, "1"});
  for (const auto& c : run_layout::log_columns())
    log_[c.name] = Column(pbf_, std::string("log/") + c.name,
                          c.number ? H5T_IEEE_F64LE : H5T_STD_I64LE, {log_rows, 0, false, c.unit});
  flush();
}

RunOutput::~RunOutput() {
  if (closed_ || !file_.open()) return;
  // Not ended by close(): a failure. HDF5 insists on writing what it still holds and can neither
  // be told to forget it nor end cleanly when it fails again (a full disk), so its descriptor is
  // turned away from the file first.
  try {
    const int fd = descriptor(file_);
    int elsewhere = memfd_create("pbf-abandoned", 0);
    if (elsewhere < 0) elsewhere = ::open("/dev/null", O_RDWR);
    if (elsewhere >= 0) {
      dup2(elsewhere, fd);
      ::close(elsewhere);
    }
  } catch (const h5::Failure&) {
    // no descriptor: nothing to turn away
  }
}

void RunOutput::create_steps() {
  const std::int64_t none = 0;
  steps_ = make_group(vtk_, "Steps");
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
  const std::pair<const char*, const std::string*> texts[] = {
      {"scene_path", &info.scene_path},
      {"scene_text", &info.scene_text},
      {"resolved_scene", &info.resolved_scene},
      {"program_version", &info.program_version},
      {"commit", &info.commit},
      {"compiler", &info.compiler},
      {"build_flags", &info.build_flags},
      {"host", &info.host},
      {"started", &info.started},
      {"plan", &info.plan},
      {"backend", &info.solver.backend},
      {"precision", &info.solver.precision},
      {"device", &info.solver.device},
      {"driver", &info.solver.driver}};
  h5::write_text(pbf_, "status", "running");
  h5::write_numbers(pbf_, "format_version", &run_layout::format_version);
  for (const auto& [name, text] : texts) h5::write_text(pbf_, name, *text);
  h5::write_texts(pbf_, "overrides", info.overrides);
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

void RunOutput::write_frame(const Snapshot& s) {
  check_fields(s);
  if (fields_.empty()) create_fields(s);
  const hsize_t first = (end_row_ + chunk_rows_ - 1) / chunk_rows_ * chunk_rows_;
  const auto start = static_cast<std::int64_t>(first);
  std::size_t k = 0;
  for (const FieldArray& f : s.fields) {
    if (f.name == "id") continue;
    Field& field = fields_[k++];
    field.data.write(first, s.count, memory_type(f.type), f.bytes.data());
    if (field.offsets.open()) field.offsets.append(start);
  }
  end_row_ = first + s.count;
  grow_ids(s.count);
  id_offsets_.append(std::int64_t{0});
  const Part part = part_of(s.count);
  part_offsets_.append(part.index);
  part_counts_.append(std::int64_t{1});
  point_offsets_.append(start);
  cell_offsets_.append(std::vector<std::int64_t>{part.cell_offset, 0, 0, 0});
  id_starts_.append(std::vector<std::int64_t>{0, 0, 0, 0});
  updates_.append(s.update);
  write_log();
  flush();
  // The commit. Readers trust NSteps; VTK's overruns its heap when Values is longer than that.
  // The group's header lies before the column's in the file, so a flush writes NSteps first.
  const std::int64_t steps = frames_ + 1;
  const h5::Attribute count(H5Aopen(steps_, "NSteps", H5P_DEFAULT));
  check(H5Awrite(count, H5T_NATIVE_INT64, &steps));
  times_.append(s.time);
  flush();
  frames_ = steps;
}

void RunOutput::log(const LogRow& row) {
  if (waiting_.empty()) since_log_.reset();
  waiting_.push_back(row);
  if (waiting_.size() >= max_waiting_rows || since_log_.seconds() > max_waiting_seconds) {
    write_log();
    flush();
  }
}

void RunOutput::write_log() {
  if (waiting_.empty()) return;
  std::vector<std::int64_t> integers(waiting_.size());
  std::vector<double> numbers(waiting_.size());
  for (const auto& c : run_layout::log_columns()) {
    Column& column = log_.at(c.name);
    if (c.number) {
      std::transform(waiting_.begin(), waiting_.end(), numbers.begin(), c.number);
      column.append(numbers);
    } else {
      std::transform(waiting_.begin(), waiting_.end(), integers.begin(), c.integer);
      column.append(integers);
    }
  }
  write_stages();
  waiting_.clear();
}

/// A stage that a row does not name took no time in it.
void RunOutput::write_stages() {
  const hsize_t first = log_.at("time").rows() - waiting_.size();
  for (const LogRow& row : waiting_)
    for (const StageTime& stage : row.stages)
      if (Column& column = stages_[stage.name]; !column.open())
        column = Column(pbf_, "log/stage/" + stage.name, H5T_IEEE_F64LE, {log_rows, 0, false, "s"});
  for (auto& [name, column] : stages_) {
    std::vector<double> seconds;
    for (const LogRow& row : waiting_) {
      seconds.push_back(0);
      for (const StageTime& stage : row.stages)
        if (stage.name == name) seconds.back() += stage.seconds;
    }
    column.write(first, seconds.size(), H5T_NATIVE_DOUBLE, seconds.data());
  }
}

/// Writes what HDF5 holds in memory. It goes on after a failed write and would leave a file that
/// refers to what is not there, so the space is made sure of first: nothing can fail after that.
void RunOutput::flush() {
  haddr_t end = 0;
  check(H5Fget_eoa(file_, &end));
  const int fd = descriptor(file_);
  const off_t size = ::lseek(fd, 0, SEEK_END), wanted = static_cast<off_t>(end);
  if (size < 0) throw h5::Failure(std::strerror(errno));
  if (wanted > size && ::fallocate(fd, 0, size, wanted - size) != 0 &&
      !(errno == EOPNOTSUPP && ::ftruncate(fd, wanted) == 0))
    throw h5::Failure(std::strerror(errno));
  check(H5Fflush(file_, H5F_SCOPE_GLOBAL));
  bytes_ = static_cast<std::int64_t>(end);
}

void RunOutput::close(const std::string& status) {
  write_log();
  flush();
  h5::write_text(pbf_, "status", status);
  flush();
  // Network file systems and quotas report a full disk only here.
  if (fsync(descriptor(file_)) != 0) throw h5::Failure(std::strerror(errno));
  closed_ = true;
}

}  // namespace pbf
