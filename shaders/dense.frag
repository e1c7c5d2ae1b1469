precision highp float;

uniform sampler2D colors;  // 256 x 1
uniform vec4 plain;        // fill where there is no scalar
uniform float colored;     // 1: by the scalar, 0: plain

in float value;

out vec4 color;

void main() {
  vec3 fill = plain.rgb;
  float u = clamp(value, 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0;
  if (colored > 0.5) fill = texture(colors, vec2(u, 0.5)).rgb;
  color = vec4(fill, 1.0);
}
