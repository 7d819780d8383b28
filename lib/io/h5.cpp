#include "lib/io/h5.h"

#include <cstring>

#include "lib/base/error.h"
#include "lib/base/plain_text.h"
#include "lib/io/h5_read.h"

namespace pbf::io_module::h5 {
namespace {

std::mutex process_mutex;
thread_local bool held_here = false;

std::string name_of(hid_t object) {
  char name[200] = "";
  return H5Iget_name(object, name, sizeof name) > 0 ? name : "without a name";
}

herr_t take_first(unsigned, const H5E_error2_t* error, void* out) {
  auto& text = *static_cast<std::string*>(out);
  if (text.empty() && error->desc) text = error->desc;
  return 0;
}

}  // namespace

Lock::Lock() : lock_(process_mutex) {
  held_here = true;
  static const bool once = [] {
    H5dont_atexit();           // fails when HDF5 is already in use: then its own clean-up stays
    H5PLset_loading_state(0);  // filters of plugins: code of a folder that the environment names
    H5Lunregister(H5L_TYPE_EXTERNAL);  // open_group() says it; nothing else goes there either
    return true;
  }();
  (void)once;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // a setting of the calling thread's stack
}

Lock::~Lock() { held_here = false; }

bool Lock::held() { return held_here; }

Unlocked::Unlocked() {
  if (!held_) return;
  held_here = false;
  process_mutex.unlock();
}

Unlocked::~Unlocked() {
  if (!held_) return;
  process_mutex.lock();
  held_here = true;
}

void require_lock() {
  if (!Lock::held()) throw Error(ExitCode::internal, "HDF5 is used without h5::Lock");
}

std::string reason() {
  std::string text;  // innermost entry first
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &text);
  const std::string key = "error message = '";
  if (const auto at = text.find(key); at != std::string::npos) {
    const auto begin = at + key.size();
    return text.substr(begin, text.find('\'', begin) - begin);
  }
  return text.empty() ? "HDF5 gives no reason" : text;
}

Properties file_access() {
  Properties p(H5Pcreate(H5P_FILE_ACCESS));
#if H5_VERSION_GE(1, 10, 7)
  check(H5Pset_file_locking(p, false, true));
#endif
  return p;
}

Type string_type() {
  Type t(H5Tcopy(H5T_C_S1));
  check(H5Tset_size(t, H5T_VARIABLE));
  check(H5Tset_cset(t, H5T_CSET_UTF8));
  return t;
}

