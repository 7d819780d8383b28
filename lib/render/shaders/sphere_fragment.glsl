// Ray and sphere: exact outline, normal and depth. p, the ray's nearest point seen from the centre,
// keeps the digits that |c|^2 - r^2 would lose for small spheres far away.

flat in vec3 f_center;
flat in vec3 f_color;
flat in float f_radius;
in vec2 f_ray;
out vec4 o_color;
void main() {
  vec3 d = vec3(f_ray, 1.0);
  float dd = dot(d, d);
  vec3 p = (dot(d, f_center) / dd) * d - f_center;
  float h2 = f_radius * f_radius - dot(p, p);
  if (h2 <= 0.0) discard;
  d *= inversesqrt(dd);
  vec3 n = (p - sqrt(h2) * d) / f_radius;
  float z = f_center.z + n.z * f_radius;
  if (z <= 0.0) discard;
  gl_FragDepth = u_depth.x - u_depth.y / z;
  float shine = max(dot(n, normalize(u_sun.xyz - d)), 0.0);
  shine *= shine; shine *= shine; shine *= shine; shine *= shine; shine *= shine;
  vec4 seen = lit(f_color, n);
  o_color = vec4(seen.rgb + 0.16 * shine, kept_share(seen.a));
}
