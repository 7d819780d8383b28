// The fluid as one surface: depth of the spheres, thickness, smoothing and water.
#pragma once

namespace pbf::inline render_module::shaders {

/// For the fragments of spheres that stay within the walls of the domain.
inline constexpr const char* kWithin = R"(
flat in vec3 f_center;
flat in float f_radius;
in vec2 f_ray;
uniform vec4 u_axis_x, u_axis_y, u_axis_z;  // of the domain in view space
uniform vec4 u_low, u_high;                 // walls along them, from the eye
// The depths at which the ray through this fragment enters and leaves the sphere within the walls;
// the second is the smaller one where it passes by.
vec2 within() {
  vec3 d = vec3(f_ray, 1.0);
  float dd = dot(d, d);
  vec3 p = (dot(d, f_center) / dd) * d - f_center;
  float h2 = f_radius * f_radius - dot(p, p);
  if (h2 <= 0.0) return vec2(1.0, 0.0);
  float middle = f_center.z + p.z, reach = sqrt(h2 / dd);
  vec3 speed = vec3(dot(u_axis_x.xyz, d), dot(u_axis_y.xyz, d), dot(u_axis_z.xyz, d));
  speed = mix(speed, vec3(1e-9), lessThan(abs(speed), vec3(1e-9)));
  vec3 a = u_low.xyz / speed, b = u_high.xyz / speed;
  vec3 first = min(a, b), last = max(a, b);
  return vec2(max(max(middle - reach, first.x), max(first.y, first.z)),
              min(min(middle + reach, last.x), min(last.y, last.z)));
}
)";

// Behind kSphereVertex and kWithin. Kept are 1/z, in which planes are linear over the picture, 0
// where there is no fluid, and the place on the colour bar, 0 to 254, -1 without a value.
inline constexpr const char* kSurfaceDepthFragment = R"(
flat in float f_share;
out vec2 o_surface;
void main() {
  vec2 ends = within();
  float z = ends.x;
  if (z <= 0.0 || ends.y <= z) discard;
  gl_FragDepth = u_depth.x - u_depth.y / z;
  o_surface = vec2(1.0 / z, f_share > 254.5 ? -1.0 : f_share);
}
)";

// Behind kSphereVertex and kWithin, added up. First what a ray passes through in the spheres before
// the scene, of which each counts with the fluid's volume of its particle, so that overlaps count
// once. Then how deep it goes into them, 1 through the middle of one, whatever clips or hides them:
// where the sum falls to a level is the outline of the fluid.
inline constexpr const char* kThicknessFragment = R"(
uniform sampler2D u_stored;
uniform int u_factor;
out vec2 o_thickness;
void main() {
  vec3 d = vec3(f_ray, 1.0), p = (dot(d, f_center) / dot(d, d)) * d - f_center;
  float inside = max(1.0 - dot(p, p) / (f_radius * f_radius), 0.0);
  vec2 ends = within();
  float scene = texelFetch(u_stored, ivec2(gl_FragCoord.xy) * u_factor + u_factor / 2, 0).r;
  bool hidden = scene < u_depth.x - u_depth.y / f_center.z;
  float chord = hidden || ends.x <= 0.0 ? 0.0 : max(ends.y - ends.x, 0.0);
  o_thickness = vec2(chord * length(d) * 0.466, inside);  // d^3 / (4/3 pi (0.8 d)^3)
}
)";

