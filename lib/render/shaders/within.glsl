// For the fragments of spheres that stay within the walls of the domain.

flat in vec3 f_center;
flat in float f_radius;
in vec2 f_ray;
uniform vec4 u_axis_x, u_axis_y, u_axis_z;  // of the domain in view space
uniform vec4 u_low, u_high;                 // walls along them, from the eye
// The depths at which the ray through this fragment enters and leaves the sphere within the walls;
// the second is the smaller one where it passes by.
vec2 within() {
  vec3 d = vec3(f_ray, 1.0);
  float dd = dot(d, d);
  vec3 p = (dot(d, f_center) / dd) * d - f_center;
  float h2 = f_radius * f_radius - dot(p, p);
  if (h2 <= 0.0) return vec2(1.0, 0.0);
  float middle = f_center.z + p.z, reach = sqrt(h2 / dd);
  vec3 speed = vec3(dot(u_axis_x.xyz, d), dot(u_axis_y.xyz, d), dot(u_axis_z.xyz, d));
  speed = mix(speed, vec3(1e-9), lessThan(abs(speed), vec3(1e-9)));
  vec3 a = u_low.xyz / speed, b = u_high.xyz / speed;
  vec3 first = min(a, b), last = max(a, b);
  return vec2(max(max(middle - reach, first.x), max(first.y, first.z)),
              min(min(middle + reach, last.x), min(last.y, last.z)));
}
