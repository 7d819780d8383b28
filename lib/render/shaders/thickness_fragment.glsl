// Behind sphere_vertex.glsl and within.glsl, and added up. First what a ray passes through in the
// spheres before the scene, of which each counts with the fluid's volume of its particle, so that
// overlaps count once. Then how deep it goes into them, 1 through the middle of one, whatever clips
// or hides them: where the sum falls to a level is the outline of the fluid.

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
