#version 460
#extension GL_GOOGLE_include_directive : require
// The cost of blending a fragment at best: splats that cover whole tiles and stay in the cache, no pixel saturated,
// nothing cut, nothing to look up. An invocation owns a column of pixels as in tiles.glsl.
#include "limits.glsl"
#include "buffers.glsl"

layout(constant_id = 0) const uint ROWS = 8u;
layout(local_size_x = TILE_WIDTH, local_size_y_id = 1) in;

// Of each splat: centre, inverse covariance's factor, opacity, colour.
BUFFER(readonly, 0, vec4, splats)
BUFFER(writeonly, 1, vec4, picture)

void main() {
    vec2 place = vec2(gl_LocalInvocationID.xy * uvec2(1u, ROWS)) + 0.5;
    vec3 sum[ROWS];
    float light[ROWS];
    for (uint row = 0u; row < ROWS; row++) {
        sum[row] = vec3(0.0);
        light[row] = 1.0;
    }
    for (uint i = 0u; i < 3u * push.param[0]; i += 3u) {
        vec4 centre_conic = splats.at[i];
        vec4 conic_opacity = splats.at[i + 1u];
        vec3 colour = splats.at[i + 2u].rgb;
        vec2 delta = place - centre_conic.xy;
        float u = centre_conic.z * delta.x;
        float v = centre_conic.w * delta.x;
        for (uint row = 0u; row < ROWS; row++) {
            float w = v + conic_opacity.x * (delta.y + float(row));
            float a = min(ALPHA_MAX, conic_opacity.y * exp(-0.5 * (u * u + w * w)));
            float share = light[row] * (a >= ALPHA_MIN ? a : 0.0);
            sum[row] += share * colour;
            light[row] -= share;
        }
    }
    uint first = LINEAR_GROUP * TILE_WIDTH * TILE_HEIGHT + gl_LocalInvocationIndex;
    for (uint row = 0u; row < ROWS; row++) {
        picture.at[first + row * TILE_WIDTH * (TILE_HEIGHT / ROWS)] = vec4(sum[row], 1.0 - light[row]);
    }
}
