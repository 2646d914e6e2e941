#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a splat computes its conic, quad and colour for the rasteriser, and the key that orders it.
struct Params {
    uint first_layer; // COLOURS_LAYERS: the layer that is red; the next one is green, and the one after it blue
};
#define PARAMS Params
#include "footprint.glsl"
#include "quad.glsl"
#include "spherical_harmonics.glsl"
#include "rects.glsl"

layout(local_size_x_id = 8) in;
// Splats of an invocation. On processors, whose workgroups are small, it asks for several at once, by a word of each: one wait
// brings them all into the cache.
const uint TURNS = SPLAT_GROUP_SIZE / gl_WorkGroupSize.x;
layout(constant_id = 0) const bool CUTS = false;
// True when tiles are wanted.
layout(constant_id = 2) const bool TILES = false;
// True when quads are drawn.
layout(constant_id = 3) const bool QUADS = false;
// True when rectangles of tiles are wanted, and masks only where these do not tell everything.
layout(constant_id = 5) const bool RECTS = false;
layout(constant_id = 6) const uint COLOURS = COLOURS_SCENE; // COLOURS_*
// True where the sort finds the splats' numbers beside their keys.
layout(constant_id = 7) const bool NUMBERS = false;

BUFFER(readonly, 1, Gaussian, gaussians)
BUFFER(readonly, 2, uint, sh)
BUFFER(readonly, 3, uint, splat_gaussians)
BUFFER(readonly, 4, FrameCounts, counts)
BUFFER(writeonly, 5, vec4, splats)
BUFFER(writeonly, 6, Quad, quads)
BUFFER(writeonly, 7, uint, depth_keys)
#include "sh_storage.glsl"
BUFFER(readonly, 8, vec4, cut_records)
BUFFER(writeonly, 9, uvec4, tile_masks)

#include "splats.glsl"
#include "carried.glsl"
#include "splat_gaussians.glsl"

// `first` is its first word.
vec3 colour(uint index, uint first, vec3 direction) {
    float basis[MAX_SH_COEFFICIENTS];
    sh_basis(direction, VIEW.sh_degree, basis);
    uint base = sh_base(index);
    vec3 sum = 0.5 + basis[0] * sh_constant(base, first);
    // Each degree has its own loop, since the compiler unrolls loops of a fixed length.
    if (VIEW.sh_degree > 0u) {
        mat3 units = sh_units(base);
        for (uint i = 1u; i < 4u; i++) {
            sum += basis[i] * sh_coefficient(base, units[0], i);
        }
        if (VIEW.sh_degree > 1u) {
            for (uint i = 4u; i < 9u; i++) {
                sum += basis[i] * sh_coefficient(base, units[1], i);
            }
        }
        if (VIEW.sh_degree > 2u) {
            for (uint i = 9u; i < 16u; i++) {
                sum += basis[i] * sh_coefficient(base, units[2], i);
            }
        }
    }
    // The colour stays finite: infinity times an alpha of 0 would be no number.
    return clamp(sum, vec3(0.0), vec3(3e38));
}

// A number takes two floats, since one holds only 24 bits.
vec3 numbers(uint number) {
    return vec3(float(number & 0xffffu), float(number >> 16), float(layer_number));
}

// The direction of a Gaussian's thinnest axis, of equal ones the first, turned to the eye, in the camera's frame.
vec3 normal(Gaussian gaussian, vec3 sight) {
    vec3 scale = gaussian.scale.xyz;
    uint thinnest = scale.x <= scale.y && scale.x <= scale.z ? 0u : (scale.y <= scale.z ? 1u : 2u);
    vec3 axis = rotation_matrix(gaussian.rotation)[thinnest];
    return normalize(to_view(dot(axis, sight) > 0.0 ? -axis : axis));
}

// The colour that a splat is drawn with, seen in a direction.
vec3 shown(uint index, uint first, Gaussian gaussian, vec3 direction) {
    vec3 sight = normalize(quotient(direction, largest(direction)));
    if (COLOURS == COLOURS_NUMBERS) {
        return numbers(floatBitsToUint(gaussian.scale.w));
    }
    if (COLOURS == COLOURS_NORMALS) {
        return normal(gaussian, sight);
    }
    if (COLOURS == COLOURS_LAYERS) {
        return vec3(equal(uvec3(layer_number), push.params.first_layer + uvec3(0u, 1u, 2u)));
    }
    return colour(index, first, sight);
}

