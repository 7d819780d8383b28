// RunOutput: going on in a file that is there, and the table of the processes that wrote it.
#include <algorithm>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/own_file.h"
#include "lib/base/part_file.h"
#include "lib/base/text.h"
#include "lib/io/h5_output.h"
#include "lib/io/run_layout.h"
#include "lib/io/run_output.h"

namespace pbf::io_module {
namespace {

using h5::check;

/// What a process killed in the middle of a commit has left may lie behind the end that the file
/// knows of; space is taken only behind that.
h5::File open_again(const std::string& path) {
  require_own_file(path);
  if (!wait_for_parts(std::filesystem::path(path).parent_path().string(), 10))
    throw h5::Failure("a process of an earlier run still writes its part of it; end that process");
  h5::File file(H5Fopen(path.c_str(), H5F_ACC_RDWR, h5::writer_access()));
  check(H5Fincrement_filesize(file, 0));
  return file;
}

h5::Type session_text() {
  h5::Type t(H5Tcopy(H5T_C_S1));
  check(H5Tset_size(t, run_layout::session_text));
  check(H5Tset_strpad(t, H5T_STR_NULLPAD));
  check(H5Tset_cset(t, H5T_CSET_UTF8));
  return t;
}

void put_text(h5::Column& column, hsize_t row, const std::string& text) {
  char bytes[run_layout::session_text] = {};
  std::size_t size = std::min(text.size(), sizeof bytes);
  while (size < text.size() && size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0) == 0x80)
    --size;  // whole characters
  text.copy(bytes, size);
  column.write(row, 1, session_text(), bytes);
}

}  // namespace

RunOutput::RunOutput(const std::string& path, const RunInfo& info, bool gzip, std::int64_t frames,
                     const KeptRows& rows)
    : RunOutput(info, gzip) {
  opening_ = true;
  file_ = open_again(path);
  vtk_ = h5::open_group(file_, "VTKHDF");
  steps_ = h5::open_group(vtk_, "Steps");
  pbf_ = h5::open_group(file_, "pbf");
  open_steps(frames);
  make_log(static_cast<hsize_t>(frames), static_cast<hsize_t>(rows.log));
  make_bodies(static_cast<hsize_t>(frames));
  open_further(static_cast<hsize_t>(rows.log));
  make_gauges(static_cast<hsize_t>(rows.gauges));
  opening_ = false;
  store();  // Values is never longer than NSteps
  set_steps(frames);
  frames_ = added_ = frames;
  h5::write_text(pbf_, "status", "running");
  if (h5::read_text(pbf_, "resolved_scene") != info.resolved_scene) {  // a later end
    h5::write_text(pbf_, "resolved_scene", info.resolved_scene);
    h5::write_text(pbf_, "plan", info.plan);
  }
  // Always: an older version had none, and a process may have been killed between the two.
  run_layout::for_each_text(info,
                            [&](const char* name, const std::string& text, bool newer = false) {
                              if (newer) h5::write_text(pbf_, name, text);
                            });
  make_sessions();
  begin_session(info);
  flush();
}

void RunOutput::open_steps(std::int64_t frames) {
  const auto n = static_cast<hsize_t>(frames);
  const auto points = h5::read_all<std::int64_t>(vtk_, "NumberOfPoints");
  std::size_t used = 0;
  for (const std::int64_t p : h5::read_all<std::int64_t>(steps_, "PartOffsets", n)) {
    const auto part = static_cast<std::size_t>(p);
    if (p < 0 || part >= points.size() || points[part] < 0)
      throw h5::Failure("a frame has no number of points");
    used = std::max(used, part + 1);
  }
  parts_.assign(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(used));
  make_tables(n);
  const auto times = h5::read_all<double>(steps_, "Values");
  std::copy(times.begin() + frames / run_layout::step_rows * run_layout::step_rows, times.end(),
            last_times_.begin());
  open_fields(frames);
}

