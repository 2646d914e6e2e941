// The tile rasteriser: one workgroup a tile, one invocation a column of some of its pixels. It draws the tile's splats
// front to back, until every pixel is saturated. What a splat has in common for a column is computed once; on CPU drivers
// a column is the whole tile's height, which makes a splat's fixed costs an eighth.
#ifndef RARA_TILES
#define RARA_TILES
struct Params {
    vec2 principal_point; // of the camera, px
    float sigma; // the ellipsoid that mode `rara` traces, standard deviations
    uint cut_stride; // vec4s of a cutoff record
    float depth_offset; // what the host's depth buffer holds for a depth: see host_depth.glsl
    float depth_scale;
    ivec2 copy_origin; // where in the picture the copy of the host's depth begins, px
    uvec2 copy_size; // the copy's size, px
    uint list; // which of the two lists of tiles is drawn
};
#define PARAMS Params
#include "frame.glsl"
#include "weight_constants.glsl"

// Pixels of an invocation, one above the other.
layout(constant_id = 5) const uint ROWS = 8u;
layout(local_size_x = TILE_WIDTH, local_size_y_id = 6) in;
// True in a reclipped frame: tiles in which nothing has changed keep their pixels, and some of the splats are clipped
// away.
layout(constant_id = 7) const bool RECLIPPED = false;
// How the host's depth that hides splats is stored, if there is one.
layout(constant_id = 8) const uint DEPTH_FORM = DEPTH_NONE;
layout(constant_id = 9) const uint SHOW = SHOW_COLOUR; // SHOW_*
// True where the tiles that hold anything are listed: first those that need no code for several surfaces, then, from the end on,
// the others, and behind all of them how many each list has.
layout(constant_id = 11) const bool LISTED = false;
// True where the host's depth hides what lies behind it of a splat, not whole splats by the depth of their centres.
layout(constant_id = 14) const bool SOFT_DEPTH = false;
#include "behind.glsl"
#include "coarse.glsl"
const bool FINDS_DEPTH = EXPECTED_DEPTH || WRITTEN_DEPTH || SOFT_DEPTH;

BUFFER(readonly, 1, vec4, splats)
BUFFER(readonly, 2, uint, tile_splats)
BUFFER(readonly, 3, uint, tile_begins)
BUFFER(readonly, 4, vec4, cut_records)
BUFFER(readonly, 6, uint, dirty)
BUFFER(readonly, 7, uint, occluders)
BUFFER(readonly, 9, uint, tile_list)
#include "splats.glsl"
#include "column.glsl"
#include "region/tile_side.glsl"
#include "occluders.glsl"
#include "pixels.glsl"
#include "weight_colour.glsl"
#include "mean_depth.glsl"

const uint NO_TILE = ~0u;

// An invocation's pixels.
vec2 pixel_centre; // the first one's
vec3 sum[ROWS];
float transmittance[ROWS];
float alphas[SHOW >= SHOW_MEAN ? ROWS : 1u]; // their sum, or the most that one splat has added
float occluder[ROWS]; // the farness beyond which splats are hidden, or the depth where SOFT_DEPTH
float depths[EXPECTED_DEPTH ? ROWS : 1u]; // the sum of their splats' depths, each times what it adds to the alpha
float written[WRITTEN_DEPTH ? ROWS : 1u]; // the depth of the splat that makes them as opaque as is asked for
uint strongest[STRONGEST ? ROWS : 1u]; // the number of the splat that has added most to their alpha
float most_added[STRONGEST ? ROWS : 1u]; // how much that is
bool done; // no splat changes them any more

// The part of a splat that the loop reads.
struct Seen {
    vec4 centre_conic;
    vec2 conic_opacity;
    vec3 colour;
    vec3 linear;
    vec3 curvature;
    float far; // farness of its depth
};
// How deep it is, where depths are found.
SplatDepth seen_depth;
// Its number, where the strongest ones are.
uint seen_number;
#include "tile_batch.glsl"

