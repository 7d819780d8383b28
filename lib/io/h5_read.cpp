#include "lib/io/h5_read.h"

#include "lib/base/regular_file.h"

namespace pbf::io_module::h5 {
namespace {

constexpr int kMostSoftLinks = 16;  // HDF5's own limit, which ends a ring of them

constexpr const char* kRemedy =
    "; pbf reads no other file than the one that it is given: store the values in this file";

std::string link_target(hid_t parent, const std::string& path, std::size_t size) {
  if (size > 1 << 16) throw Failure(path + " is a soft link without end");
  std::string target(size, '\0');
  check(H5Lget_val(parent, path.c_str(), target.data(), size, H5P_DEFAULT));
  return target.c_str();  // up to the first zero
}

void follow(hid_t parent, const std::string& path, int links) {
  for (std::size_t end = 0; end != std::string::npos;) {
    const std::size_t begin = end;
    end = path.find('/', begin + 1);
    if (end == begin + 1) continue;  // an empty part
    const std::string here = path.substr(0, end);
    H5L_info_t info;
    if (here == "/" || H5Lget_info(parent, here.c_str(), &info, H5P_DEFAULT) < 0) continue;
    if (info.type == H5L_TYPE_HARD) continue;
    if (info.type == H5L_TYPE_EXTERNAL)
      throw Failure(here + " is a link into another file (external link)" + kRemedy);
    if (info.type != H5L_TYPE_SOFT)
      throw Failure(here + " is a link of a kind that pbf does not follow (user-defined)" +
                    kRemedy);
    if (links == kMostSoftLinks)
      throw Failure(here + " is a soft link that leads to itself, or through too many others");
    const std::string target = link_target(parent, here, info.u.val_size);
    const std::string rest = end == std::string::npos ? "" : path.substr(end);
    const bool absolute = !target.empty() && target[0] == '/';
    const std::size_t last = here.rfind('/');
    const std::string folder = last == std::string::npos ? "" : here.substr(0, last + 1);
    return follow(parent, (absolute ? "" : folder) + target + rest, links + 1);
  }
}

}  // namespace

Reading::Reading(const std::string& path) {
  if (const std::string kind = not_regular(path); !kind.empty())
    throw Failure("it is " + kind + ", not a regular file");
  file_ = File(H5Fopen(path.c_str(), H5F_ACC_RDONLY, file_access()));
}

// HDF5 would copy the bytes twice. Opened for reading it changes none of them.
Reading::Reading(const std::string& path, const std::string& bytes) {
  using Use = H5FD_file_image_op_t;
  void* const all = const_cast<char*>(bytes.data());
  H5FD_file_image_callbacks_t uncopied{
      [](std::size_t, Use, void* own) { return own; },
      [](void* to, const void*, std::size_t, Use, void*) { return to; },
      nullptr,
      [](void*, Use, void*) { return herr_t{0}; },
      [](void* own) { return own; },
      [](void*) { return herr_t{0}; },
      all};
  const Properties access = file_access();
  check(H5Pset_fapl_core(access, 1 << 16, false));
  check(H5Pset_file_image_callbacks(access, &uncopied));
  check(H5Pset_file_image(access, all, bytes.size()));
  // HDF5 refuses bytes under the name of a file that is there.
  file_ = File(H5Fopen((path + "/").c_str(), H5F_ACC_RDONLY, access));
}

void stay_inside(hid_t parent, const std::string& path) {
  require_lock();
  follow(parent, path, 0);
}

Group open_group(hid_t parent, const std::string& path) {
  stay_inside(parent, path);
  const hid_t id = H5Gopen2(parent, path.c_str(), H5P_DEFAULT);
  if (id < 0) throw Failure("group " + path + ": " + reason());
  return Group(id);
}

Dataset open_dataset(hid_t parent, const std::string& path) {
  stay_inside(parent, path);
  const hid_t id = H5Dopen2(parent, path.c_str(), H5P_DEFAULT);
  if (id < 0) throw Failure("dataset " + path + ": " + reason());
  Dataset d(id);
  const Properties how(H5Dget_create_plist(d));
  if (check(H5Pget_external_count(how)) > 0)
    throw Failure(path + " has its values in another file (external storage)" + kRemedy);
  const H5D_layout_t layout = H5Pget_layout(how);
  if (layout == H5D_VIRTUAL)
    throw Failure(path + " is put together from others (virtual dataset)" + kRemedy);
  if (layout == H5D_CHUNKED) {  // a chunk is read as a whole, whatever is wanted of it
    std::vector<hsize_t> chunk(H5S_MAX_RANK);
    chunk.resize(static_cast<std::size_t>(check(H5Pget_chunk(how, H5S_MAX_RANK, chunk.data()))));
    const Type type(H5Dget_type(d));
    claimed(d, chunk, H5Tget_size(type));
  }
  return d;
}

}  // namespace pbf::io_module::h5
