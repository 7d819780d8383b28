// For a fragment shader that receives shadows.

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
