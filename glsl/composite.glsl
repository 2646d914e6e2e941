// The parameters of the fragment shaders that draw the tiles' picture.
#ifndef RARA_COMPOSITE
#define RARA_COMPOSITE
struct Params {
    vec2 origin; // where the viewport begins in the attachment, px
    float unit; // what depths are multiplied by
    float depth_offset; // what the host's depth buffer holds for a depth: see host_depth.glsl
    float depth_scale;
};
#define PARAMS Params
#include "tile_pixel.glsl"

#endif
