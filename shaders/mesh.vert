// Filled triangles with their edges. Node data come from a texture, x, y, scalar a node; a vertex carries its
// own node and the two others, so that its height above the opposite edge is known here, in pixels.
precision highp float;
precision highp int;

uniform highp sampler2D nodes;  // x, y relative to the mesh origin; colour coordinate 0..1; 1 where finite
uniform vec4 view;              // pixels = nodes * view.xy + view.zw
uniform vec4 to_clip;  // clip = pixels * to_clip.xy + to_clip.zw
uniform float wire_half;        // half the width of the mesh lines, pixels

in ivec3 corner;  // own node, next, previous

out vec3 distances;  // to the three edges, in pixels
out float value;
flat out float wire_fade;  // 0 for triangles of only a few lines' width, of which nothing else would be seen

vec4 node(int i) { return texelFetch(nodes, ivec2(i & 1023, i >> 10), 0); }

void main() {
  vec4 own = node(corner.x);
  vec4 next = node(corner.y);
  vec4 previous = node(corner.z);
  vec2 a = own.xy * view.xy + view.zw;
  vec2 b = next.xy * view.xy + view.zw;
  vec2 c = previous.xy * view.xy + view.zw;
  float twice_area = abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  float side_a = distance(b, c);
  float side_b = distance(c, a);
  float side_c = distance(a, b);
  float height = twice_area / max(side_a, 1e-6);
  float smallest = twice_area / max(max(side_a, max(side_b, side_c)), 1e-6);

  int k = gl_VertexID % 3;
  distances = vec3(k == 0 ? height : 0.0, k == 1 ? height : 0.0, k == 2 ? height : 0.0);
  value = own.z;
  wire_fade = smoothstep(2.5, 10.0, smallest / max(2.0 * wire_half, 1.0));
  // A triangle with a node that is not finite is not drawn: its corners meet outside of the picture.
  bool finite = own.w * next.w * previous.w > 0.5;
  gl_Position = finite ? vec4(a * to_clip.xy + to_clip.zw, 0.0, 1.0) : vec4(-3.0, -3.0, 0.0, 1.0);
}
