#version 330 core

uniform sampler2D layer; // colours multiplied by their alpha, rows from the top
uniform ivec2 corner;    // the layer's bottom left corner in the framebuffer

out vec4 color;

// Texel for pixel, without filtering: text stays as sharp as it was rasterised.
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - corner;
    color = texelFetch(layer, ivec2(pixel.x, textureSize(layer, 0).y - 1 - pixel.y), 0);
}
