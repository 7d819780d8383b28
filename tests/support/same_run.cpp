#include "tests/support/same_run.h"

#include <map>
#include <vector>

#include "lib/io/h5.h"

namespace pbf::test {
namespace {

struct Content {
  std::vector<hsize_t> shape;
  std::vector<char> bytes;
  bool operator==(const Content&) const = default;
};
using Contents = std::map<std::string, Content>;

herr_t take(hid_t root, const char* name, const H5L_info_t*, void* out) {
  const std::string path = name;
  if (path.rfind("pbf/log/stage", 0) == 0 || path.rfind("pbf/sessions", 0) == 0) return 0;
  const h5::Object object(H5Oopen(root, name, H5P_DEFAULT));
  if (H5Iget_type(object) != H5I_DATASET) return 0;
  Content c;
  c.shape = h5::shape(object);
  std::size_t size = 1;
  for (const hsize_t n : c.shape) size *= n;
  const h5::Type type(H5Dget_type(object));
  c.bytes.resize(size * H5Tget_size(type));
  if (!c.bytes.empty())
    h5::check(H5Dread(object, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, c.bytes.data()));
  (*static_cast<Contents*>(out))[path] = c;
  return 0;
}

Contents read(const std::filesystem::path& path) {
  const h5::Lock lock;
  const h5::File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, h5::file_access()));
  Contents all;
  h5::check(H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, take, &all));
  return all;
}

}  // namespace

std::string run_difference(const std::filesystem::path& a, const std::filesystem::path& b) {
  const Contents left = read(a), right = read(b);
  for (const auto& [name, content] : left) {
    const auto other = right.find(name);
    if (other == right.end()) return name + " is missing in " + b.string();
    if (content.shape != other->second.shape) return name + " has another shape";
    if (!(content == other->second)) return name + " has other bytes";
  }
  for (const auto& [name, content] : right)
    if (!left.count(name)) return name + " is missing in " + a.string();
  return {};
}

}  // namespace pbf::test
