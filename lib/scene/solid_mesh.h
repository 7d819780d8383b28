// The surface of an obstacle that comes from a file.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <typeindex>
#include <vector>

#include "lib/scene/triangle_mesh.h"

namespace pbf::scene_module {

/// Not a key of a scene: lib/run/surface_files.h reads it. Copies of a scene share it.
class SolidMesh {
 public:
  /// mesh: closed, with at least one vertex.
  SolidMesh(std::string file, std::string sha256, TriangleMesh mesh)
      : file_(std::move(file)), sha256_(std::move(sha256)), mesh_(std::move(mesh)) {
    const auto [low, high] = box_of(mesh_);
    middle_ = 0.5 * (low + high);
  }
  const std::string& file() const { return file_; }  ///< where it was read
  const std::string& sha256() const { return sha256_; }
  const TriangleMesh& mesh() const { return mesh_; }  ///< in units of the file
  const Double3& middle() const { return middle_; }   ///< of the box about it

  /// What follows from the mesh and these numbers: made once, and kept as long as the mesh, because
  /// solids refer to it.
  template <class T, class Make>
  const T& derived(const std::vector<double>& numbers, const Make& make) const {
    const std::lock_guard lock(mutex_);
    for (const Kept& k : kept_)
      if (k.type == typeid(T) && k.numbers == numbers) return *static_cast<const T*>(k.value.get());
    auto value = std::make_shared<const T>(make());
    kept_.push_back({typeid(T), numbers, value});
    return *value;
  }

 private:
  struct Kept {
    std::type_index type;
    std::vector<double> numbers;
    std::shared_ptr<const void> value;
  };
  std::string file_, sha256_;
  TriangleMesh mesh_;
  Double3 middle_{};
  mutable std::mutex mutex_;
  mutable std::vector<Kept> kept_;
};

}  // namespace pbf::scene_module
