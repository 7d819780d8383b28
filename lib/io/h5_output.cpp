#include "lib/io/h5_output.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace pbf::io_module::h5 {

namespace {

/// Room on the disk from byte `from` to `to`, the end of the file; where the file system cannot
/// take it, the size alone. False with an errno.
bool take(hid_t file, off_t from, off_t to) {
  return ::fallocate(descriptor(file), 0, from, to - from) == 0 ||
         (errno == EOPNOTSUPP && ::ftruncate(descriptor(file), to) == 0);
}

}  // namespace

Properties writer_access() {
  Properties p = file_access();
  check(H5Pset_cache(p, 0, 0, 0, 0));
  // Nodes of indices and collections of texts (4096 bytes) begin with a page of the disk, so that a
  // power cut tears few of them: HDF5 1.14 refuses a collection of which one page is old.
  check(H5Pset_alignment(p, 4096, 4096));
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

void sync(hid_t file) {
  const int fd = descriptor(file);
  const Unlocked others_may;
  if (::fdatasync(fd) != 0) throw Failure(std::strerror(errno));
}

std::int64_t stored_size(hid_t file) {
  const off_t size = ::lseek(descriptor(file), 0, SEEK_END);
  if (size < 0) throw Failure(std::strerror(errno));
  return size;
}

bool reserve(hid_t file, std::int64_t from) {
  haddr_t end = 0;
  check(H5Fget_eoa(file, &end));
  const off_t wanted = static_cast<off_t>(end);
  if (wanted <= from) return false;
  if (!take(file, from, wanted)) throw Failure(std::strerror(errno));
  return true;
}

bool extend(hid_t file, std::int64_t bytes) {
  haddr_t used = 0;
  check(H5Fget_eoa(file, &used));
  const std::int64_t size = stored_size(file), wanted = std::int64_t(used) + bytes;
  return wanted <= size || take(file, size, wanted);
}

void trim(hid_t file) {
  haddr_t used = 0;
  check(H5Fget_eoa(file, &used));
  if (stored_size(file) > std::int64_t(used) && ::ftruncate(descriptor(file), off_t(used)) != 0)
    throw Failure(std::strerror(errno));
}

std::int64_t flush_reserved(hid_t file, bool longer) {
  if (reserve(file, stored_size(file)) || longer)
    sync(file);  // HDF5 opens no file shorter than its first page says
  check(H5Fflush(file, H5F_SCOPE_GLOBAL));
  haddr_t end = 0;
  check(H5Fget_eoa(file, &end));
  return static_cast<std::int64_t>(end);
}

void sync_folder(const std::string& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;  // not everywhere possible; the files themselves are safe
  {
    const Unlocked others_may;
    ::fsync(fd);
  }
  ::close(fd);
}

void abandon(hid_t file) noexcept {
  try {
    const int fd = descriptor(file);
    int elsewhere = memfd_create("pbf-abandoned", 0);
    if (elsewhere < 0) elsewhere = ::open("/dev/null", O_RDWR);
    if (elsewhere >= 0) {
      dup2(elsewhere, fd);
      ::close(elsewhere);
    }
  } catch (const Failure&) {
    // no descriptor: nothing to turn away
  }
}

hid_t memory_type(ScalarType t) {
  if (is_whole(t)) return t == ScalarType::i64 ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32;
  return t == ScalarType::f64 ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT;
}

hid_t file_type(ScalarType t) {
  if (is_whole(t)) return t == ScalarType::i64 ? H5T_STD_I64LE : H5T_STD_I32LE;
  return t == ScalarType::f64 ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
}

ScalarType scalar_type(hid_t dataset, const std::string& path) {
  const Type type(H5Dget_type(dataset));
  const H5T_class_t kind = H5Tget_class(type);
  const std::size_t size = H5Tget_size(type);
  for (const ScalarType t : {ScalarType::f32, ScalarType::f64, ScalarType::i32, ScalarType::i64})
    if (size == size_of(t) && kind == (is_whole(t) ? H5T_INTEGER : H5T_FLOAT)) return t;
  throw Failure(path + " has a type that this program does not write");
}

Column::Column(hid_t parent, const std::string& path, hid_t type, const Layout& layout)
    : chunk_rows_(std::max<hsize_t>(1, layout.chunk_rows)) {
  if (layout.groups) row_.push_back(static_cast<hsize_t>(layout.groups));
  if (layout.components) row_.push_back(static_cast<hsize_t>(layout.components));
  const std::vector<hsize_t> none = shape_of(0), unlimited = shape_of(H5S_UNLIMITED),
                             chunk = shape_of(chunk_rows_);
  const int rank = static_cast<int>(chunk.size());
  const Space space(H5Screate_simple(rank, none.data(), unlimited.data()));
  const Properties create(H5Pcreate(H5P_DATASET_CREATE)), link(H5Pcreate(H5P_LINK_CREATE));
  check(H5Pset_create_intermediate_group(link, 1));
  check(H5Pset_chunk(create, rank, chunk.data()));
  check(H5Pset_fill_time(create, H5D_FILL_TIME_NEVER));  // else every write copies a whole chunk
  if (layout.gzip) {
    check(H5Pset_shuffle(create));
    check(H5Pset_deflate(create, 1));
  }
  dataset_ = Dataset(H5Dcreate2(parent, path.c_str(), type, space, link, create, H5P_DEFAULT));
  if (!layout.unit.empty()) write_text(dataset_, "units", layout.unit);
}

Column Column::existing(hid_t parent, const std::string& path) {
  Column c;
  c.dataset_ = open_dataset(parent, path);
  const auto dims = shape(c.dataset_);
  hsize_t chunk[3] = {1, 1, 1};
  const Properties create(H5Dget_create_plist(c.dataset_));
  if (dims.empty() || dims.size() > 3 || (dims.size() > 1 && dims.back() > most_components) ||
      (dims.size() == 3 && dims[1] > most_groups) || H5Pget_layout(create) != H5D_CHUNKED ||
      H5Pget_chunk(create, 3, chunk) < 1)
    throw Failure(path + " has a shape that this program does not write");
  c.rows_ = dims[0];
  c.chunk_rows_ = chunk[0];
  c.row_.assign(dims.begin() + 1, dims.end());
  return c;
}

std::vector<hsize_t> Column::shape_of(hsize_t rows) const {
  std::vector<hsize_t> shape{rows};
  shape.insert(shape.end(), row_.begin(), row_.end());
  return shape;
}

hsize_t Column::width() const {
  hsize_t numbers = 1;
  for (const hsize_t n : row_) numbers *= n;
  return numbers;
}

void Column::truncate(hsize_t rows) {
  if (rows > rows_) throw Failure("a dataset ends before what the file says it holds");
  if (rows == rows_) return;
  grow(rows);
}

void Column::write_ahead(const std::vector<double>& chunk) {
  const hsize_t first = rows_ / chunk_rows_ * chunk_rows_;
  if (chunk.size() != chunk_rows_) throw Failure("not the rows of a chunk");
  if (rows_ == 0) {  // HDF5 makes the index with the first row
    write(0, 1, H5T_NATIVE_DOUBLE, chunk.data());
    grow(0);
  }
  check(H5Dwrite_chunk(dataset_, H5P_DEFAULT, 0, &first, chunk.size() * 8, chunk.data()));
}

void Column::grow(hsize_t rows) {
  check(H5Dset_extent(dataset_, shape_of(rows).data()));
  rows_ = rows;
}

void Column::write(hsize_t first, hsize_t count, hid_t type, const void* values) {
  if (!count) return;
  if (first + count > rows_) grow(first + count);
  const Space file(H5Dget_space(dataset_));
  const hsize_t start[3] = {first, 0, 0};
  const std::vector<hsize_t> block = shape_of(count);
  check(H5Sselect_hyperslab(file, H5S_SELECT_SET, start, nullptr, block.data(), nullptr));
  const Space memory(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr));
  check(H5Dwrite(dataset_, type, memory, file, H5P_DEFAULT, values));
}

std::vector<std::uint64_t> Column::make_room(hsize_t first, hsize_t count) {
  const hsize_t end = first + count, width = this->width();
  if (end > rows_) grow(end);
  const Type type(H5Dget_type(dataset_));
  const std::vector<char> row(width * H5Tget_size(type));
  std::vector<std::uint64_t> chunks;
  for (hsize_t at = first; at < end; at += chunk_rows_) {
    write(at, 1, type, row.data());  // HDF5 takes the space of a whole chunk for it
    const hsize_t corner[3] = {at, 0, 0};
    unsigned filters = 0;
    haddr_t place = HADDR_UNDEF;
    hsize_t bytes = 0;
    check(H5Dget_chunk_info_by_coord(dataset_, corner, &filters, &place, &bytes));
    if (place == HADDR_UNDEF || bytes != chunk_rows_ * row.size())
      throw Failure("HDF5 has made no room for a chunk");
    chunks.push_back(place);
  }
  return chunks;
}

}  // namespace pbf::io_module::h5
