#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// Reads the host's depth where it can be sampled, and leaves what a copy of it would: an invocation a word.
struct Params {
    ivec2 first; // the first pixel in the image
    uvec2 size; // of the part under the picture, px
};
#define PARAMS Params
#include "types.glsl"
#include "buffers.glsl"

layout(constant_id = 0) const uint DEPTH_FORM = DEPTH_FLOAT; // DEPTH_*
layout(local_size_x = HOST_DEPTH_GROUP_SIZE) in;

layout(set = 0, binding = MAX_BUFFERS) uniform texture2D host_depth;
BUFFER(writeonly, 0, uint, occluders)

uint stored(uint pixel) {
    ivec2 at = push.params.first + ivec2(pixel % push.params.size.x, pixel / push.params.size.x);
    float depth = texelFetch(host_depth, at, 0).x;
    if (DEPTH_FORM == DEPTH_FLOAT) {
        return floatBitsToUint(depth);
    }
    return uint(round(depth * (DEPTH_FORM == DEPTH_16 ? 65535.0 : 16777215.0)));
}

void main() {
    const uint PIXELS = DEPTH_FORM == DEPTH_16 ? 2u : 1u;
    uint word = LINEAR_GROUP * HOST_DEPTH_GROUP_SIZE + gl_LocalInvocationIndex;
    uint pixel = PIXELS * word;
    uint count = push.params.size.x * push.params.size.y;
    if (pixel >= count) {
        return;
    }
    uint value = stored(pixel);
    if (PIXELS == 2u && pixel + 1u < count) {
        value |= stored(pixel + 1u) << 16;
    }
    occluders.at[word] = value;
}
