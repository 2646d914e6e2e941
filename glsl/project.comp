#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a survivor: conic, quad and colour for the rasteriser, and the key that orders it.
#include "footprint.glsl"
#include "spherical_harmonics.glsl"

layout(local_size_x = SURVIVOR_GROUP_SIZE) in;

BUFFER(readonly, 1, Gaussian, gaussians)
BUFFER(readonly, 2, uint, sh)
BUFFER(readonly, 3, uvec2, survivors)
BUFFER(readonly, 4, FrameCounts, counts)
BUFFER(writeonly, 5, Splat, splats)
BUFFER(writeonly, 6, uint, keys)
BUFFER(writeonly, 7, uint, order)
#include "sh_storage.glsl"

vec3 colour(uint index, vec3 direction) {
    float basis[MAX_SH_COEFFICIENTS];
    sh_basis(direction, FRAME.sh_degree, basis);
    uint base = index * sh_words(FRAME.sh_coefficients * 3u);
    float unit = sh_unit(base);
    uint used = (FRAME.sh_degree + 1u) * (FRAME.sh_degree + 1u);
    vec3 sum = vec3(0.5);
    for (uint i = 0u; i < used; i++) {
        uint k = 3u * i;
        sum += basis[i] * vec3(sh_number(base, unit, k), sh_number(base, unit, k + 1u), sh_number(base, unit, k + 2u));
    }
    return max(sum, vec3(0.0));
}

// Half axes of the smallest rectangle around the contour q = extent^2, px; det comes as a sum of squares, so the
// thin axis of a needle is right where a difference of eigenvalues would be noise.
void quad_axes(Footprint f, float extent, out vec2 first, out vec2 second) {
    float mean = 0.5 * (f.xx + f.yy);
    float radius = length(vec2(0.5 * (f.xx - f.yy), f.xy));
    float long_variance = mean + radius;
    float short_variance = f.det / long_variance;
    vec2 direction = f.xx > f.yy ? vec2(long_variance - f.yy, f.xy) : vec2(f.xy, long_variance - f.xx);
    float size = length(direction);
    direction = size > 0.0 ? direction / size : vec2(1.0, 0.0);
    // A little wider than exact: the fragment stage decides what is inside, the quad must only not be too small.
    float long_half = 1.001 * extent * sqrt(long_variance) / f.scale + 0.01;
    float short_half = 1.001 * extent * sqrt(short_variance) / f.scale + 0.01;
    first = long_half * direction;
    second = short_half * vec2(-direction.y, direction.x);
}

void main() {
    uint survivor = LINEAR_GROUP * SURVIVOR_GROUP_SIZE + gl_LocalInvocationIndex;
    if (survivor >= counts.at[0].visible + counts.at[0].cutoff) {
        return;
    }
    uint index = survivors.at[survivor].x;
    Gaussian gaussian = gaussians.at[index];
    Footprint f = footprint(gaussian);
    float opacity = gaussian.position_opacity.w;
    float extent = opacity_extent(opacity);

    Splat splat;
    vec2 first;
    vec2 second;
    vec2 middle = vec2(0.0);
    quad_axes(f, extent, first, second);
    if (max(largest(vec3(first, 0.0)), largest(vec3(second, 0.0))) > QUAD_MAX_EXTENT) {
        vec2 box = 1.001 * box_extent(f, extent) + 0.01;
        vec2 low = max(f.centre - box, vec2(-1.0));
        vec2 high = min(f.centre + box, FRAME.size.xy + 1.0);
        first = vec2(0.5 * (high.x - low.x), 0.0);
        second = vec2(0.0, 0.5 * (high.y - low.y));
        middle = 0.5 * (low + high) - f.centre;
    }
    splat.centre_axis = vec4(f.centre, first);
    splat.conic = vec4(cholesky(f), opacity);
    splat.colour_cut = vec4(colour(index, normalize(f.relative)), uintBitsToFloat(survivors.at[survivor].y));
    splat.middle_axis = vec4(middle, second);
    splats.at[survivor] = splat;
    // Positive floats order like their bits. Counted from the nearest depth that the scene's bounds allow they need
    // fewer of them, and fewer passes of the sort; dropping low bits never turns an order round.
    uint depth = max(floatBitsToUint(f.view.z), FRAME.key_near) - FRAME.key_near;
    keys.at[survivor] = min(depth, FRAME.key_span) >> FRAME.key_shift;
    order.at[survivor] = survivor;
}
