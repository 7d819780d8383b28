// Behind resolve_vertex.glsl and shadowed.glsl: the fluid before the scene. Its colour is that of
// the colour bar, lit as spheres are; where it is thin the scene shines through, refracted; the sky
// is reflected at grazing angles (Schlick) and the sun where it glances.

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
