#include "lib/io/mesh_file.h"

#include <fmt/core.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/machine.h"
#include "lib/base/regular_file.h"
#include "lib/base/sha256.h"
#include "lib/base/text.h"

namespace pbf::io_module {
namespace {

constexpr std::size_t kHead = 84, kRecord = 50;  // bytes of a binary STL, and of each triangle
constexpr const char* kExpectedMesh = "expected STL (binary or ASCII) or OBJ";

struct SamePlace {
  std::size_t operator()(const Double3& x) const {
    std::size_t hash = 0;
    for (const double c : x) hash = hash * 1000003 ^ std::hash<double>()(c);
    return hash;
  }
};

/// Makes a mesh of corners: equal ones become one vertex.
class Welder {
 public:
  std::int32_t vertex(Double3 x, const std::string& where) {
    for (double& c : x) {
      if (!std::isfinite(c)) bad_input(where, "a coordinate is not finite");
      c += 0.0;  // -0 is 0
    }
    const auto [at, fresh] = number_.try_emplace(x, std::int32_t(mesh_.vertex.size()));
    if (fresh) mesh_.vertex.push_back(x);
    if (mesh_.vertex.size() > 2147483647u) bad_input(where, "more than 2147483647 vertices");
    return at->second;
  }
  void triangle(std::int32_t a, std::int32_t b, std::int32_t c) {
    if (a != b && b != c && c != a) mesh_.triangle.push_back({a, b, c});
  }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  TriangleMesh mesh_;
  std::unordered_map<Double3, std::int32_t, SamePlace> number_;
};

/// The words of a text, line by line.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name) : text_(text), name_(name) {}
  /// The words of the next line that has any; false at the end.
  bool next(std::vector<std::string_view>& words) {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      std::string_view line = text_.substr(at_, end - at_);
      at_ = end + 1;
      ++number_;
      words.clear();
      for (std::size_t k = 0;;) {
        k = line.find_first_not_of(" \t\r\f\v", k);
        if (k == std::string_view::npos) break;
        const std::size_t stop = std::min(line.find_first_of(" \t\r\f\v", k), line.size());
        words.push_back(line.substr(k, stop - k));
        k = stop;
      }
      if (!words.empty()) return true;
    }
    return false;
  }
  std::string where() const { return name_ + ":" + std::to_string(number_); }
  [[noreturn]] void refuse(const std::string& why) const { bad_input(where(), why); }
  double number(std::string_view word) const {
    double value = 0;
    std::string_view digits = word;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    const auto [stop, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (ec == std::errc::result_out_of_range) refuse(shown(word) + " does not fit a double");
    if (ec != std::errc{} || stop != digits.data() + digits.size())
      refuse(shown(word) + " is not a number");
    return value;
  }
  /// A word of the file in a message: not what is no text, or long.
  static std::string shown(std::string_view word) {
    const bool text = std::ranges::all_of(word, [](char c) { return c > ' ' && c <= '~'; });
    return text ? "\"" + std::string(word.substr(0, 40)) + "\"" : "what stands there";
  }

 private:
  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  std::int64_t number_ = 0;
};

TriangleMesh read_binary_stl(const std::string& bytes, const std::string& name) {
  Welder weld;
  for (std::size_t t = 0; kHead + (t + 1) * kRecord <= bytes.size(); ++t) {
    std::array<float, 12> value;  // a normal, three corners
    std::memcpy(value.data(), bytes.data() + kHead + t * kRecord, sizeof value);
    std::array<std::int32_t, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k)
      corner[k] = weld.vertex({value[3 * k + 3], value[3 * k + 4], value[3 * k + 5]},
                              name + ": triangle " + std::to_string(t));
    weld.triangle(corner[0], corner[1], corner[2]);
  }
  return weld.take();
}

TriangleMesh read_ascii_stl(const std::string& text, const std::string& name) {
  Welder weld;
  Lines lines(text, name);
  std::vector<std::string_view> words;
  const auto is = [&](std::initializer_list<std::string_view> begin, std::size_t all) {
    return words.size() == all && std::equal(begin.begin(), begin.end(), words.begin());
  };
  // solid NAME { facet normal X Y Z, outer loop, 3 vertex X Y Z, endloop, endfacet } endsolid NAME
  const auto expect = [&](std::initializer_list<std::string_view> begin, std::size_t all,
                          const char* what) {
    if (!lines.next(words)) bad_input(name, fmt::format("ends where {} should stand", what));
    if (!is(begin, all)) lines.refuse(fmt::format("expected {}", what));
  };
  bool in_solid = false;
  while (lines.next(words)) {
    if (!in_solid) {
      if (words[0] != "solid") lines.refuse("expected solid");
      in_solid = true;
    } else if (words[0] == "endsolid") {
      in_solid = false;
    } else {
      if (!is({"facet", "normal"}, 5)) lines.refuse("expected facet normal X Y Z, or endsolid");
      expect({"outer", "loop"}, 2, "outer loop");
      std::array<std::int32_t, 3> corner{};
      for (std::int32_t& c : corner) {
        expect({"vertex"}, 4, "vertex X Y Z");
        const Double3 x{lines.number(words[1]), lines.number(words[2]), lines.number(words[3])};
        c = weld.vertex(x, lines.where());
      }
      expect({"endloop"}, 1, "endloop");
      expect({"endfacet"}, 1, "endfacet");
      weld.triangle(corner[0], corner[1], corner[2]);
    }
  }
  if (in_solid) bad_input(name, "ends before endsolid; the file is not whole");
  return weld.take();
}

