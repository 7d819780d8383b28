#include "lib/io/run_output.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "lib/base/error.h"
#include "lib/io/run_layout.h"

namespace pbf {
namespace {

using h5::check;
using h5::Column;
using h5::Layout;

// Half the number of chunks that one node of a dataset's index holds. A node that is full splits,
// which HDF5 does in an order that makes the dataset unreadable for the microseconds in between;
// a process killed there loses it. With frames of one chunk no node splits before frame 512, at
// the price of 17 kB a dataset. The tables of steps have their first chunk full at that frame.
constexpr unsigned index_rank = 256;

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

}  // namespace

RunOutput::RunOutput(const std::string& path, const RunInfo& info, bool gzip)
    : RunOutput(gzip) {  // from here on the destructor runs when this throws
  expected_ = static_cast<std::size_t>(std::max<std::int64_t>(0, info.particles));
  const h5::Properties create(H5Pcreate(H5P_FILE_CREATE));
  check(H5Pset_istore_k(create, index_rank));
  const h5::Properties access = writer_access();
  file_ = h5::File(H5Fcreate(path.c_str(), H5F_ACC_EXCL, create, access));
  vtk_ = h5::make_group(file_, "VTKHDF");
  const std::int64_t version[2] = {2, 2};
  h5::write_numbers(vtk_, "Version", version, 2);
  h5::write_ascii(vtk_, "Type", "PolyData");
  create_steps();
  pbf_ = h5::make_group(file_, "pbf");
  write_info(info);
  updates_ = Column(pbf_, "frames/update", H5T_STD_I64LE, {run_layout::step_rows, 0, false, "1"});
  for (const auto& c : run_layout::log_columns())
    log_[c.name] =
        Column(pbf_, std::string("log/") + c.name, c.number ? H5T_IEEE_F64LE : H5T_STD_I64LE,
               {run_layout::log_rows, 0, false, c.unit});
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
