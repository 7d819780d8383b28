#include "lib/render/particles.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "lib/base/error.h"
#include "lib/scene/vector3.h"

namespace pbf::render_module {
namespace {

Double3 vector(const FieldArray& field, std::size_t i) {
  return {field.number(3 * i), field.number(3 * i + 1), field.number(3 * i + 2)};
}

std::uint8_t share_of(double place) {
  if (std::isnan(place)) return kNoShare;
  return static_cast<std::uint8_t>(std::lround((kNoShare - 1) * std::clamp(place, 0.0, 1.0)));
}

void check_field(const Snapshot& snapshot, const std::string& name, int components,
                 const std::string& what) {
  const FieldArray* field = snapshot.find(name);
  if (!field) {
    std::string has;
    for (const auto& f : snapshot.fields) has += (has.empty() ? "" : ", ") + f.name;
    throw Error(ExitCode::bad_input,
                fmt::format("{} needs the field {}, but the snapshot has only: {}; add {} to "
                            "output.fields or choose another render.color",
                            what, name, has.empty() ? "nothing" : has, name));
  }
  if (field->components != components ||
      field->bytes.size() !=
          snapshot.count * static_cast<std::size_t>(components) * size_of(field->type))
    throw Error(
        ExitCode::bad_input,
        fmt::format("the field {} has {} components and {} bytes; {} particles with {} "
                    "components were expected",
                    name, field->components, field->bytes.size(), snapshot.count, components));
}

}  // namespace

double drawn_radius(const View& view) {
  return (view.style == RenderStyle::surface ? 1.6 : 1) * view.radius;
}

void check_fields(const Snapshot& snapshot, ColorBy color) {
  check_field(snapshot, "position", 3, "a picture");
  const ColoringInfo& source = about(color);
  check_field(snapshot, source.field, source.components,
              std::string("a picture coloured by ") + source.word);
}

double shown_value(const FieldArray& field, const View& view, std::size_t i) {
  if (about(view.color).components == 3) return length(vector(field, i));
  const double stored = field.number(i);
  if (view.color != ColorBy::compression) return stored;
  return std::max(stored / view.rest_density - 1, 0.0);
}

void collect(const Snapshot& snapshot, const View& view, const Projection& projection,
             ParticleVertices& out) {
  check_fields(snapshot, view.color);
  const FieldArray& position = *snapshot.find("position");
  const FieldArray& field = *snapshot.find(about(view.color).field);
  out = {std::move(out.list)};
  out.list.clear();
  out.list.reserve(snapshot.count);

  const auto color = color_map(view.color);
  const double r = drawn_radius(view), low = view.range[0], span = view.range[1] - view.range[0];
  const double tan_y = projection.tan_half;
  const double tan_x = tan_y * projection.size[0] / projection.size[1];
  // Planes through the eye: left and right, bottom and top of the (shifted) picture.
  const auto [shift_x, shift_y] = projection.shift;
  const double left = -tan_x * (1 - shift_x), right = tan_x * (1 + shift_x);
  const double bottom = -tan_y * (1 - shift_y), top = tan_y * (1 + shift_y);
  const double reach_left = r * std::hypot(1, left), reach_right = r * std::hypot(1, right);
  const double reach_bottom = r * std::hypot(1, bottom), reach_top = r * std::hypot(1, top);
  const auto at = [&](std::size_t i) { return projection.to_view(vector(position, i)); };
  // Written so that NaN fails; a sphere around the eye would hide everything and is left out.
  const auto is_seen = [&](const Double3& v) {
    return v[2] > -r && dot(v, v) > r * r && v[0] > left * v[2] - reach_left &&
           v[0] < right * v[2] + reach_right && v[1] > bottom * v[2] - reach_bottom &&
           v[1] < top * v[2] + reach_top && v[2] < 1e30;
  };
  for (std::size_t i = 0; i < snapshot.count; ++i) {
    const Double3 v = at(i);
    if (!is_seen(v)) continue;
    const double shown = shown_value(field, view, i);
    const double place = (shown - low) / span;
    out.list.push_back({floats(v), color(place), share_of(place)});
    out.nearest = std::min(out.nearest, v[2] - r);
    out.farthest = std::max(out.farthest, v[2] + r);
  }
  out.visible = out.list.size();
  if (view.flat || out.visible == snapshot.count) return;
  for (std::size_t i = 0; i < snapshot.count; ++i) {
    const Double3 v = at(i);
    if (is_seen(v) || !(dot(v, v) < 1e30)) continue;
    out.list.push_back({floats(v), Rgb{}, kNoShare});
  }
}

}  // namespace pbf::render_module
