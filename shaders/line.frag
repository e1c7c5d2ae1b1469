precision highp float;

uniform vec4 ink;
uniform sampler2D colors;   // 256 x 1
uniform float colored;      // 1: by the scalar, 0: ink
uniform float half_width;  // pixels
uniform float dash;        // period of the dashes in pixels; 0: solid

in vec2 position;
in float value;
flat in vec2 first;
flat in vec2 second;
flat in vec2 third;
flat in float follows;
flat in float start;

out vec4 color;

void main() {
  vec2 edge = second - first;
  // Every point of the line belongs to one edge only, or soft rims would be drawn twice at each joint: behind
  // its start to the edge before, beyond its end to the next one, but for the wedge between the two.
  if (dot(position - first, edge) < 0.0) discard;
  vec2 beyond = position - second;
  if (follows > 0.5 && dot(beyond, edge) >= 0.0 && dot(beyond, third - second) >= 0.0) discard;
  float size = max(length(edge), 1e-6);
  float s = clamp(dot(position - first, edge) / size, 0.0, size);
  float d = distance(position, first + edge * (s / size));
  float alpha = clamp(half_width + 0.5 - d, 0.0, 1.0);
  if (dash > 0.0) {
    float phase = abs(fract((start + s) / dash) - 0.5) * dash;  // from the middle of a dash, pixels
    alpha *= clamp(dash * 0.29 + 0.5 - phase, 0.0, 1.0);
  }
  float u = clamp(value, 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0;
  vec3 rgb = colored > 0.5 ? texture(colors, vec2(u, 0.5)).rgb : ink.rgb;
  color = vec4(rgb, ink.a * alpha);
}