// Behind kResolveVertex: one direction of the smoothing. A pair of pixels at the same distance to
// both sides counts when its mean is near the pixel in the middle, which a plane's is however
// steeply it is seen, no pixel up to there lies off the fluid, and few lie behind an edge.
inline constexpr const char* kSmoothFragment = R"(
uniform sampler2D u_surface;
uniform vec2 u_along;  // (1, 0) or (0, 1)
uniform vec2 u_width;  // m: of the filter to each side, and how far off a pair may be
out vec2 o_surface;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(u_surface, 0) - 1;
  vec2 here = texelFetch(u_surface, at, 0).rg;
  o_surface = here;
  if (here.x <= 0.0) return;
  float z = 1.0 / here.x;
  float reach = max(u_width.x / (u_step * z), 1.0);  // pixels
  float joined = 1.0;  // falls with the way over edges: what lies behind them is another body
  vec2 sum = here, weight = vec2(1.0);
  int last_far = 0;
  for (int k = 0; k < 20; ++k) {
    // The same whole pixels for all, so that neighbours see the same; wider ones count more.
    int far = max(last_far + 1, int(1.22 * float(last_far) + 0.5)), gap = far - last_far;
    last_far = far;
    if (float(far) > reach) break;
    ivec2 off = ivec2(u_along) * far;
    vec2 a = texelFetch(u_surface, clamp(at + off, ivec2(0), last), 0).rg;
    vec2 b = texelFetch(u_surface, clamp(at - off, ivec2(0), last), 0).rg;
    if (a.x <= 0.0 || b.x <= 0.0) break;
    float away = (0.5 * (a.x + b.x) - here.x) * z * z / u_width.y;
    float rise = abs(a.x - b.x) * z / (float(far) * u_step);
    float outline = smoothstep(6.0, 12.0, rise);  // not a slope
    joined -= 1.3 * outline * float(gap) * u_step * z / u_width.y;
    if (joined <= 0.0) break;
    float share = float(far) / reach;
    float w = 2.0 * float(gap) * exp(-2.7 * share * share - away * away);
    w *= joined * (1.0 - outline);
    sum.x += w * 0.5 * (a.x + b.x);
    weight.x += w;
    if (a.y >= 0.0 && b.y >= 0.0) {
      sum.y += w * 0.5 * (a.y + b.y);
      weight.y += w;
    }
  }
  o_surface = vec2(sum.x / weight.x, here.y < 0.0 ? here.y : sum.y / weight.y);
}
)";

