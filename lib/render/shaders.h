// The GLSL programs of spheres, obstacles, box and background. View space as in camera.h: x right,
// y up, z = depth, in m.
#pragma once

namespace pbf::inline render_module::shaders {

/// In front of every shader.
inline constexpr const char* kHead = R"(#version 330 core
uniform vec4 u_lens;   // clip = tangent * u_lens.xy - u_lens.zw
uniform float u_step;  // tangent per sample
uniform vec2 u_depth;  // stored depth = u_depth.x - u_depth.y / z
uniform vec4 u_sky, u_sun;  // towards them, view space
// A matt surface between sky and ground, in the sun; a: the sun's share, which a shadow takes away.
vec4 lit(vec3 color, vec3 normal) {
  float sky = mix(0.34, 0.70, 0.5 + 0.5 * dot(normal, u_sky.xyz));
  float sun = 0.50 * max(dot(normal, u_sun.xyz), 0.0);
  return vec4(color * (sky + sun), sun / (sky + sun));
}
// How samples keep that share: below a half, of a surface that casts no shadow (floor, lines).
float kept_share(float share) { return 0.5 + 0.5 * share; }
)";

// One quad per particle, just large enough for the perspective outline of the sphere.
inline constexpr const char* kSphereVertex = R"(
layout(location = 0) in vec3 a_center;
layout(location = 1) in vec4 a_color;
uniform float u_radius;
flat out vec3 f_center;
flat out vec3 f_color;
flat out float f_share;
flat out float f_radius;
out vec2 f_ray;
// The two tangents (x/z) of the lines from the eye that touch a circle: centre (x, z), radius r.
vec2 touching(float x, float z, float r) {
  float w = z * z - r * r;
  float s = r * sqrt(max(x * x + w, 0.0));
  return vec2(x * z - s, x * z + s) / w;
}
void main() {
  f_center = a_center;
  f_color = a_color.rgb;
  f_share = round(255.0 * a_color.a);
  f_radius = max(u_radius, 0.7 * u_step * a_center.z);  // never below a sample: no holes far away
  vec2 pick = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  vec2 clip = 2.0 * pick - 1.0;  // a sphere beside the eye may cover everything
  if (a_center.z > 1.01 * f_radius) {
    vec2 tx = touching(a_center.x, a_center.z, f_radius);
    vec2 ty = touching(a_center.y, a_center.z, f_radius);
    clip = mix(vec2(tx.x, ty.x), vec2(tx.y, ty.y), pick) * u_lens.xy - u_lens.zw;
  }
  f_ray = (clip + u_lens.zw) / u_lens.xy;
  gl_Position = vec4(clip, 0.0, 1.0);
}
)";

// Ray and sphere: exact outline, normal and depth. p, the ray's nearest point seen from the
// centre, keeps the digits that |c|^2 - r^2 would lose for small spheres far away.
inline constexpr const char* kSphereFragment = R"(
flat in vec3 f_center;
flat in vec3 f_color;
flat in float f_radius;
in vec2 f_ray;
out vec4 o_color;
void main() {
  vec3 d = vec3(f_ray, 1.0);
  float dd = dot(d, d);
  vec3 p = (dot(d, f_center) / dd) * d - f_center;
  float h2 = f_radius * f_radius - dot(p, p);
  if (h2 <= 0.0) discard;
  d *= inversesqrt(dd);
  vec3 n = (p - sqrt(h2) * d) / f_radius;
  float z = f_center.z + n.z * f_radius;
  if (z <= 0.0) discard;
  gl_FragDepth = u_depth.x - u_depth.y / z;
  float shine = max(dot(n, normalize(u_sun.xyz - d)), 0.0);
  shine *= shine; shine *= shine; shine *= shine; shine *= shine; shine *= shine;
  vec4 seen = lit(f_color, n);
  o_color = vec4(seen.rgb + 0.16 * shine, kept_share(seen.a));
}
)";

// Obstacles: triangles in view space with the normals of the smooth surface.
inline constexpr const char* kSolidVertex = R"(
layout(location = 0) in vec3 a_place;
layout(location = 1) in vec3 a_normal;
out vec3 f_normal;
void main() {
  f_normal = a_normal;
  gl_Position = vec4(a_place.xy * u_lens.xy - u_lens.zw * a_place.z,
                     (2.0 * u_depth.x - 1.0) * a_place.z - 2.0 * u_depth.y, a_place.z);
}
)";
inline constexpr const char* kSolidFragment = R"(
in vec3 f_normal;
uniform vec4 u_color;
out vec4 o_color;
void main() {
  vec4 seen = lit(u_color.rgb, normalize(f_normal));
  o_color = vec4(seen.rgb, kept_share(seen.a));
}
)";

