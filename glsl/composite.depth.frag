#version 460
#extension GL_GOOGLE_include_directive : require
// Writes the depths that tiles have found for the host's depth buffer.
#include "composite.glsl"
#include "host_depth.glsl"

layout(constant_id = 3) const bool BEHIND_EXPECTED = false; // expected depths lie before them

void main() {
    uint at;
    if (!find_pixel(at)) {
        discard;
    }
    uint expected = BEHIND_EXPECTED ? (pixels_end() + 1u) / 2u : 0u;
    float depth = picture.at[pixels_end() + expected + at / 4u][at % 4u];
    if (depth == NO_DEPTH) {
        discard;
    }
    gl_FragDepth = host_depth(depth);
}
