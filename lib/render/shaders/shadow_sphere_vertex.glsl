// What the sun sees of particles. The far side of what stands in the sun's way is kept: a lit
// surface is nearer than that by the thickness of its body, and casts no shadow on itself.

layout(location = 0) in vec3 a_center;
uniform vec4 u_map_x, u_map_y, u_map_z;  // from view space to the map, 0 to 1
uniform vec4 u_ball;                     // radius of a particle there
out vec2 f_place;
flat out float f_depth;
void main() {
  vec4 center = vec4(a_center, 1.0);
  f_place = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
  f_depth = dot(u_map_z, center);
  vec2 at = vec2(dot(u_map_x, center), dot(u_map_y, center)) + f_place * u_ball.xy;
  gl_Position = vec4(2.0 * vec3(at, f_depth) - 1.0, 1.0);
}
