// What the host's depth buffer holds for a splat. Parameters 6 and 7 are the host's: an offset, and what is divided by the
// depth and added to it. Splats before the buffer's nearest depth or beyond its farthest one are still drawn.
#ifndef RARA_HOST_DEPTH
#define RARA_HOST_DEPTH
#include "frame.glsl"

float host_depth(float z) {
    precise float depth = uintBitsToFloat(push.param[6]) + uintBitsToFloat(push.param[7]) / z;
    return clamp(depth, 0.0, 1.0);
}

#endif
