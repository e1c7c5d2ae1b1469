// Two-dimensional drawing lists: text, lines and shapes, in pixels from the top left.
precision highp float;

uniform vec4 to_clip;

in vec2 position;
in vec2 uv;
in vec4 tint;

out vec2 at;
out vec4 ink;

void main() {
  at = uv;
  ink = tint;
  gl_Position = vec4(position * to_clip.xy + to_clip.zw, 0.0, 1.0);
}