// `x` is its Gaussian's, and `first` the first word of that one's spherical harmonics.
void project(uint splat_index, uint index, float x, uint first) {
    enter_layer_of_block(index / BLOCK_SIZE);
    Gaussian gaussian = gaussians.at[index];
    gaussian.position_opacity.x = x;
    Footprint f = footprint(gaussian);
    float opacity = opacity_on_screen(f, gaussian);
    float extent = opacity_extent(opacity);

    Splat splat;
    vec3 conic = conic_of(f);
    uint cut = CUTS ? splat_gaussians.at[cut_place(splat_index)] : NOT_CUT;
    Carried weight = CUTS ? carried_weight(cut) : whole_weight();
    Quad quad = quad_around(f, extent, weight);
    if (QUADS) {
        quads.at[splat_index] = quad;
    }
    splat.centre_conic = vec4(f.screen_centre, conic.xy);
    splat.conic_cut = vec4(conic.z, opacity, weight.linear.xy);
    vec3 direction = is_orthographic() ? LAYER_VIEW.rotation_z.xyz : f.relative;
    splat.colour_cut = vec4(shown(index, first, gaussian, direction), weight.linear.z);
    splat.curvature_depth = vec4(weight.curvature, f.view_centre.z);
    SPLAT_CENTRE(splat_index) = splat.centre_conic;
    SPLAT_CONIC(splat_index) = splat.conic_cut;
    SPLAT_COLOUR(splat_index) = splat.colour_cut;
    if (!splats_lie_apart()) {
        SPLAT_CURVATURE(splat_index) = splat.curvature_depth;
    } else {
        if (CUTS && weight.linear.x < Z_RANGE) {
            SPLAT_CURVATURE(splat_index) = splat.curvature_depth;
        }
        SPLAT_DEPTH(splat_index) = splat.curvature_depth.w;
    }
    if (TILES) {
        Outline o = outline(splat, quad);
        uvec4 tiles = tile_mask(o);
        uint word = rect_word(tiles);
        if (RECTS) {
            RECT_WORD(tile_masks, splat_index) = word;
        }
        if (!RECTS || needs_mask(word)) {
            tile_masks.at[splat_index] = tiles;
        }
    }
    // Positive floats order like their bits. Counted from the nearest depth that the scene's bounds allow they need
    // fewer bits, and the sort fewer passes; dropping low bits never reverses an order.
    float far = EYE.order.by_distance == 0u ? f.view_centre.z : dot(f.view_centre, f.view_centre);
    uint depth = max(floatBitsToUint(far), EYE.order.key_near) - EYE.order.key_near;
    depth_keys.at[splat_index] = min(depth, EYE.order.key_span) >> EYE.order.key_shift;
    if (NUMBERS) {
        depth_keys.at[number_place(splat_index)] = floatBitsToUint(gaussian.scale.w);
    }
}

void main() {
    uint count = counts.at[0].visible + counts.at[0].cutoff;
    uint first_splat = LINEAR_GROUP * SPLAT_GROUP_SIZE;
    uint splat_index = first_splat + gl_LocalInvocationIndex;
    uint index[TURNS];
    float x[TURNS];
    uint first[TURNS];
    for (uint turn = 0u; turn < TURNS; turn++) {
        index[turn] = splat_gaussians.at[min(splat_index + turn * gl_WorkGroupSize.x, count - 1u)];
    }
    for (uint turn = 0u; turn < TURNS; turn++) {
        x[turn] = gaussians.at[index[turn]].position_opacity.x;
        first[turn] = sh.at[sh_base(index[turn])];
    }
    // Counted by splats, since compilers copy the body of a loop over the arrays for each turn, which takes CPU drivers twelve
    // times as long to compile, and twenty where buffers are bound. On GPUs, where it has one turn, no loop is left.
    uint end = min(count, first_splat + SPLAT_GROUP_SIZE);
    for (; splat_index < end; splat_index += gl_WorkGroupSize.x) {
        uint turn = (splat_index - first_splat) / gl_WorkGroupSize.x;
        project(splat_index, index[turn], x[turn], first[turn]);
        if (TURNS == 1u) {
            break;
        }
    }
}
