// Averages the samples of a pixel over the background, takes the sun away where there is shadow,
// and darkens what lies a little behind its surroundings, which shows the shape of a heap of equal
// spheres. Behind shadowed.glsl.

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
