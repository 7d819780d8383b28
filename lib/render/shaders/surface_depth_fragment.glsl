// Behind sphere_vertex.glsl and within.glsl. Kept are 1/z, in which planes are linear over the
// picture, 0 where there is no fluid, and the place on the colour bar, 0 to 254, -1 without a
// value.

flat in float f_share;
out vec2 o_surface;
void main() {
  vec2 ends = within();
  float z = ends.x;
  if (z <= 0.0 || ends.y <= z) discard;
  gl_FragDepth = u_depth.x - u_depth.y / z;
  o_surface = vec2(1.0 / z, f_share > 254.5 ? -1.0 : f_share);
}
