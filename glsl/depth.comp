#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a splat finds how deep it is in each pixel, and how the clip changes that.
#define MESHES_BINDING 7
#include "beam.glsl"
#include "cut.glsl"

layout(local_size_x = SPLAT_GROUP_SIZE) in;

BUFFER(readonly, 2, Gaussian, gaussians)
BUFFER(readonly, 3, uint, splat_gaussians)
BUFFER(readonly, 4, FrameCounts, counts)
BUFFER(writeonly, 5, vec4, splats)
BUFFER(readonly, 6, uint, shortlists)
#include "region/gaussian_side.glsl"
#include "splats.glsl"

// By how much the mean of a.u changes a pixel, given the pixel: the update of affine_plane in cutoff.comp.
vec2 slope_of(Footprint f, vec3 c, vec3 a) {
    vec2 slope = vec2(dot(c, cross(a, f.b2)) + f.low_pass * dot(a, f.b1), -dot(c, cross(a, f.b1)) + f.low_pass * dot(a, f.b2));
    return slope * (f.scale / f.det);
}

// The covariance of a.u and b.u given a pixel, times the determinant.
float covariance(Footprint f, vec3 c, vec3 a, vec3 b) {
    float across = dot(cross(a, f.b1), cross(b, f.b1)) + dot(cross(a, f.b2), cross(b, f.b2));
    return dot(a, c) * dot(b, c) + f.low_pass * (across + f.low_pass * dot(a, b));
}

void main() {
    uint splat_index = LINEAR_GROUP * SPLAT_GROUP_SIZE + gl_LocalInvocationIndex;
    if (splat_index >= counts.at[0].visible + counts.at[0].cutoff) {
        return;
    }
    uint index = splat_gaussians.at[splat_index];
    enter_layer_of_block(index / BLOCK_SIZE);
    Gaussian gaussian = gaussians.at[index];
    Footprint f = footprint(gaussian);
    vec3 c = cross(f.b1, f.b2);
    SplatDepth depth;
    bool is_union = LAYER.region.op == OP_OR;
    float deviation = sqrt(max(covariance(f, c, f.m3, f.m3) / f.det, 1e-30));
    depth.mean = vec4(f.view_centre.z, slope_of(f, c, f.m3), is_union ? -deviation : deviation);
    depth.far = vec4(8.0, 0.0, 0.0, 0.0);
    depth.near = depth.far;
    vec3 position = gaussian.position_opacity.xyz;
    bool is_cut = CUT.region.mode >= MODE_RARA;
    float deviations = 0.0;
    if (has_parts() || SHORTLISTED) {
        float extent = opacity_extent(opacity_in_layer(gaussian));
        deviations = band_in_view(f, largest(gaussian.scale.xyz), extent);
        enter_shortlist(index / BLOCK_SIZE, deviations / band(extent));
    }
    if (has_parts()) {
        // What cuts a splat of a region with parts is taken for an intersection.
        is_cut = is_cut && gaussian_side(f.axes, position, deviations) == SIDE_CUTOFF;
    }
    uint asked = is_cut ? surface_count() : 0u;
    for (uint i = 0u; i < asked; i++) {
        uint surface = surface_at(i);
        if (has_parts() && surface_gaussian_side(surface, f.axes, position, deviations) != SIDE_CUTOFF) {
            continue;
        }
        vec4 half_space = surface_half_space(surface, f.axes, position);
        half_space = is_union ? -half_space : half_space;
        float size = max(largest(half_space.xyz), 1e-30);
        vec3 a = half_space.xyz / size;
        float distance = half_space.w / size;
        float variance = covariance(f, c, a, a);
        float inverse = inversesqrt(max(variance / f.det, 1e-30));
        float z = clamp(distance * inverse, -1e20, 1e20);
        vec4 bound = vec4(z, slope_of(f, c, a) * inverse, covariance(f, c, a, f.m3) / f.det * inverse);
        bool far = keeps_far(dot(a, c), a);
        if (far && z < depth.far.x) {
            depth.far = bound;
        } else if (!far && z < depth.near.x) {
            depth.near = bound;
        }
    }
    SPLAT_MEAN_DEPTH(splat_index) = depth.mean;
    SPLAT_FAR_BOUND(splat_index) = depth.far;
    SPLAT_NEAR_BOUND(splat_index) = depth.near;
}
