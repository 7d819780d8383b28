// Obstacles: lit with one color.

in vec3 f_normal;
uniform vec4 u_color;
out vec4 o_color;
void main() {
  vec4 seen = lit(u_color.rgb, normalize(f_normal));
  o_color = vec4(seen.rgb, kept_share(seen.a));
}
