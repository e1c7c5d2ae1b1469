// Edges as strips with round joints: a rectangle of six vertices about each; the fragment shader decides by
// distance.
precision highp float;
precision highp int;

uniform highp sampler2D nodes;
uniform vec4 view;
uniform vec4 to_clip;
uniform float half_width;  // pixels

in ivec3 ends;    // the edge's nodes, and the end of the edge that follows; -1: none follows
in float along;   // length of the boundary before this edge, reference units

out vec2 position;
out float value;  // colour coordinate
flat out vec2 first;
flat out vec2 second;
flat out vec2 third;
flat out float follows;
flat out float start;

vec4 node(int i) { return texelFetch(nodes, ivec2(i & 1023, i >> 10), 0); }

void main() {
  vec4 na = node(ends.x);
  vec4 nb = node(ends.y);
  vec2 a = na.xy * view.xy + view.zw;
  vec2 b = nb.xy * view.xy + view.zw;
  float size = distance(a, b);
  vec2 t = size > 1e-6 ? (b - a) / size : vec2(1.0, 0.0);
  vec2 n = vec2(-t.y, t.x);
  float reach = half_width + 1.0;

  int k = gl_VertexID % 6;
  bool at_b = k == 1 || k == 2 || k == 4;
  bool left = k == 2 || k == 4 || k == 5;
  position = (at_b ? b + t * reach : a - t * reach) + (left ? n : -n) * reach;
  value = at_b ? nb.z : na.z;
  first = a;
  second = b;
  third = ends.z >= 0 ? node(ends.z).xy * view.xy + view.zw : b;
  follows = ends.z >= 0 ? 1.0 : 0.0;
  start = along * view.x;
  bool finite = na.w * nb.w > 0.5;
  gl_Position = finite ? vec4(position * to_clip.xy + to_clip.zw, 0.0, 1.0) : vec4(-3.0, -3.0, 0.0, 1.0);
}