void RunOutput::open_fields(std::int64_t frames) {
  if (frames == 0) return;
  const auto n = static_cast<hsize_t>(frames);
  const auto starts = h5::read_all<std::int64_t>(steps_, "PointOffsets");
  const auto parts = h5::read_all<std::int64_t>(steps_, "PartOffsets");
  end_row_ = static_cast<hsize_t>(starts.back() + parts_[static_cast<std::size_t>(parts.back())]);
  const auto open = [&](const std::string& name, const std::string& path) {
    const h5::Dataset d = h5::open_dataset(vtk_, path);
    const auto dims = h5::shape(d);
    Field f{name,
            "",
            h5::scalar_type(d, path),
            dims.size() == 2 ? static_cast<int>(dims[1]) : 1,
            h5::Column::existing(vtk_, path),
            name == "position" ? h5::Column() : offsets(name, n)};
    f.data.truncate(end_row_);
    return f;
  };
  fields_.push_back(open("position", "Points"));
  chunk_rows_ = fields_[0].data.chunk_rows();
  // In the order in which a snapshot has them (empty_snapshot()).
  for (const char* name : {"velocity", "density"})
    if (h5::has_link(vtk_, std::string("PointData/") + name))
      fields_.push_back(open(name, std::string("PointData/") + name));
  const auto ids = h5::read_all<std::int64_t>(steps_, "PointDataOffsets/id", n);
  if (ids.size() < n) throw h5::Failure("a frame has no ids");
  const h5::Dataset d = h5::open_dataset(vtk_, "PointData/id");
  const hsize_t begun = h5::shape(d).at(0);
  hsize_t most = numbered_ = std::min<hsize_t>(expected_, begun), end = most;
  for (std::size_t k = 0; k < n; ++k) {
    const auto count = static_cast<hsize_t>(parts_[static_cast<std::size_t>(parts[k])]);
    most = std::max(most, count);
    if (ids[k] == 0) numbered_ = std::max(numbered_, count);
    end = std::max(end, static_cast<hsize_t>(ids[k]) + count);
  }
  make_ids(h5::scalar_type(d, "PointData/id"), n, end, most);
}

void RunOutput::open_further(hsize_t rows) {
  const h5::Group log = h5::open_group(pbf_, "log");
  for (const auto& name : h5::datasets_below(log, run_layout::log_groups))
    if (!log_.contains(name)) (further_[name] = h5::Column::existing(log, name)).truncate(rows);
}

void RunOutput::make_sessions() {
  const bool there = h5::has_link(pbf_, "sessions");
  const h5::Layout layout{run_layout::session_rows, 0, false, ""};
  const auto column = [&](const char* name, hid_t type) {
    const std::string path = std::string("sessions/") + name;
    sessions_[name] =
        there ? h5::Column::existing(pbf_, path) : h5::Column(pbf_, path, type, layout);
  };
  RunSession none;
  run_layout::for_each_text(none,
                            [&](const char* name, const auto&) { column(name, session_text()); });
  run_layout::for_each_integer(none,
                               [&](const char* name, const auto&) { column(name, H5T_STD_I64LE); });
}

void RunOutput::begin_session(const RunInfo& info) {
  RunSession s;
  s.started = info.started;
  s.host = info.host;
  s.device = info.solver.backend;
  s.device += " " + info.solver.precision + ", " + info.solver.device;
  s.program = info.program_version;
  s.program += " (" + info.commit + ")";
  s.threads = info.solver.threads;
  s.first_update = s.last_update = info.first_update;
  const hsize_t row = sessions_.at("started").rows();
  run_layout::for_each_text(s, [&](const char* name, const std::string& text) {
    put_text(sessions_.at(name), row, text);
  });
  run_layout::for_each_integer(s, [&](const char* name, const std::int64_t& value) {
    sessions_.at(name).write(row, 1, H5T_NATIVE_INT64, &value);
  });
}

void RunOutput::end_session(const std::string& reason, std::int64_t last_update) {
  const hsize_t row = sessions_.at("started").rows() - 1;
  put_text(sessions_.at("ended"), row, utc_now());
  put_text(sessions_.at("reason"), row, reason);
  sessions_.at("last_update").write(row, 1, H5T_NATIVE_INT64, &last_update);
}

}  // namespace pbf::io_module