Group make_group(hid_t parent, const char* name) {
  return Group(H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
}

Attribute make_attribute(hid_t object, const char* name, hid_t type, std::optional<hsize_t> count) {
  const Space space(count ? H5Screate_simple(1, &*count, nullptr) : H5Screate(H5S_SCALAR));
  return Attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
}

void write_text(hid_t object, const char* name, const std::string& value) {
  const std::string plain = escaped(value);  // a path may hold anything; readers refuse it
  const Type type = string_type();
  const Attribute a = has_attribute(object, name) ? Attribute(H5Aopen(object, name, H5P_DEFAULT))
                                                  : make_attribute(object, name, type);
  const char* text = plain.c_str();
  check(H5Awrite(a, type, &text));
}

void write_texts(hid_t object, const char* name, const std::vector<std::string>& values) {
  const Type type = string_type();
  const Attribute a = make_attribute(object, name, type, values.size());
  std::vector<const char*> texts;
  for (const auto& v : values) texts.push_back(v.c_str());
  if (!texts.empty()) check(H5Awrite(a, type, texts.data()));
}

void write_ascii(hid_t object, const char* name, const std::string& value) {
  const Type type(H5Tcopy(H5T_C_S1));
  check(H5Tset_size(type, value.size()));
  check(H5Tset_strpad(type, H5T_STR_NULLPAD));
  check(H5Awrite(make_attribute(object, name, type), type, value.data()));
}

void write_dataset(hid_t parent, const char* name, hid_t type, const std::vector<hsize_t>& shape,
                   hid_t from, const void* values, const char* unit, hid_t create) {
  const Space space(shape.empty() ? H5Screate(H5S_SCALAR)
                                  : H5Screate_simple(int(shape.size()), shape.data(), nullptr));
  const Dataset d(H5Dcreate2(parent, name, type, space, H5P_DEFAULT, create, H5P_DEFAULT));
  check(H5Dwrite(d, from, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  write_text(d, "units", unit);
}

int descriptor(hid_t file) {
  void* handle = nullptr;
  check(H5Fget_vfd_handle(file, H5P_DEFAULT, &handle));
  return *static_cast<int*>(handle);
}

bool has_attribute(hid_t object, const char* name) { return H5Aexists(object, name) > 0; }

bool has_link(hid_t group, const std::string& path) {
  for (std::size_t at = 0; at != std::string::npos;) {
    at = path.find('/', at + 1);
    const std::string part = path.substr(0, at);
    if (H5Lexists(group, part.c_str(), H5P_DEFAULT) <= 0) return false;
    stay_inside(group, part);
  }
  return true;
}

std::vector<std::string> read_texts(hid_t object, const char* name) {
  const Attribute a(H5Aopen(object, name, H5P_DEFAULT));
  const Type stored(H5Aget_type(a));
  if (H5Tis_variable_str(stored) <= 0)
    throw Failure(std::string("attribute ") + name + " is not a string of variable length");
  const Space space(H5Aget_space(a));
  const auto count = check(H5Sget_simple_extent_npoints(space));
  if (count > 1 << 12) throw Failure(std::string("attribute ") + name + " has too many texts");
  std::vector<char*> texts(static_cast<std::size_t>(count));
  if (texts.empty()) return {};
  const Type type = string_type();
  check(H5Aread(a, type, texts.data()));
  std::vector<std::string> values;
  for (const char* t : texts) values.emplace_back(t ? t : "");
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, texts.data());
  for (const std::string& v : values)
    if (const auto bad = find_bad_text(v))
      throw Failure(std::string("attribute ") + name + " is not plain text: " + bad->what);
  return values;
}

std::vector<std::string> read_fixed_texts(hid_t group, const std::string& path, std::size_t size) {
  const Dataset d = open_dataset(group, path);
  const Type stored(H5Dget_type(d));
  const auto dims = shape(d);
  if (H5Tget_class(stored) != H5T_STRING || H5Tis_variable_str(stored) != 0 ||
      H5Tget_size(stored) != size || dims.size() != 1)
    throw Failure(path + " does not hold texts of " + std::to_string(size) + " bytes");
  std::vector<char> bytes(claimed(d, dims, size) * size);
  if (!bytes.empty()) check(H5Dread(d, stored, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()));
  std::vector<std::string> texts;
  for (hsize_t k = 0; k < dims[0]; ++k)
    texts.emplace_back(bytes.data() + k * size, strnlen(bytes.data() + k * size, size));
  return texts;
}

std::string read_text(hid_t object, const char* name) {
  const auto values = read_texts(object, name);
  if (values.size() != 1) throw Failure(std::string("attribute ") + name + " is not one string");
  return values[0];
}

std::vector<hsize_t> shape(hid_t dataset) {
  const Space space(H5Dget_space(dataset));
  std::vector<hsize_t> dims(static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space))));
  check(H5Sget_simple_extent_dims(space, dims.data(), nullptr));
  return dims;
}

std::size_t claimed(hid_t dataset, const std::vector<hsize_t>& block, std::size_t size) {
  std::size_t values = 1, bytes = 0;
  bool fits = true;
  for (const hsize_t n : block)
    fits = !__builtin_mul_overflow(values, static_cast<std::size_t>(n), &values) && fits;
  fits = !__builtin_mul_overflow(values, size, &bytes) && fits;
  hsize_t file = 0;
  check(H5Fget_filesize(File(H5Iget_file_id(dataset)), &file));
  // Integers are stored in 4 bytes and read as 8 at most.
  constexpr hsize_t most = 2 * 1032;
  if (!fits || bytes / most > file)
    throw Failure("dataset " + name_of(dataset) +
                  " claims more rows than the file can hold; it is damaged");
  return values;
}

void read_block(hid_t dataset, hsize_t first, const std::vector<hsize_t>& block, hid_t type,
                void* values) {
  const Space file(H5Dget_space(dataset));
  const Space memory(H5Screate_simple(int(block.size()), block.data(), nullptr));
  std::vector<hsize_t> start(block.size());
  if (!block.empty()) {
    start[0] = first;
    check(H5Sselect_hyperslab(file, H5S_SELECT_SET, start.data(), nullptr, block.data(), nullptr));
  }
  check(H5Dread(dataset, type, memory, file, H5P_DEFAULT, values));
}

std::vector<std::string> children(hid_t group, H5O_type_t kind) {
  std::vector<std::string> all;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &all));
  std::vector<std::string> wanted;
  for (auto& name : all) {
    stay_inside(group, name);
    const Object o(H5Oopen(group, name.c_str(), H5P_DEFAULT));
    const H5I_type_t type = H5Iget_type(o);
    if ((kind == H5O_TYPE_GROUP && type == H5I_GROUP) ||
        (kind == H5O_TYPE_DATASET && type == H5I_DATASET))
      wanted.push_back(std::move(name));
  }
  return wanted;
}

std::vector<std::string> datasets_below(hid_t group, int groups) {
  std::vector<std::string> all = children(group, H5O_TYPE_DATASET);
  if (groups == 0) return all;
  for (const std::string& name : children(group, H5O_TYPE_GROUP))
    for (const std::string& below : datasets_below(open_group(group, name.c_str()), groups - 1))
      all.push_back(name + "/" + below);
  return all;
}

}  // namespace pbf::io_module::h5