// Applies a cut splat's weights to its alphas, and returns them in `weight`.
void weigh(Seen splat, Record record, vec2 delta, vec2 uv, inout float alpha[ROWS], out float weight[ROWS]) {
    bool open = CLIP_MODE == MODE_EXACT && splat.linear.x > -Z_RANGE
        ? carried_weights(splat.linear, splat.curvature, delta, alpha, weight)
        : cut_weights(record, delta, uv, splat.conic_opacity.x, pixel_centre, alpha, weight);
    if (open) {
        for (uint row = 0u; row < ROWS; row++) {
            alpha[row] = decayed(alpha[row], weight[row]);
        }
    }
}

// Takes out the pixels in which the splat is hidden, and says whether that is all of them.
bool hide(float far, inout float alpha[ROWS]) {
    bool behind = true;
    for (uint row = 0u; row < ROWS; row++) {
        alpha[row] = far > occluder[row] ? 0.0 : alpha[row];
        behind = behind && far > occluder[row];
    }
    return behind;
}

// A splat's alphas in the column, without those of the pixels in which it is hidden, and the weights of one that is whole. False where
// the column is done: the splat is hidden in all pixels, and so is all that follows.
bool opacities(Seen splat, float u, float v, out float alpha[ROWS], out float weight[ROWS]) {
    for (uint row = 0u; row < ROWS; row++) {
        weight[row] = WEIGHT_WHOLE;
        float y = pixel_centre.y + float(row) - splat.centre_conic.y;
        float w = v + splat.conic_opacity.x * y;
        float a = min(EYE.tiles.alpha_max, splat.conic_opacity.y * exp(-0.5 * (u * u + w * w)));
        alpha[row] = a >= ALPHA_MIN ? a : 0.0;
    }
    // Where the sort has compared whole depths, all that follows is hidden too.
    bool are_sorted = EYE.order.key_shift == 0u && EYE.order.by_distance == 0u;
    done = DEPTH_FORM != DEPTH_NONE && !SOFT_DEPTH && hide(splat.far, alpha) && are_sorted;
    return !done;
}

// How deep the splat of `seen_depth` is in the column's pixels.
void whole_depths(vec2 delta, out float here[ROWS]) {
    for (uint row = 0u; row < ROWS; row++) {
        here[row] = seen_depth.mean.x + seen_depth.mean.y * delta.x + seen_depth.mean.z * (delta.y + float(row));
    }
}

// The same of what the clip leaves of it.
void cut_depths(vec2 delta, out float here[ROWS]) {
    for (uint row = 0u; row < ROWS; row++) {
        here[row] = mean_depth(seen_depth, delta + vec2(0.0, row));
    }
}

// Takes from a splat's alphas what is behind the host's depth, and from its depths too.
void soften(SplatDepth depth, vec2 delta, inout float here[ROWS], inout float alpha[ROWS]) {
    for (uint row = 0u; row < ROWS; row++) {
        vec2 part = part_before(depth, delta + vec2(0.0, row), occluder[row]);
        alpha[row] = decayed(alpha[row], part.x);
        here[row] = part.y;
    }
}

// The depth of a splat that no clip bounds.
SplatDepth unbounded_depth() {
    vec4 none = vec4(8.0, 0.0, 0.0, 0.0);
    return SplatDepth(vec4(seen_depth.mean.xyz, abs(seen_depth.mean.w)), none, none);
}

// A whole splat whose mean depth the clip changes all the same.
const float Z_BOUNDED = 0.5 * (Z_WHOLE + Z_CUT_AWAY);
// The z from which on a bound changes a mean depth by less than 2e-5 deviations.
const float UNBOUNDED = 4.5;

