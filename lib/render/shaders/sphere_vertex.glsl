// One quad per particle, just large enough for the perspective outline of the sphere.

layout(location = 0) in vec3 a_center;
layout(location = 1) in vec4 a_color;
uniform float u_radius;
flat out vec3 f_center;
flat out vec3 f_color;
flat out float f_share;
flat out float f_radius;
out vec2 f_ray;
// The two tangents (x/z) of the lines from the eye that touch a circle: centre (x, z), radius r.
vec2 touching(float x, float z, float r) {
  float w = z * z - r * r;
  float s = r * sqrt(max(x * x + w, 0.0));
  return vec2(x * z - s, x * z + s) / w;
}
void main() {
  f_center = a_center;
  f_color = a_color.rgb;
  f_share = round(255.0 * a_color.a);
  f_radius = max(u_radius, 0.7 * u_step * a_center.z);  // never below a sample: no holes far away
  vec2 pick = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  vec2 clip = 2.0 * pick - 1.0;  // a sphere beside the eye may cover everything
  if (a_center.z > 1.01 * f_radius) {
    vec2 tx = touching(a_center.x, a_center.z, f_radius);
    vec2 ty = touching(a_center.y, a_center.z, f_radius);
    clip = mix(vec2(tx.x, ty.x), vec2(tx.y, ty.y), pick) * u_lens.xy - u_lens.zw;
  }
  f_ray = (clip + u_lens.zw) / u_lens.xy;
  gl_Position = vec4(clip, 0.0, 1.0);
}
