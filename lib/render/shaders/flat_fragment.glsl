// Box lines and floor.

in vec3 f_color;
uniform float u_share;  // of the sun in the light, below 1
out vec4 o_color;
void main() {
  o_color = vec4(f_color, 0.5 * u_share);
}