// True when the clip may change the splat's mean depth in the tile, which the middle of a union does in any case.
bool is_bounded(SplatDepth depth, vec2 delta) {
    vec2 reach = 0.5 * vec2(TILE_WIDTH, TILE_HEIGHT);
    float far = depth.far.x + dot(depth.far.yz, delta) - dot(abs(depth.far.yz), reach);
    float near = depth.near.x + dot(depth.near.yz, delta) - dot(abs(depth.near.yz), reach);
    return depth.mean.w < 0.0 || min(far, near) < UNBOUNDED;
}

// `here` is the splat's depth in each pixel, where depths are found.
void add(Seen splat, float here[ROWS], float alpha[ROWS], float weight[ROWS]) {
    float most = 0.0;
    for (uint row = 0u; row < ROWS; row++) {
        float added = transmittance[row] * alpha[row];
        if (SHOW == SHOW_COUNT) {
            // A column goes on until all of its pixels are saturated.
            bool counts = alpha[row] >= ALPHA_MIN && transmittance[row] >= EYE.tiles.transmittance_min;
            sum[row] += vec3(counts ? 1.0 : 0.0);
        } else if (SHOW == SHOW_MEAN) {
            sum[row] += alpha[row] * splat.colour;
            alphas[row] += alpha[row];
        } else if (SHOW == SHOW_STRONGEST) {
            // Of equal ones the first counts, which is in front.
            if (added > alphas[row]) {
                alphas[row] = added;
                sum[row] = splat.colour;
            }
        } else {
            sum[row] += added * (SHOW == SHOW_WEIGHT ? weight_colour(weight[row]) : splat.colour);
        }
        if (EXPECTED_DEPTH) {
            depths[row] += added * here[row];
        }
        if (WRITTEN_DEPTH && transmittance[row] > EYE.tiles.written_transmittance
            && transmittance[row] - added <= EYE.tiles.written_transmittance) {
            written[row] = here[row];
        }
        // The first of equal ones counts, which is in front.
        if (STRONGEST && added > most_added[row]) {
            most_added[row] = added;
            strongest[row] = seen_number;
        }
        transmittance[row] -= added;
        most = max(most, transmittance[row]);
    }
    // A mean takes all, in whatever order.
    done = SHOW != SHOW_MEAN && most < EYE.tiles.transmittance_min;
}

void blend(Seen splat, vec2 delta) {
    float alpha[ROWS];
    float weight[ROWS];
    if (opacities(splat, splat.centre_conic.z * delta.x, splat.centre_conic.w * delta.x, alpha, weight)) {
        float here[ROWS];
        if (SOFT_DEPTH) {
            soften(unbounded_depth(), delta, here, alpha);
        } else if (FINDS_DEPTH) {
            whole_depths(delta, here);
        }
        add(splat, here, alpha, weight);
    }
}

// The same of a splat that may be cut. Drivers inline functions before they look at what is constant: a flag would cost the time to
// compile all of this twice.
void blend_cut(Seen splat, Record record, vec2 delta) {
    float u = splat.centre_conic.z * delta.x;
    float v = splat.centre_conic.w * delta.x;
    float alpha[ROWS];
    float weight[ROWS];
    if (opacities(splat, u, v, alpha, weight)) {
        if (CLIP_MODE >= MODE_RARA && splat.linear.x < Z_RANGE) {
            weigh(splat, record, delta, vec2(u, v + splat.conic_opacity.x * delta.y), alpha, weight);
        }
        float here[ROWS];
        if (FINDS_DEPTH) {
            bool is_bound = CLIP_MODE >= MODE_RARA && (WHOLE_ALONE || splat.linear.x != Z_WHOLE);
            if (SOFT_DEPTH) {
                SplatDepth depth = unbounded_depth();
                if (is_bound) {
                    depth = seen_depth;
                }
                soften(depth, delta, here, alpha);
            } else if (is_bound) {
                cut_depths(delta, here);
            } else {
                whole_depths(delta, here);
            }
        }
        add(splat, here, alpha, weight);
    }
}

