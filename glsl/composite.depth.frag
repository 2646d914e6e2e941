#version 460
#extension GL_GOOGLE_include_directive : require
// Writes the depths that tiles have found for the host's depth buffer.
#include "composite.glsl"
#include "host_depth.glsl"

void main() {
    uint at;
    if (!find_pixel(at)) {
        discard;
    }
    float depth = uintBitsToFloat(behind(at, WRITTEN_WORDS));
    if (depth == NO_DEPTH) {
        discard;
    }
    gl_FragDepth = host_depth(depth);
}
