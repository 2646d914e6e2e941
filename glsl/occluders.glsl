// The host's depth, copied, which hides what lies behind it from tiles. Included after the buffer `occluders` is declared
// and the constant DEPTH_FORM. Parameters 8 and 9 are where in the picture the copy begins, px, 10 and 11 its size.
#ifndef RARA_OCCLUDERS
#define RARA_OCCLUDERS
#include "host_depth.glsl"

// Farther is more, on ordinary and on reversed depth.
float farness(float depth) {
    return uintBitsToFloat(push.param[7]) > 0.0 ? -depth : depth;
}

// Beyond which farness a splat is hidden in a pixel. Whole numbers hide what rounds to more than they hold.
float hidden_beyond(uvec2 pixel) {
    if (min(push.param[10], push.param[11]) == 0u) {
        return 3.0e38; // the image is not under the picture: nothing is hidden
    }
    ivec2 at = ivec2(pixel) - ivec2(push.param[8], push.param[9]);
    uvec2 inside = uvec2(clamp(at, ivec2(0), ivec2(push.param[10], push.param[11]) - 1));
    uint number = inside.y * push.param[10] + inside.x;
    if (DEPTH_FORM == DEPTH_FLOAT) {
        return farness(uintBitsToFloat(occluders.at[number]));
    }
    bool is_short = DEPTH_FORM == DEPTH_16;
    uint word = is_short ? occluders.at[number / 2u] >> (number % 2u * 16u) & 0xffffu : occluders.at[number] & 0xffffffu;
    return (farness(float(word)) + 0.5) / (is_short ? 65535.0 : 16777215.0);
}

#endif
