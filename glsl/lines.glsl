// Lines over a picture: the draw's own command, and two vectors a line, which are x and y of both ends, px, and its colour and
// half its width, px.
struct Params {
    vec2 pixel; // a pixel's share of clip space: 2 / width, 2 / height
};
#define PARAMS Params
#include "buffers.glsl"

BUFFER_OF(readonly, 0, lines, uvec4 command; vec4 at[])
