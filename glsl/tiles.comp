#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a tile, an invocation a column of some of its pixels: the tile's splats front to back, until every pixel
// is saturated. What one splat has in common for a column is computed once; on CPU drivers a column is the whole tile's
// height, which makes a splat's fixed costs an eighth.
#include "frame.glsl"

// As in splat.frag.
layout(constant_id = 0) const uint CLIP_MODE = MODE_NONE;
layout(constant_id = 1) const uint CLIP_OP = OP_AND;
layout(constant_id = 2) const uint DECAY = DECAY_DEPTH;
layout(constant_id = 3) const uint MISS = MISS_PEAK;
layout(constant_id = 4) const uint PHI_FORM = 0u;
// Pixels of an invocation, one above the other.
layout(constant_id = 5) const uint ROWS = 8u;
layout(local_size_x = TILE_WIDTH, local_size_y_id = 6) in;
// Whether the camera stands still and only the clip moves: tiles that nothing has changed keep their pixels, and some of
// the splats are clipped away.
layout(constant_id = 7) const bool SWEEP = false;
// How the host's depth is stored that hides splats, if there is one.
layout(constant_id = 8) const uint DEPTH_FORM = DEPTH_NONE;
// The debug view.
layout(constant_id = 9) const bool SHOW_WEIGHT = false;

BUFFER(readonly, 1, Splat, splats)
BUFFER(readonly, 2, uint, pair_splats)
BUFFER(readonly, 3, uint, tile_begins)
BUFFER(readonly, 4, vec4, cuts)
BUFFER(writeonly, 5, vec4, picture)
BUFFER(readonly, 6, uint, dirty)
BUFFER(readonly, 7, uint, occluders)
#include "column.glsl"
#include "occluders.glsl"
#include "weight_colour.glsl"

void main() {
    uint tile = LINEAR_GROUP;
    if (tile >= FRAME.tile_count || (SWEEP && dirty.at[tile] == 0u)) {
        return;
    }
    uvec2 corner = uvec2(tile % FRAME.tile_columns * TILE_WIDTH, tile / FRAME.tile_columns * TILE_HEIGHT);
    uvec2 pixel = corner + gl_LocalInvocationID.xy * uvec2(1u, ROWS);
    vec2 place = vec2(pixel) + 0.5;
    vec3 sum[ROWS];
    float light[ROWS];
    for (uint row = 0u; row < ROWS; row++) {
        sum[row] = vec3(0.0);
        light[row] = 1.0;
    }
    float limit[ROWS];
    if (DEPTH_FORM != DEPTH_NONE) {
        for (uint row = 0u; row < ROWS; row++) {
            limit[row] = hidden_beyond(pixel + uvec2(0u, row));
        }
    }
    float saturated = FRAME.transmittance_min;
    uint end = tile_begins.at[tile + 1u];
    for (uint i = tile_begins.at[tile]; i < end; i++) {
        uint number = pair_splats.at[i];
        vec4 centre_conic = splats.at[number].centre_conic;
        vec4 conic_cut = splats.at[number].conic_cut;
        if (SWEEP && conic_cut.z == CUT_GONE) {
            continue;
        }
        vec4 colour_cut = splats.at[number].colour_cut;
        vec2 delta = place - centre_conic.xy;
        if (SWEEP && CLIP_MODE == MODE_EXACT && abs(conic_cut.z) < CUT_RANGE
            && is_carried_away(vec3(conic_cut.zw, colour_cut.w), splats.at[number].curvature.xyz, delta)) {
            continue;
        }
        float u = centre_conic.z * delta.x;
        float v = centre_conic.w * delta.x;
        float alpha[ROWS];
        for (uint row = 0u; row < ROWS; row++) {
            float y = place.y + float(row) - centre_conic.y;
            float w = v + conic_cut.x * y;
            float a = min(ALPHA_MAX, conic_cut.y * exp(-0.5 * (u * u + w * w)));
            alpha[row] = a >= ALPHA_MIN ? a : 0.0;
        }
        if (DEPTH_FORM != DEPTH_NONE) {
            float far = farness(host_depth(splats.at[number].middle.w));
            bool behind = true;
            for (uint row = 0u; row < ROWS; row++) {
                alpha[row] = far > limit[row] ? 0.0 : alpha[row];
                behind = behind && far > limit[row];
            }
            // So is all that follows, where the sort has looked at whole depths.
            if (behind && FRAME.key_shift == 0u) {
                break;
            }
        }
        float kept[ROWS];
        if (SHOW_WEIGHT) {
            for (uint row = 0u; row < ROWS; row++) {
                kept[row] = WHOLE;
            }
        }
        if (CLIP_MODE >= MODE_RARA && conic_cut.z < CUT_RANGE) {
            vec3 plane = vec3(conic_cut.zw, colour_cut.w);
            float weight[ROWS];
            if (CLIP_MODE == MODE_EXACT && plane.x > -CUT_RANGE) {
                carried_weights(plane, splats.at[number].curvature.xyz, delta, alpha, weight);
            } else {
                vec2 uv = vec2(u, v + conic_cut.x * delta.y);
                cut_weights(uint(plane.y) | uint(plane.z) << 16, delta, uv, conic_cut.x, place, alpha, weight);
            }
            if (SHOW_WEIGHT) {
                for (uint row = 0u; row < ROWS; row++) {
                    kept[row] = weight[row];
                }
            }
            bool whole = true;
            for (uint row = 0u; row < ROWS; row++) {
                whole = whole && (weight[row] >= 1.0 || alpha[row] == 0.0);
            }
            if (!whole) {
                for (uint row = 0u; row < ROWS; row++) {
                    alpha[row] = decayed(alpha[row], weight[row]);
                }
            }
        }
        float most = 0.0;
        for (uint row = 0u; row < ROWS; row++) {
            float share = light[row] * alpha[row];
            sum[row] += share * (SHOW_WEIGHT ? weight_colour(kept[row]) : colour_cut.rgb);
            light[row] -= share;
            most = max(most, light[row]);
        }
        if (most < saturated) {
            break;
        }
    }
    uvec2 size = uvec2(FRAME.size.xy);
    for (uint row = 0u; row < ROWS; row++) {
        if (pixel.x < size.x && pixel.y + row < size.y) {
            picture.at[(pixel.y + row) * size.x + pixel.x] = vec4(sum[row], 1.0 - light[row]);
        }
    }
}
