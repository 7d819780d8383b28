// Behind resolve_vertex.glsl: one direction of the smoothing. A pair of pixels at the same distance
// to both sides counts when its mean is near the pixel in the middle, which a plane's is however
// steeply it is seen, no pixel up to there lies off the fluid, and few lie behind an edge.

uniform sampler2D u_surface;
uniform vec2 u_along;  // (1, 0) or (0, 1)
uniform vec2 u_width;  // m: of the filter to each side, and how far off a pair may be
out vec2 o_surface;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(u_surface, 0) - 1;
  vec2 here = texelFetch(u_surface, at, 0).rg;
  o_surface = here;
  if (here.x <= 0.0) return;
  float z = 1.0 / here.x;
  float reach = max(u_width.x / (u_step * z), 1.0);  // pixels
  float joined = 1.0;  // falls with the way over edges: what lies behind them is another body
  vec2 sum = here, weight = vec2(1.0);
  int last_far = 0;
  for (int k = 0; k < 20; ++k) {
    // The same whole pixels for all, so that neighbors see the same; wider ones count more.
    int far = max(last_far + 1, int(1.22 * float(last_far) + 0.5)), gap = far - last_far;
    last_far = far;
    if (float(far) > reach) break;
    ivec2 off = ivec2(u_along) * far;
    vec2 a = texelFetch(u_surface, clamp(at + off, ivec2(0), last), 0).rg;
    vec2 b = texelFetch(u_surface, clamp(at - off, ivec2(0), last), 0).rg;
    if (a.x <= 0.0 || b.x <= 0.0) break;
    float away = (0.5 * (a.x + b.x) - here.x) * z * z / u_width.y;
    float rise = abs(a.x - b.x) * z / (float(far) * u_step);
    float outline = smoothstep(6.0, 12.0, rise);  // not a slope
    joined -= 1.3 * outline * float(gap) * u_step * z / u_width.y;
    if (joined <= 0.0) break;
    float share = float(far) / reach;
    float w = 2.0 * float(gap) * exp(-2.7 * share * share - away * away);
    w *= joined * (1.0 - outline);
    sum.x += w * 0.5 * (a.x + b.x);
    weight.x += w;
    if (a.y >= 0.0 && b.y >= 0.0) {
      sum.y += w * 0.5 * (a.y + b.y);
      weight.y += w;
    }
  }
  o_surface = vec2(sum.x / weight.x, here.y < 0.0 ? here.y : sum.y / weight.y);
}
