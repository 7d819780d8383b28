#include "lib/io/run_output.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "lib/base/error.h"
#include "lib/io/h5_output.h"
#include "lib/io/run_layout.h"

namespace pbf::io_module {
namespace {

using h5::check;

// Half the number of chunks that one node of a dataset's index holds. A node that is full splits,
// which HDF5 does in an order that makes the dataset unreadable for the microseconds in between;
// a process killed there loses it. With frames of one chunk no node splits before frame 512, at
// the price of 17 kB a dataset. The tables of steps have their first chunk full at that frame.
constexpr unsigned index_rank = 256;

}  // namespace

RunOutput::RunOutput(const std::string& path, const RunInfo& info, bool gzip)
    : RunOutput(info, gzip) {  // from here on the destructor runs when this throws
  const h5::Properties create(H5Pcreate(H5P_FILE_CREATE));
  check(H5Pset_istore_k(create, index_rank));
  const h5::Properties access = h5::writer_access();
  file_ = h5::File(H5Fcreate(path.c_str(), H5F_ACC_EXCL, create, access));
  vtk_ = h5::make_group(file_, "VTKHDF");
  const std::int64_t version[2] = {2, 2};
  h5::write_numbers(vtk_, "Version", version, 2);
  h5::write_ascii(vtk_, "Type", "PolyData");
  steps_ = h5::make_group(vtk_, "Steps");
  h5::write_number(steps_, "NSteps", std::int64_t{0});
  make_tables(0);
  pbf_ = h5::make_group(file_, "pbf");
  write_info(info);
  make_log(0, 0);
  make_bodies(0);
  make_gauges(0);
  make_sessions();
  begin_session(info);
  store();
  const auto folder = std::filesystem::absolute(path).parent_path();
  h5::sync_folder(folder);
  h5::sync_folder(folder.parent_path());
}

RunOutput::~RunOutput() {
  if (!closed_ && file_.open()) h5::abandon(file_);  // not ended by close(): a failure
}

void RunOutput::write_frame(const Snapshot& s) {
  if (added_ % run_layout::step_rows == 0) commit();  // their times are in one chunk of the table
  if (added_ > frames_) {
    std::int64_t bytes = std::int64_t{1} << 20;  // of tables and indices
    for (const FieldArray& f : s.fields) bytes += 2 * std::int64_t(f.bytes.size());
    if (h5::extend(file_, bytes))
      longer_ = true;
    else
      commit();  // while it is possible: the disk is nearly full
  }
  add_frame(s, nullptr);
  commit_if_due();
}

void RunOutput::commit_if_due() {
  if (!since_commit_ || since_commit_->seconds() >= run_layout::commit_seconds) commit();
}

FramePlaces RunOutput::begin_frame(const Snapshot& head) {
  FramePlaces places;
  const std::int64_t before = h5::stored_size(file_);
  add_frame(head, &places);
  places.chunk_rows = static_cast<std::int64_t>(chunk_rows_);
  longer_ = h5::reserve(file_, before) || longer_;
  in_steps_ = true;
  return places;
}

void RunOutput::commit_frame() {
  in_steps_ = false;
  commit();
}

void RunOutput::rows(std::size_t field, std::int64_t first, const FieldArray& rows) {
  const std::size_t row = static_cast<std::size_t>(rows.components) * size_of(rows.type);
  fields_.at(field).data.write(frame_row_ + static_cast<hsize_t>(first), rows.bytes.size() / row,
                               h5::memory_type(rows.type), rows.bytes.data());
}

std::uint64_t RunOutput::inode() const {
  struct stat s {};
  return ::fstat(h5::descriptor(file_), &s) == 0 ? s.st_ino : 0;
}

void RunOutput::add_frame(const Snapshot& s, FramePlaces* places) {
  check_fields(s, places != nullptr);
  check_bodies(s, places != nullptr);
  if (fields_.empty()) create_fields(s);
  const hsize_t first = s.count == 0 ? end_row_ : whole_chunks(end_row_);  // never behind the end
  frame_row_ = first;
  const auto start = static_cast<std::int64_t>(first);
  std::size_t k = 0;
  for (const FieldArray& f : s.fields) {
    if (f.name == "id") continue;
    Field& field = fields_[k++];
    if (!places)
      field.data.write(first, s.count, h5::memory_type(f.type), f.bytes.data());
    else if (!gzip_)
      places->chunks.push_back(field.data.make_room(first, s.count));
    if (field.offsets.open()) field.offsets.append(start);
  }
  end_row_ = first + s.count;
  id_offsets_.append(write_ids(s, places != nullptr));
  const std::int64_t part = part_of(s.count);
  part_offsets_.append(part);
  part_counts_.append(std::int64_t{1});
  point_offsets_.append(start);
  cell_offsets_.append(std::vector<std::int64_t>{part, 0, 0, 0});
  id_starts_.append(std::vector<std::int64_t>{0, 0, 0, 0});
  updates_.append(s.update);
  write_bodies(s);
  last_times_[added_++ % run_layout::step_rows] = s.time;
}

/// In the order that a power cut must not change: what the frames consist of; then NSteps, which
/// readers trust; then the size of Values, for VTK's reader overruns its heap when that is longer.
void RunOutput::commit() {
  if (added_ == frames_ || in_steps_) return;
  times_.write_ahead(last_times_);
  store();
  set_steps(added_);
  store();
  times_.grow(static_cast<hsize_t>(added_));
  store();
  frames_ = added_;
  since_commit_.emplace();
}

void RunOutput::set_steps(std::int64_t frames) {
  const h5::Attribute count(H5Aopen(steps_, "NSteps", H5P_DEFAULT));
  check(H5Awrite(count, H5T_NATIVE_INT64, &frames));
}

void RunOutput::flush() {
  write_log();
  write_gauges();
  bytes_ = h5::flush_reserved(file_, std::exchange(longer_, false));
}

void RunOutput::store() {
  flush();
  h5::sync(file_);
}

void RunOutput::sync() {
  commit();
  store();
}

void RunOutput::close(const RunEnding& end) {
  commit();
  flush();
  end_session(end.reason.empty() ? end.status : end.reason, end.last_update);
  write_warnings(end.warnings);
  write_comparisons(end.comparisons);
  h5::write_text(pbf_, "status", end.status);
  flush();
  h5::trim(file_);
  h5::sync(file_);
  closed_ = true;
}

}  // namespace pbf::io_module