// True when a splat is clipped away in the tile, which its list still holds.
bool is_away(Seen splat, vec2 delta) {
    return splat.linear.x == Z_CUT_AWAY || (RECLIPPED && CLIP_MODE == MODE_EXACT && abs(splat.linear.x) < Z_RANGE
        && is_carried_away(splat.linear, splat.curvature, delta));
}

// A splat as an invocation hands it to all, and its record if it has one. Where the cut's edge does not run through the tile it
// is whole, or away.
Seen load(uint number, float x, vec2 tile_middle, out Record record) {
    Seen splat;
    vec4 conic_cut = SPLAT_CONIC(number);
    vec4 colour_cut = SPLAT_COLOUR(number);
    splat.centre_conic = vec4(x, SPLAT_CENTRE(number).yzw);
    splat.conic_opacity = conic_cut.xy;
    splat.colour = colour_cut.rgb;
    splat.linear = vec3(conic_cut.zw, colour_cut.w);
    splat.curvature = vec3(0.0);
    if (CLIP_MODE == MODE_EXACT && splat.linear.x < Z_RANGE) {
        splat.curvature = SPLAT_CURVATURE(number).xyz;
        if (SHOW != SHOW_WEIGHT && splat.linear.x < -Z_RANGE) {
            splat.linear.x = z_beyond_strip(splat.linear, splat.curvature, tile_middle - splat.centre_conic.xy);
        }
    }
    if (CLIP_MODE >= MODE_RARA) {
        record = record_of(splat.linear);
    }
    if (CLIP_MODE >= MODE_RARA && SHOW != SHOW_WEIGHT && splat.linear.x < Z_RANGE) {
        uint side = tile_side(splat.linear, splat.curvature, record, splat.centre_conic, splat.conic_opacity.x, tile_middle);
        splat.linear.x = side == SIDE_VISIBLE ? Z_WHOLE : side == SIDE_INVISIBLE ? Z_CUT_AWAY : splat.linear.x;
    }
    splat.far = DEPTH_FORM != DEPTH_NONE ? farness(host_depth(SPLAT_DEPTH(number))) : 0.0;
    return splat;
}

// The workgroup's tile, or NO_TILE.
uint workgroup_tile() {
    if (LISTED) {
        uint place = LINEAR_GROUP;
        if (place >= tile_list.at[EYE.tiles.tile_count + push.params.list]) {
            return NO_TILE;
        }
        return tile_list.at[push.params.list == 0u ? place : EYE.tiles.tile_count - 1u - place];
    }
    // Tiles follow each other down the columns of a strip, not along the picture's rows: what a splat's next tile needs
    // of it is then still in the cache, whichever neighbour that is.
    uvec2 at = uvec2(gl_WorkGroupID.x / STRIP_ROWS, gl_WorkGroupID.y * STRIP_ROWS + gl_WorkGroupID.x % STRIP_ROWS);
    return at.y * EYE.tiles.tile_columns + at.x;
}

