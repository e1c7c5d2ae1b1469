precision highp float;

uniform sampler2D image;

in vec2 at;
in vec4 ink;

out vec4 color;

void main() { color = ink * texture(image, at); }
