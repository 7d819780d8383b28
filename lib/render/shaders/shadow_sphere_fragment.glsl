// The far side of a sphere.

in vec2 f_place;
flat in float f_depth;
uniform vec4 u_ball;
void main() {
  float h2 = 1.0 - dot(f_place, f_place);
  if (h2 <= 0.0) discard;
  gl_FragDepth = f_depth + sqrt(h2) * u_ball.z;
}
