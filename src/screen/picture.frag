#version 330 core

uniform sampler2D picture;
uniform ivec2 origin; // the picture's bottom left corner in the framebuffer
uniform uvec2 extent; // its width and height there
uniform vec3 steps;   // of the framebuffer's red, green and blue between 0 and 1; 0 where it holds floats

out vec4 color;

// Nearest neighbour: the texel that the centre of this pixel lies in, floor((pixel + 1/2) * size / extent), exactly. Drivers divide
// whole numbers one by one but floats together: the quotient of floats, made a little too small for any rounding, is the texel or the
// one before, and whole numbers tell which.
void main() {
    uvec2 size = uvec2(textureSize(picture, 0));
    uvec2 pixel = uvec2(ivec2(gl_FragCoord.xy) - origin);
    uvec2 dividend = (2u * pixel + 1u) * size;
    uvec2 divisor = 2u * extent;
    uvec2 texel = uvec2(0.999999 * (vec2(dividend) / vec2(divisor)));
    texel += uvec2(lessThanEqual((texel + 1u) * divisor, dividend));
    // texelFetch takes the texel's bits as they are.
    color = vec4(texelFetch(picture, ivec2(texel), 0).rgb, 1.0);
    if (steps.r > 0.0) {
        // OpenGL lets drivers round to a step that is not the nearest; this near to one, they take it. What max makes of NaN,
        // GLSL leaves open: 0 on the drivers that this was tried on.
        vec3 shown = min(max(vec3(0.0), color.rgb), 1.0);
        color.rgb = roundEven(shown * steps) / steps;
    }
}
