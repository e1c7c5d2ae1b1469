precision highp float;

uniform sampler2D colors;   // 256 x 1
uniform vec4 plain;         // fill where there is no scalar
uniform float colored;      // 1: by the scalar, 0: plain
uniform vec4 wire;          // colour and strength of the mesh lines
uniform float wire_half;    // half their width, pixels

in vec3 distances;
in float value;
flat in float wire_fade;

out vec4 color;

void main() {
  vec3 fill = plain.rgb;
  float u = clamp(value, 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0;
  if (colored > 0.5) fill = texture(colors, vec2(u, 0.5)).rgb;
  float d = min(distances.x, min(distances.y, distances.z));
  float line = clamp(wire_half + 0.5 - d, 0.0, 1.0);
  color = vec4(mix(fill, wire.rgb, line * wire.a * wire_fade), 1.0);
}