/// "7", "7/1", "7//3", "7/1/3", or with negative numbers, which count back from the last vertex.
std::int32_t obj_corner(const Lines& lines, std::string_view word,
                        const std::vector<std::int32_t>& vertices) {
  const std::string_view digits = word.substr(0, word.find('/'));
  std::int64_t n = 0;
  const auto [stop, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
  if (ec != std::errc{} || stop != digits.data() + digits.size())
    lines.refuse(Lines::shown(word) + " is not the number of a vertex");
  const auto all = std::int64_t(vertices.size());
  if (n < 0) n += all + 1;
  if (n < 1 || n > all)
    lines.refuse(fmt::format("vertex {}: the file has {} up to here, the first is 1",
                             Lines::shown(digits), all));
  return vertices[std::size_t(n - 1)];
}

TriangleMesh read_obj(const std::string& text, const std::string& name) {
  Welder weld;
  Lines lines(text, name);
  std::vector<std::string_view> words;
  std::vector<std::int32_t> vertices;
  bool any = false;
  while (lines.next(words)) {
    if (words[0] == "v") {
      if (words.size() < 4) lines.refuse("a vertex needs x, y and z");
      const Double3 x{lines.number(words[1]), lines.number(words[2]), lines.number(words[3])};
      vertices.push_back(weld.vertex(x, lines.where()));
      any = true;
    } else if (words[0] == "f") {
      if (words.size() < 4) lines.refuse("a face needs at least three vertices");
      const std::int32_t first = obj_corner(lines, words[1], vertices);
      for (std::size_t k = 3; k < words.size(); ++k)
        weld.triangle(first, obj_corner(lines, words[k - 1], vertices),
                      obj_corner(lines, words[k], vertices));
    } else if (!any && words[0][0] != '#' && words[0] != "o" && words[0] != "g" &&
               words[0] != "mtllib" && words[0] != "usemtl" && words[0] != "s") {
      bad_input(name, std::string("is no mesh, ") + kExpectedMesh);
    }
  }
  if (!any) bad_input(name, std::string("is no mesh, ") + kExpectedMesh);
  return weld.take();
}

}  // namespace

TriangleMesh read_mesh(const std::string& bytes, const std::string& name) {
  if (bytes.empty()) bad_input(name, std::string("is empty, ") + kExpectedMesh);
  std::uint32_t triangles = 0;
  if (bytes.size() >= kHead) {
    std::memcpy(&triangles, bytes.data() + 80, sizeof triangles);
    if (bytes.size() == kHead + std::size_t(triangles) * kRecord)
      return read_binary_stl(bytes, name);  // also one whose header begins with "solid"
  }
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  const bool solid = begin != std::string::npos && bytes.compare(begin, 5, "solid") == 0;
  const bool text = bytes.find('\0') == std::string::npos;
  if (solid && text) return read_ascii_stl(bytes, name);
  if (!text && bytes.size() >= kHead)
    bad_input(name, fmt::format("is no mesh, {}; as binary STL it would say {} triangles, which "
                                "take {} bytes, and the file has {}",
                                kExpectedMesh, triangles, kHead + std::size_t(triangles) * kRecord,
                                bytes.size()));
  if (!text) bad_input(name, std::string("is no mesh, ") + kExpectedMesh);
  return read_obj(bytes, name);
}

TriangleMesh read_mesh_file(const std::string& path, std::string* sha256) {
  note_input(path);
  RegularFile file(path, "a mesh (STL or OBJ)",
                   "; paths of meshes are relative to the folder of the scene file");
  const std::size_t size = file.stamp().first, available = available_memory();
  if (available > 0 && 6 * size > available)  // the bytes, vertices, triangles and edges
    throw Error(ExitCode::unavailable, path + ": needs " + bytes_text(6 * double(size)) +
                                           " of memory, " + bytes_text(double(available)) +
                                           " are available");
  std::string bytes(size, '\0');
  std::size_t have = 0;
  for (std::size_t n = 1; n > 0; have += n) {
    if (have == bytes.size()) bytes.resize(bytes.size() + 4096);
    n = file.read(bytes.data() + have, bytes.size() - have);
  }
  bytes.resize(have);
  if (sha256) {
    Sha256 hash;
    hash.add(bytes);
    *sha256 = hash.text();
  }
  return read_mesh(bytes, path);
}

}  // namespace pbf::io_module
