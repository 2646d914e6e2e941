// A copy of the host's depth, which hides from tiles what lies behind it. Included after the buffer `occluders` and the
// constant DEPTH_FORM are declared.
#ifndef RARA_OCCLUDERS
#define RARA_OCCLUDERS
#include "host_depth.glsl"

// A depth, turned so that farther is more on ordinary and on reversed depth.
float farness(float depth) {
    return push.params.depth_scale > 0.0 ? -depth : depth;
}

// The farness beyond which a splat is hidden in a pixel. A depth in whole numbers hides what rounds to more than it.
float occluder_farness(uvec2 pixel) {
    if (min(push.params.copy_size.x, push.params.copy_size.y) == 0u) {
        return 3.0e38; // the image is not under the picture: nothing is hidden
    }
    ivec2 at = ivec2(pixel) - push.params.copy_origin;
    uvec2 inside = uvec2(clamp(at, ivec2(0), ivec2(push.params.copy_size) - 1));
    uint number = inside.y * push.params.copy_size.x + inside.x;
    if (DEPTH_FORM == DEPTH_FLOAT) {
        return farness(uintBitsToFloat(occluders.at[number]));
    }
    bool is_short = DEPTH_FORM == DEPTH_16;
    uint word = is_short ? occluders.at[number / 2u] >> (number % 2u * 16u) & 0xffffu : occluders.at[number] & 0xffffffu;
    return (farness(float(word)) + 0.5) / (is_short ? 65535.0 : 16777215.0);
}

// The depth beyond which a pixel shows nothing. A pixel on which the host has drawn nothing hides nothing.
float occluder_depth(uvec2 pixel) {
    float scale = push.params.depth_scale;
    float held = farness(occluder_farness(pixel));
    if (scale > 0.0 ? held <= 0.0 : held >= 1.0) {
        return NO_DEPTH;
    }
    float falling = held - push.params.depth_offset;
    return is_orthographic() ? -falling / scale : scale / falling;
}

#endif