// Box lines and floor: triangles in view space.
inline constexpr const char* kFlatVertex = R"(
layout(location = 0) in vec3 a_place;
layout(location = 1) in vec3 a_color;
out vec3 f_color;
void main() {
  f_color = a_color;
  gl_Position = vec4(a_place.xy * u_lens.xy - u_lens.zw * a_place.z,
                     (2.0 * u_depth.x - 1.0) * a_place.z - 2.0 * u_depth.y, a_place.z);
}
)";
inline constexpr const char* kFlatFragment = R"(
in vec3 f_color;
uniform float u_share;  // of the sun in the light, below 1
out vec4 o_color;
void main() {
  o_color = vec4(f_color, 0.5 * u_share);
}
)";

// Averages the samples of a pixel over the background, takes the sun away where there is shadow,
// and darkens what lies a little behind its surroundings, which shows the shape of a heap of equal
// spheres. Behind kShadowed.
inline constexpr const char* kResolveVertex = R"(
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";
inline constexpr const char* kResolveFragment = R"(
uniform sampler2D u_color;
uniform sampler2D u_stored;
uniform int u_factor;    // samples per pixel and direction
uniform vec2 u_size;     // of the picture, pixels
uniform float u_radius;  // of a particle
out vec4 o_color;
float z_at(ivec2 s) {
  s = clamp(s, ivec2(0), ivec2(u_size) * u_factor - 1);
  return u_depth.y / (u_depth.x - texelFetch(u_stored, s, 0).r);
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) * u_factor;
  vec3 back = mix(vec3(0.90, 0.92, 0.94), vec3(0.975, 0.98, 0.985), gl_FragCoord.y / u_size.y);
  vec3 sum = vec3(0.0), sunlit = vec3(0.0);
  float nearest = 1.0, kept = 0.0;
  int covered = 0;
  for (int j = 0; j < u_factor; ++j)
    for (int i = 0; i < u_factor; ++i) {
      float stored = texelFetch(u_stored, at + ivec2(i, j), 0).r;
      if (stored < 1.0) {
        vec4 c = texelFetch(u_color, at + ivec2(i, j), 0);
        sum += c.rgb;
        sunlit += c.rgb * (c.a < 0.5 ? 2.0 * c.a : 2.0 * c.a - 1.0);
        if (stored < nearest) { nearest = stored; kept = c.a; }
        ++covered;
      }
    }
  int all = u_factor * u_factor;
  float open = 1.0;
  if (covered > 0) {
    float z = z_at(at + u_factor / 2);
    float reach = clamp(3.0 * u_radius / (u_step * z), 2.0 * float(u_factor),
                        12.0 * float(u_factor));  // in samples
    float scale = 1.0 / max(u_radius, 0.7 * u_step * z), hidden = 0.0;
    // Each sample shows the outline of a sphere before a smooth surface: many, and the far ones
    // weak, so that none is seen. The weights add up to 1.
    for (int k = 0; k < 48; ++k) {
      float angle = 2.39996 * float(k), share = (float(k) + 0.5) / 48.0;
      float far = reach * sqrt(share), weight = (1.5 - 1.0 * share) / 48.0;
      float behind = (z - z_at(at + ivec2(far * cos(angle), far * sin(angle)))) * scale;
      hidden += weight * smoothstep(0.6, 4.0, behind) * (1.0 - smoothstep(12.0, 40.0, behind));
    }
    open = 1.0 - 0.65 * hidden;
    if (kept > 0.51 || (kept > 0.0 && kept < 0.5)) {
      vec2 ray = (2.0 * gl_FragCoord.xy / u_size - 1.0 + u_lens.zw) / u_lens.xy;
      float sun_z = u_depth.y / (u_depth.x - nearest);
      sum -= sunlit * shadowed(vec3(ray, 1.0) * sun_z, step(0.5, kept));
    }
  }
  o_color = vec4((sum * open + float(all - covered) * back) / float(all), 1.0);
}
)";

}  // namespace pbf::inline render_module::shaders
