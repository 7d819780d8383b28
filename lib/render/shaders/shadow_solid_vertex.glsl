// What the sun sees of obstacles.

layout(location = 0) in vec3 a_place;
uniform vec4 u_map_x, u_map_y, u_map_z;
void main() {
  vec4 place = vec4(a_place, 1.0);
  vec3 at = vec3(dot(u_map_x, place), dot(u_map_y, place), dot(u_map_z, place));
  gl_Position = vec4(2.0 * at - 1.0, 1.0);
}
