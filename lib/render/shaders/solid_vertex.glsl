// Obstacles: triangles in view space with the normals of the smooth surface.

layout(location = 0) in vec3 a_place;
layout(location = 1) in vec3 a_normal;
out vec3 f_normal;
void main() {
  f_normal = a_normal;
  gl_Position = vec4(a_place.xy * u_lens.xy - u_lens.zw * a_place.z,
                     (2.0 * u_depth.x - 1.0) * a_place.z - 2.0 * u_depth.y, a_place.z);
}
