#include "lib/render/colormap.h"

#include <algorithm>
#include <cmath>

namespace pbf::render_module {
namespace {

// Viridis (S. van der Walt, N. Smith, E. Firing, 2015; public domain, CC0) at 33 even places:
// linear in between stays within 2 of 255 of the 256 published colours.
constexpr std::array<Rgb, 33> kViridis{
    {{68, 1, 84},    {71, 13, 96},   {72, 24, 106},  {72, 35, 116},  {71, 45, 123},  {69, 54, 129},
     {66, 64, 134},  {63, 73, 137},  {59, 82, 139},  {55, 90, 141},  {51, 99, 141},  {47, 106, 142},
     {44, 114, 142}, {41, 122, 142}, {38, 129, 142}, {35, 137, 142}, {33, 144, 140}, {31, 152, 139},
     {31, 159, 136}, {33, 166, 133}, {40, 174, 128}, {49, 181, 123}, {62, 188, 116}, {76, 194, 108},
     {93, 201, 99},  {110, 206, 88}, {130, 211, 76}, {150, 216, 63}, {171, 220, 50}, {192, 223, 36},
     {213, 226, 26}, {234, 229, 26}, {253, 231, 37}}};

constexpr std::array<Rgb, 5> kBlueToRed{
    {{30, 70, 160}, {110, 160, 215}, {240, 240, 238}, {225, 125, 95}, {165, 25, 35}}};

template <std::size_t n>
Rgb between(const std::array<Rgb, n>& map, double t) {
  if (std::isnan(t)) return kNoValue;
  const double place = std::clamp(t, 0.0, 1.0) * (n - 1);
  const auto i = std::min(static_cast<std::size_t>(place), n - 2);
  Rgb color;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = map[i][k], b = map[i + 1][k];
    color[k] =
        static_cast<std::uint8_t>(std::lround(a + (b - a) * (place - static_cast<double>(i))));
  }
  return color;
}

}  // namespace

Rgb viridis(double t) { return between(kViridis, t); }
Rgb blue_to_red(double t) { return between(kBlueToRed, t); }

}  // namespace pbf::render_module
