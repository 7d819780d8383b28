// A bed of given heights, from a file. The kernels know it as a mesh.
#pragma once

#include "lib/scene/shapes/mesh.h"

namespace pbf::scene_module {
namespace obstacle_keys {

struct Heights : SurfaceFile {
  static constexpr const char* word = "heights";
  bool operator==(const Heights&) const = default;

  static auto keys() { return keys_of(kPathHelp); }
  Double3 middle() const { return surface ? surface->middle() + translate : translate; }
  Matrix3 axes() const { return kUnit3; }
  double meters() const { return 1; }
  Body make(double h) const { return bare(1, h); }
};

}  // namespace obstacle_keys
}  // namespace pbf::scene_module
