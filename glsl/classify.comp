#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a block that neither view nor clip settles as a whole. It culls by footprint, opacity and size, and finds
// the side of what is in view. It writes two bits a Gaussian (survives, is cut) and the block's totals; compact turns them
// into ordered lists.
#define MESHES_BINDING 9
#include "beam.glsl"
#define SETS 3u // visible, cut, invisible
#include "side_masks.glsl"

layout(constant_id = 0) const bool CLIP = false;

BUFFER(readonly, 2, Gaussian, gaussians)
BUFFER_OF(readonly, 3, block_list, uvec4 groups; uint at[])
BUFFER(readonly, 4, uint, clip_sides)
BUFFER(readonly, 5, uint, clip_masks)
BUFFER(writeonly, 6, uint, masks)
BUFFER(writeonly, 7, uint, block_counts)
BUFFER(readonly, 8, uint, shortlists)
#include "region/gaussian_side.glsl"

// True when some pixel centre lies in the splat's bounding box and in the picture.
bool covers_a_pixel(vec2 centre, vec2 half_sides) {
    vec2 low = max(ceil(centre - half_sides - 0.5), vec2(0.0));
    vec2 high = min(floor(centre + half_sides - 0.5), VIEW.size.xy - 1.0);
    return low.x <= high.x && low.y <= high.y;
}

// The side that stage clip has found.
uint clip_stage_side(uint block, uint local) {
    uint side = clip_sides.at[block];
    if (side != SIDE_CUTOFF) {
        return side;
    }
    uint word = block * 2u * WORDS + (local >> 5);
    return side_of(clip_masks.at[word], clip_masks.at[word + WORDS], local);
}

// `is_in_view` says that all of the block is: none of it is culled.
uint classify(uint block, uint local, bool is_in_view) {
    uint index = block * BLOCK_SIZE + local;
    Gaussian gaussian = gaussians.at[index];
    Footprint f;
    if (CLIP && is_in_view) {
        f = unprojected(gaussian);
    } else {
        // The depth comes first: it is cheap and culls what is behind the eye. The test is negated to cull a NaN too.
        float depth = dot(LAYER_VIEW.rotation_z.xyz, eye_relative(gaussian.position_opacity.xyz));
        if (!(depth >= VIEW.near_cut) || opacity_in_layer(gaussian) < ALPHA_MIN) {
            return SIDE_CULLED;
        }
        f = footprint(gaussian);
        float opacity = opacity_on_screen(f, gaussian);
        // Deviations beyond the range of single precision have no footprint. Each number is tested by itself, since max()
        // may drop a NaN.
        bool drawable = all(lessThan(abs(conic_of(f)), vec3(3e38))) && all(lessThan(abs(f.screen_centre), vec2(3e38)));
        bool shows = opacity >= ALPHA_MIN && covers_a_pixel(f.screen_centre, box_half_sides(f, opacity_extent(opacity)));
        if (!drawable || !shows) {
            return SIDE_CULLED;
        }
    }
    if (!CLIP) {
        return SIDE_VISIBLE;
    }
    float sigma = largest(gaussian.scale.xyz);
    if (CUT.region.mode == MODE_EXACT && is_beam(f, sigma)) {
        float extent = opacity_extent(opacity_in_layer(gaussian));
        float deviations = beam_band(f, extent);
        enter_shortlist(block, deviations / extent);
        return gaussian_side(f.axes, gaussian.position_opacity.xyz, deviations);
    }
    return clip_stage_side(block, local);
}

void main() {
    uint group = LINEAR_GROUP;
    bool is_block = group < block_list.groups.w;
    uint entry = is_block ? block_list.at[group] : 0u;
    uint block = entry & ~WHOLLY_IN_VIEW;
    enter_layer_of_block(block);
    uint length = is_block ? block_length(block) : 0u;
    begin_masks();
    for (uint turn = 0u; turn < TURNS; turn++) {
        uint local = local_in_turn(turn);
        if (local < length) {
            uint side = classify(block, local, (entry & WHOLLY_IN_VIEW) != 0u);
            add_to_masks(turn, side == SIDE_VISIBLE ? 1u : side == SIDE_CUTOFF ? 2u : side == SIDE_INVISIBLE ? 4u : 0u);
        }
        if (TURNS == 1u) {
            break;
        }
    }
    end_masks();
    uint local = gl_LocalInvocationIndex;
    if (is_block && local < WORDS) {
        uint cut = set_masks[WORDS + local];
        masks.at[block * 2u * WORDS + local] = set_masks[local] | cut;
        masks.at[block * 2u * WORDS + WORDS + local] = cut;
    }
    if (is_block && local < SETS) {
        block_counts.at[4u * block + local] = set_count(local);
    }
}
