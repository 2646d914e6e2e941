#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a block of a layer packs what a host has written of its Gaussians, and finds the bounds of the block anew, by the
// rules of src/passes/block_order.rs. A block of which nothing is edited stays as it is.
struct Params {
    uint first_block; // the layer's
    uint gaussian_end; // its Gaussians fill its blocks up to this place
    uint first_number; // of what is edited, in the scene
    uint count; // Gaussians that are edited
    uint parts; // EDIT_*
    uint sh_words; // words of a Gaussian's spherical harmonics
    uint sh_floats; // 1: the constant coefficients are floats; 0: halves
    float spanning_opacity; // from which a splat spans a pixel
    float least_opacity; // what making up for the low-pass has to leave
    float low_pass; // px^2, of antialiased Gaussians; 0 of others
    uint edit; // the number of an edit that keeps what it moves; 0 of others
    uint shown; // the last such edit that a frame has shown
};
#define PARAMS Params
#include "buffers.glsl"
#include "types.glsl"
#include "extent.glsl"

layout(local_size_x = BLOCK_SIZE) in;

BUFFER(readonly, 0, PlainGaussian, plain)
BUFFER(, 1, Gaussian, gaussians)
BUFFER(, 2, uint, sh)
BUFFER(writeonly, 3, Block, blocks)
BUFFER(, 4, Gaussian, earlier) // in place of the opacity the bits of the edit's number, 0 before any
#include "nearest_half.glsl"

const float FLOAT_MAX = 3.402823466e38;
const float FLOAT_MIN_POSITIVE = 1.175494351e-38;
const uint INFINITE = 0x7f800000u;

shared uint edited;
shared uint may_miss; // some may miss all pixels
// Floats whose order is that of their words.
shared uint low[3];
shared uint high[3];
shared uint reach;
shared uint sigma;
shared uint spanning_scale;

uint ordered(float value) {
    uint bits = floatBitsToUint(value);
    return bits ^ (bits >> 31 == 0u ? 0x80000000u : 0xffffffffu);
}

float of_ordered(uint word) {
    return uintBitsToFloat(word ^ (word >> 31 == 0u ? 0xffffffffu : 0x80000000u));
}

bool is_finite(float value) {
    return (floatBitsToUint(value) & INFINITE) != INFINITE;
}

