// In front of every shader. View space as in camera.h: x right, y up, z = depth, in m.
#version 330 core
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