// Behind kResolveVertex and kShadowed: the fluid before the scene. Its colour is that of the
// colour bar, lit as spheres are; where it is thin the scene shines through, refracted; the sky is
// reflected at grazing angles (Schlick) and the sun where it glances.
inline constexpr const char* kWaterFragment = R"(
uniform sampler2D u_surface, u_thickness, u_scene, u_stored, u_bar;
uniform int u_factor;
uniform vec2 u_size;
uniform float u_radius;  // m, of the spheres
uniform vec2 u_clear;    // m of fluid after which the scene is left by 1/e of so much; 0: opaque
out vec4 o_color;
vec3 place(ivec2 at, float inverse) {
  return vec3((2.0 * (vec2(at) + 0.5) / u_size - 1.0 + u_lens.zw) / u_lens.xy, 1.0) / inverse;
}
float inverse_at(ivec2 at) {
  return texelFetch(u_surface, clamp(at, ivec2(0), ivec2(u_size) - 1), 0).r;
}
// Along the surface in one direction of the picture, to the side that is nearer in depth.
vec3 slope(ivec2 at, ivec2 off, float here) {
  float a = inverse_at(at + off), b = inverse_at(at - off);
  if (a <= 0.0 && b <= 0.0) return place(at + off, here) - place(at, here);
  float rise = abs(a - here), fall = abs(b - here);
  if (a > 0.0 && b > 0.0 && max(rise, fall) < 2.0 * min(rise, fall) + 0.1 * u_step * here)
    return 0.5 * (place(at + off, a) - place(at - off, b));
  bool forth = b <= 0.0 || (a > 0.0 && rise < fall);
  return forth ? place(at + off, a) - place(at, here) : place(at, here) - place(at - off, b);
}
// Share of the pixel within the outline, which is where half of what lies around is in spheres: it
// goes along a row of them, and a lone one keeps most of its size.
float inside(ivec2 at, float inverse) {
  float reach = max(u_radius * inverse / u_step, 1.0), sum = 0.0, squares = 0.0;  // pixels
  vec2 rise = vec2(0.0);
  for (int k = 0; k < 32; ++k) {
    float angle = 2.39996 * float(k), far = reach * sqrt((float(k) + 0.5) / 32.0);
    ivec2 off = ivec2(round(far * vec2(cos(angle), sin(angle))));
    float f = texelFetch(u_thickness, clamp(at + off, ivec2(0), ivec2(u_size) - 1), 0).g;
    f = min(2.0 * f, 1.0);
    sum += f;
    rise += f * vec2(off);
    squares += 0.5 * float(off.x * off.x + off.y * off.y);
  }
  float slope = length(rise) / squares;  // per pixel
  return clamp(0.5 + (sum / 32.0 - 0.46) / max(slope, 1e-3), 0.0, 1.0);
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec3 scene = texelFetch(u_scene, at, 0).rgb;
  o_color = vec4(scene, 1.0);
  vec2 here = texelFetch(u_surface, at, 0).rg;
  if (here.x <= 0.0) return;
  // The spheres reach beyond the fluid, 0.375 of their radius: what touches it wins.
  float stored = u_depth.x - u_depth.y / (1.0 / here.x + 0.375 * u_radius), covered = 0.0;
  for (int j = 0; j < u_factor; ++j)
    for (int i = 0; i < u_factor; ++i)
      covered += step(stored, texelFetch(u_stored, at * u_factor + ivec2(i, j), 0).r);
  if (covered == 0.0) return;
  vec3 p = place(at, here.x), eye = -normalize(p);
  vec3 n = normalize(cross(slope(at, ivec2(1, 0), here.x), slope(at, ivec2(0, 1), here.x)));
  if (dot(n, p) > 0.0) n = -n;

  covered *= inside(at, here.x);

  float thick = texelFetch(u_thickness, at, 0).r, left = u_clear.y * exp(-thick / u_clear.x);
  int low = clamp(int(here.y), 0, 253);
  vec3 color = here.y < 0.0 ? texelFetch(u_bar, ivec2(255, 0), 0).rgb
                            : mix(texelFetch(u_bar, ivec2(low, 0), 0).rgb,
                                  texelFetch(u_bar, ivec2(low + 1, 0), 0).rgb, here.y - float(low));
  o_color.rgb = mix(scene, color, covered / float(u_factor * u_factor));
  if (u_clear.y == 0.0) return;  // a plane: the colours of the bar, unlit
  float hidden = shadowed(p, 1.0);
  vec4 body = lit(color, n);
  body.rgb *= 1.0 - body.a * hidden;
  vec2 bend = n.xy * min(thick, 4.0 * u_radius) * here.x / u_step * 0.25;
  vec3 behind = texelFetch(u_scene, clamp(at - ivec2(bend), ivec2(0), ivec2(u_size) - 1), 0).rgb;
  vec3 seen = mix(body.rgb, behind * mix(vec3(1.0), color, 0.6 * (1.0 - left)), left);

  float facing = max(dot(n, eye), 0.0);
  float mirror = min(0.02 + 0.98 * pow(1.0 - facing, 5.0), 0.45) * (1.0 - left);
  float up = dot(reflect(-eye, n), u_sky.xyz);
  seen = mix(seen, mix(vec3(0.50, 0.53, 0.56), vec3(0.96, 0.98, 1.0), smoothstep(-0.4, 0.5, up)),
             mirror);
  float glance = max(dot(n, normalize(u_sun.xyz + eye)), 0.0);
  seen += 0.35 * pow(glance, 90.0) * (1.0 - hidden) * (1.0 - left);
  o_color.rgb = mix(scene, seen, covered / float(u_factor * u_factor));
}
)";

}  // namespace pbf::inline render_module::shaders
