// The tile rasteriser. One workgroup a tile, an invocation a column of some of its pixels: the tile's splats front to
// back, until every pixel is saturated. What one splat has in common for a column is computed once; on CPU drivers a
// column is the whole tile's height, which makes a splat's fixed costs an eighth.
#ifndef RARA_TILES
#define RARA_TILES
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

// A subgroup takes a batch of the splats at once: each invocation loads one, and all see them in turn. Without subgroup
// operations a batch is one splat, which every invocation loads.
#ifdef RARA_SUBGROUP
#define BATCH gl_SubgroupSize
#define IN_BATCH gl_SubgroupInvocationID
#define OF(invocation, value) subgroupShuffle(value, invocation)
#define EVERY(value) subgroupAll(value)
#else
#define BATCH 1u
#define IN_BATCH 0u
#define OF(invocation, value) (value)
#define EVERY(value) (value)
#endif

// Tiles follow each other down the columns of strips of so many rows, not along the picture's rows: what a splat's next
// tile needs of it is then still in the cache, whichever neighbour that is.
const uint STRIP_ROWS = 8u;

uvec2 tile_place(uint number) {
    uint strip = number / (STRIP_ROWS * FRAME.tile_columns);
    uint within = number % (STRIP_ROWS * FRAME.tile_columns);
    uint rows = min(STRIP_ROWS, FRAME.tile_count / FRAME.tile_columns - STRIP_ROWS * strip);
    return uvec2(within / rows, STRIP_ROWS * strip + within % rows);
}

void main() {
    if (LINEAR_GROUP >= FRAME.tile_count) {
        return;
    }
    uvec2 tile_at = tile_place(LINEAR_GROUP);
    uint tile = tile_at.y * FRAME.tile_columns + tile_at.x;
    if (SWEEP && dirty.at[tile] == 0u) {
        return;
    }
    uvec2 size = uvec2(FRAME.size.xy);
    uvec2 pixel = tile_at * uvec2(TILE_WIDTH, TILE_HEIGHT) + gl_LocalInvocationID.xy * uvec2(1u, ROWS);
    vec2 place = vec2(pixel) + 0.5;
    vec3 sum[ROWS];
    float light[ROWS];
    for (uint row = 0u; row < ROWS; row++) {
        sum[row] = vec3(0.0);
        // Pixels beyond the picture keep nobody waiting.
        light[row] = pixel.x < size.x && pixel.y + row < size.y ? 1.0 : 0.0;
    }
    float limit[ROWS];
    if (DEPTH_FORM != DEPTH_NONE) {
        for (uint row = 0u; row < ROWS; row++) {
            limit[row] = hidden_beyond(pixel + uvec2(0u, row));
        }
    }
    float saturated = FRAME.transmittance_min;
    uint end = tile_begins.at[tile + 1u];
    bool done = false;
    for (uint first = tile_begins.at[tile]; first < end && !EVERY(done); first += BATCH) {
        uint mine = pair_splats.at[min(first + IN_BATCH, end - 1u)];
        vec4 my_centre_conic = splats.at[mine].centre_conic;
        vec4 my_conic_cut = splats.at[mine].conic_cut;
        vec4 my_colour_cut = splats.at[mine].colour_cut;
        vec3 my_curvature = vec3(0.0);
        if (CLIP_MODE == MODE_EXACT && abs(my_conic_cut.z) < CUT_RANGE) {
            my_curvature = splats.at[mine].curvature.xyz;
        }
        float my_depth = DEPTH_FORM != DEPTH_NONE ? splats.at[mine].middle.w : 0.0;
        uint count = min(end - first, BATCH);
        for (uint i = 0u; i < count; i++) {
            // All invocations take part in this, whoever is done.
            vec4 centre_conic = OF(i, my_centre_conic);
            vec2 conic_opacity = OF(i, my_conic_cut.xy);
            vec3 colour = OF(i, my_colour_cut.rgb);
            vec3 plane = vec3(CUT_WHOLE, 0.0, 0.0);
            vec3 curvature = vec3(0.0);
            if (CLIP_MODE >= MODE_RARA || SWEEP) {
                plane = vec3(OF(i, my_conic_cut.zw), OF(i, my_colour_cut.w));
            }
            if (CLIP_MODE == MODE_EXACT) {
                curvature = OF(i, my_curvature);
            }
            float depth = DEPTH_FORM != DEPTH_NONE ? OF(i, my_depth) : 0.0;
            vec2 delta = place - centre_conic.xy;
            bool away = SWEEP && (plane.x == CUT_GONE
                || (CLIP_MODE == MODE_EXACT && abs(plane.x) < CUT_RANGE && is_carried_away(plane, curvature, delta)));
            if (done || away) {
                continue;
            }
            float u = centre_conic.z * delta.x;
            float v = centre_conic.w * delta.x;
            float alpha[ROWS];
            for (uint row = 0u; row < ROWS; row++) {
                float y = place.y + float(row) - centre_conic.y;
                float w = v + conic_opacity.x * y;
                float a = min(ALPHA_MAX, conic_opacity.y * exp(-0.5 * (u * u + w * w)));
                alpha[row] = a >= ALPHA_MIN ? a : 0.0;
            }
            if (DEPTH_FORM != DEPTH_NONE) {
                float far = farness(host_depth(depth));
                bool behind = true;
                for (uint row = 0u; row < ROWS; row++) {
                    alpha[row] = far > limit[row] ? 0.0 : alpha[row];
                    behind = behind && far > limit[row];
                }
                // So is all that follows, where the sort has looked at whole depths.
                if (behind && FRAME.key_shift == 0u) {
                    done = true;
                    continue;
                }
            }
            float kept[ROWS];
            if (SHOW_WEIGHT) {
                for (uint row = 0u; row < ROWS; row++) {
                    kept[row] = WHOLE;
                }
            }
            if (CLIP_MODE >= MODE_RARA && plane.x < CUT_RANGE) {
                float weight[ROWS];
                if (CLIP_MODE == MODE_EXACT && plane.x > -CUT_RANGE) {
                    carried_weights(plane, curvature, delta, alpha, weight);
                } else {
                    vec2 uv = vec2(u, v + conic_opacity.x * delta.y);
                    uint cut = to_uint(plane.y) | to_uint(plane.z) << 16;
                    cut_weights(cut, delta, uv, conic_opacity.x, place, alpha, weight);
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
                sum[row] += share * (SHOW_WEIGHT ? weight_colour(kept[row]) : colour);
                light[row] -= share;
                most = max(most, light[row]);
            }
            done = most < saturated;
        }
    }
    for (uint row = 0u; row < ROWS; row++) {
        if (pixel.x < size.x && pixel.y + row < size.y) {
            picture.at[(pixel.y + row) * size.x + pixel.x] = vec4(sum[row], 1.0 - light[row]);
        }
    }
}

#endif