bool is_finite(vec3 v) {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

bool has_part(uint part) {
    return (push.params.parts & part) != 0u;
}

// The constant coefficients, and with EDIT_FLAT zeros in place of all others. Formats of halves have the third one beside what
// the others need.
void pack_colour(uint place, vec3 colour) {
    uint base = place * push.params.sh_words;
    bool floats = push.params.sh_floats != 0u;
    if (has_part(EDIT_COLOURS)) {
        if (floats) {
            uvec3 words = floatBitsToUint(colour);
            sh.at[base] = words.x;
            sh.at[base + 1u] = words.y;
            sh.at[base + 2u] = words.z;
        } else {
            sh.at[base] = nearest_half(colour.x) | nearest_half(colour.y) << 16;
            sh.at[base + 1u] = sh.at[base + 1u] & 0xffff0000u | nearest_half(colour.z);
        }
    }
    if (has_part(EDIT_FLAT)) {
        if (!floats) {
            sh.at[base + 1u] &= 0xffffu;
        }
        for (uint word = floats ? 3u : 2u; word < push.params.sh_words; word++) {
            sh.at[base + word] = 0u;
        }
    }
}

// A Gaussian with the parts that a host has written of it.
Gaussian with_parts(Gaussian gaussian, PlainGaussian given) {
    if (has_part(EDIT_POSITIONS)) {
        gaussian.position_opacity.xyz = given.position_opacity.xyz;
    }
    if (has_part(EDIT_OPACITIES)) {
        gaussian.position_opacity.w = given.position_opacity.w;
    }
    if (has_part(EDIT_SCALES)) {
        gaussian.scale.xyz = given.scale.xyz;
    }
    if (has_part(EDIT_ROTATIONS)) {
        gaussian.rotation = given.rotation;
    }
    return gaussian;
}

// Keeps what a Gaussian was, if no edit has since the last frame.
void keep_shape(uint place, Gaussian gaussian) {
    if (push.params.edit != 0u && floatBitsToUint(earlier.at[place].position_opacity.w) <= push.params.shown) {
        gaussian.position_opacity.w = uintBitsToFloat(push.params.edit);
        earlier.at[place] = gaussian;
    }
}

// Splat::spanning_scale in single precision, in units of the middle deviation, so that nothing overflows.
float spanning_scale_of(vec3 scale, float opacity) {
    // This is more than rounding takes from the result.
    const float MARGIN = 1.0001;
    float low_pass = push.params.low_pass;
    if (low_pass == 0.0) {
        return 0.0;
    }
    float least = min(scale.x, min(scale.y, scale.z));
    float middle = max(min(scale.x, scale.y), min(max(scale.x, scale.y), scale.z));
    float ratio = least / middle;
    float needed = MARGIN * push.params.least_opacity / opacity;
    float share = needed * needed;
    float squares = ratio * ratio;
    float rest = (1.0 - share) * squares;
    float half_sum = 0.5 * share * low_pass * (1.0 + squares);
    float root = half_sum + sqrt(half_sum * half_sum + max(rest, 0.0) * share * low_pass * low_pass);
    float result = sqrt(root / rest) / middle;
    // Fainter than that itself, flat, or no number.
    return rest > 0.0 && middle > 0.0 && is_finite(result) ? result : uintBitsToFloat(INFINITE);
}

// Widens the block's bounds by a Gaussian.
void add_to_bounds(Gaussian gaussian) {
    vec3 position = gaussian.position_opacity.xyz;
    vec3 scale = gaussian.scale.xyz;
    float opacity = gaussian.position_opacity.w;
    float own_sigma = largest(scale);
    float own_reach = REACH_MARGIN * opacity_extent(max(opacity, ALPHA_MIN)) * own_sigma;
    if (!(opacity >= push.params.spanning_opacity)) {
        atomicOr(may_miss, 1u);
    }
    if (is_finite(opacity) && opacity < ALPHA_MIN) {
        return; // nowhere visible, wherever it is
    }
    if (!(is_finite(position) && is_finite(scale) && is_finite(opacity) && is_finite(own_reach))) {
        // It must be looked at, wherever the others are.
        atomicMax(reach, ordered(uintBitsToFloat(INFINITE)));
        atomicOr(may_miss, 1u);
        return;
    }
    for (uint axis = 0u; axis < 3u; axis++) {
        atomicMin(low[axis], ordered(position[axis]));
        atomicMax(high[axis], ordered(position[axis]));
    }
    atomicMax(reach, ordered(own_reach));
    atomicMax(sigma, ordered(own_sigma));
    atomicMax(spanning_scale, ordered(spanning_scale_of(scale, opacity)));
}

void begin_bounds() {
    edited = 0u;
    may_miss = 0u;
    for (uint axis = 0u; axis < 3u; axis++) {
        low[axis] = ordered(FLOAT_MAX);
        high[axis] = ordered(-FLOAT_MAX);
    }
    reach = ordered(-1.0);
    sigma = ordered(0.0);
    spanning_scale = ordered(0.0);
}

vec3 corner(uint words[3]) {
    return vec3(of_ordered(words[0]), of_ordered(words[1]), of_ordered(words[2]));
}

void write_bounds(uint block) {
    float most = of_ordered(sigma);
    Block bounds;
    bounds.low_reach = vec4(corner(low), of_ordered(reach));
    bounds.high_sigma = vec4(corner(high), may_miss == 0u ? most : -max(most, FLOAT_MIN_POSITIVE));
    bounds.spanning_scale = of_ordered(spanning_scale);
    bounds.pad = uint[3](0u, 0u, 0u);
    blocks.at[block] = bounds;
}

void main() {
    uint block = push.params.first_block + LINEAR_GROUP;
    uint place = block * BLOCK_SIZE + gl_LocalInvocationIndex;
    if (block * BLOCK_SIZE >= push.params.gaussian_end) {
        return;
    }
    if (gl_LocalInvocationIndex == 0u) {
        begin_bounds();
    }
    barrier();
    bool is_there = place < push.params.gaussian_end;
    Gaussian gaussian = gaussians.at[min(place, push.params.gaussian_end - 1u)];
    uint index = floatBitsToUint(gaussian.scale.w) - push.params.first_number;
    bool is_edited = is_there && index < push.params.count;
    if (is_edited) {
        edited = 1u;
    }
    barrier();
    if (edited == 0u) {
        return;
    }
    if (is_edited) {
        PlainGaussian given = plain.at[index];
        keep_shape(place, gaussian);
        gaussian = with_parts(gaussian, given);
        gaussians.at[place] = gaussian;
        pack_colour(place, given.colour.xyz);
    }
    if (is_there) {
        add_to_bounds(gaussian);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        write_bounds(block);
    }
}
