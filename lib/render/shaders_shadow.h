// Shadows: what the sun sees, and how it is read.
#pragma once

namespace pbf::inline render_module::shaders {

// The far side of what stands in the sun's way is kept: a lit surface is nearer than that by the
// thickness of its body, and casts no shadow on itself.
inline constexpr const char* kShadowSphereVertex = R"(
layout(location = 0) in vec3 a_center;
uniform vec4 u_map_x, u_map_y, u_map_z;  // from view space to the map, 0 to 1
uniform vec4 u_ball;                     // radius of a particle there
out vec2 f_place;
flat out float f_depth;
void main() {
  vec4 center = vec4(a_center, 1.0);
  f_place = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
  f_depth = dot(u_map_z, center);
  vec2 at = vec2(dot(u_map_x, center), dot(u_map_y, center)) + f_place * u_ball.xy;
  gl_Position = vec4(2.0 * vec3(at, f_depth) - 1.0, 1.0);
}
)";
inline constexpr const char* kShadowSphereFragment = R"(
in vec2 f_place;
flat in float f_depth;
uniform vec4 u_ball;
void main() {
  float h2 = 1.0 - dot(f_place, f_place);
  if (h2 <= 0.0) discard;
  gl_FragDepth = f_depth + sqrt(h2) * u_ball.z;
}
)";
inline constexpr const char* kShadowSolidVertex = R"(
layout(location = 0) in vec3 a_place;
uniform vec4 u_map_x, u_map_y, u_map_z;
void main() {
  vec4 place = vec4(a_place, 1.0);
  vec3 at = vec3(dot(u_map_x, place), dot(u_map_y, place), dot(u_map_z, place));
  gl_Position = vec4(2.0 * at - 1.0, 1.0);
}
)";
inline constexpr const char* kShadowSolidFragment = R"(
void main() {}
)";

/// For a fragment shader that receives shadows.
inline constexpr const char* kShadowed = R"(
uniform sampler2DShadow u_shadow;
uniform vec4 u_map_x, u_map_y, u_map_z;
uniform vec4 u_soft;  // half width of a penumbra along the map's axes, w: 0 without shadows
// Share of the sun that does not come to `place` (view space). A round or rough surface leaves
// `slack`: so much of half a penumbra may stand before it and is its own.
float shadowed(vec3 place, float slack) {
  vec4 p = vec4(place, 1.0);
  vec3 at = vec3(dot(u_map_x, p), dot(u_map_y, p), dot(u_map_z, p) - slack * u_soft.z);
  if (u_soft.w == 0.0 || any(greaterThan(abs(at.xy - 0.5), vec2(0.5)))) return 0.0;
  float open = 0.0;
  for (int k = 0; k < 4; ++k) {
    float angle = 1.5708 * float(k) + 0.4;
    open += texture(u_shadow, vec3(at.xy + u_soft.xy * vec2(cos(angle), sin(angle)), at.z));
  }
  if (open == 0.0 || open == 4.0) return 1.0 - 0.25 * open;
  for (int k = 0; k < 8; ++k) {
    float angle = 2.39996 * float(k), far = 0.85 * sqrt((float(k) + 0.5) / 8.0);
    open += texture(u_shadow, vec3(at.xy + far * u_soft.xy * vec2(cos(angle), sin(angle)), at.z));
  }
  return 1.0 - open / 12.0;
}
)";

}  // namespace pbf::inline render_module::shaders
