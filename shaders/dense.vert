// Triangles too small for lines of their own: the vertex number is the node, shared by all its triangles.
precision highp float;
precision highp int;

uniform highp sampler2D nodes;  // as in mesh.vert
uniform vec4 view;
uniform vec4 to_clip;

out float value;

void main() {
  vec4 own = texelFetch(nodes, ivec2(gl_VertexID & 1023, gl_VertexID >> 10), 0);
  vec2 a = own.xy * view.xy + view.zw;
  value = own.z;
  gl_Position = vec4(a * to_clip.xy + to_clip.zw, 0.0, 1.0);
}