void main() {
    uint tile = workgroup_tile();
    if (tile >= EYE.tiles.tile_count || (RECLIPPED && dirty.at[tile] == 0u)) {
        return;
    }
    uvec2 tile_at = uvec2(tile % EYE.tiles.tile_columns, tile / EYE.tiles.tile_columns);
    uint begin = tile_begins.at[tile];
    uint end = tile_begins.at[tile + 1u];
    if (begin == end) {
        return; // nothing reads its pixels
    }
    find_cell(tile_at, begin, end);
    uvec2 size = uvec2(VIEW.size.xy);
    uvec2 pixel = tile_at * uvec2(TILE_WIDTH, TILE_HEIGHT) + gl_LocalInvocationID.xy * uvec2(1u, ROWS);
    pixel_centre = vec2(pixel) + 0.5;
    vec2 tile_middle = (vec2(tile_at) + 0.5) * vec2(TILE_WIDTH, TILE_HEIGHT);
    // Pixels beyond the picture are done from the start.
    done = pixel.x >= size.x || pixel.y >= size.y;
    for (uint row = 0u; row < ROWS; row++) {
        sum[row] = vec3(0.0);
        transmittance[row] = pixel.y + row < size.y ? 1.0 : 0.0;
        if (SHOW >= SHOW_MEAN) {
            alphas[row] = 0.0;
        }
        if (EXPECTED_DEPTH) {
            depths[row] = 0.0;
        }
        if (WRITTEN_DEPTH) {
            written[row] = NO_DEPTH;
        }
        if (STRONGEST) {
            strongest[row] = NO_SPLAT;
            most_added[row] = 0.0;
        }
        occluder[row] = 0.0;
        if (DEPTH_FORM != DEPTH_NONE) {
            uvec2 at = pixel + uvec2(0u, row);
            occluder[row] = SOFT_DEPTH ? occluder_depth(at) : occluder_farness(at);
        }
    }
    for (uint first = begin; first < end && !all_done(); first += BATCH) {
        float x;
        uint number = cell.words == 0u ? number_in_list(begin, first, end, x) : number_in_cell(first, end, x);
        Record record;
        Seen own = load(number, x, tile_middle, record);
        if (FINDS_DEPTH) {
            SplatDepth depth = SplatDepth(SPLAT_MEAN_DEPTH(number), SPLAT_FAR_BOUND(number), SPLAT_NEAR_BOUND(number));
            if (CLIP_MODE >= MODE_RARA && own.linear.x == Z_WHOLE && is_bounded(depth, tile_middle - own.centre_conic.xy)) {
                own.linear.x = Z_BOUNDED;
            }
            hand_over_depth(depth);
        }
        if (STRONGEST) {
            hand_over_number(number);
        }
        hand_over(own, record);
        uint count = min(end - first, BATCH);
        for (uint i = 0u; i < count; i++) {
            // All invocations run this, also those that are done: subgroup operations need every one.
            Seen splat = taken_over(i);
            if (FINDS_DEPTH) {
                seen_depth.mean = mean_depth_taken_over(i);
            }
            if (STRONGEST) {
                seen_number = number_taken_over(i);
            }
            vec2 delta = pixel_centre - splat.centre_conic.xy;
            if (WHOLE_ALONE && splat.linear.x == Z_WHOLE) {
                if (!done) {
                    blend(splat, delta);
                }
            } else {
                record = weight_taken_over(i, splat);
                if (FINDS_DEPTH && CLIP_MODE >= MODE_RARA) {
                    take_over_bounds(i, seen_depth);
                }
                if (!done && !((RECLIPPED || CLIP_MODE >= MODE_RARA) && is_away(splat, delta))) {
                    blend_cut(splat, record, delta);
                }
            }
        }
    }
    for (uint row = 0u; row < ROWS; row++) {
        if (pixel.x < size.x && pixel.y + row < size.y) {
            float alpha = SHOW == SHOW_STRONGEST ? alphas[row] : 1.0 - transmittance[row];
            vec3 colour = SHOW == SHOW_MEAN ? sum[row] * (alpha / max(alphas[row], 1e-30)) : sum[row];
            uint at = (pixel.y + row) * size.x + pixel.x;
            write_pixel(at, vec4(colour, alpha));
            if (EXPECTED_DEPTH) {
                uint pair = 2u * at;
                write_behind(pair, size.x * size.y, EXPECTED_WORDS, floatBitsToUint(depths[row]));
                write_behind(pair + 1u, size.x * size.y, EXPECTED_WORDS, floatBitsToUint(1.0 - transmittance[row]));
            }
            if (WRITTEN_DEPTH) {
                write_behind(at, size.x * size.y, WRITTEN_WORDS, floatBitsToUint(written[row]));
            }
            if (STRONGEST) {
                write_behind(at, size.x * size.y, STRONGEST_WORDS, strongest[row]);
            }
        }
    }
}

#endif
