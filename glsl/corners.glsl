// The code that the two front ends of the splat pass share: the n-th splat from the back, and its corners.
#ifndef RARA_CORNERS
#define RARA_CORNERS
#include "frame.glsl"
#include "host_depth.glsl"
#include "cut.glsl"
#include "extent.glsl"
#include "widened.glsl"

BUFFER(readonly, 1, FrameCounts, counts)
BUFFER(readonly, 2, vec4, splats)
BUFFER(readonly, 3, uint, order)
BUFFER(readonly, 5, Quad, quads)
#include "splat_at.glsl"

// Splats are drawn back to front: the blend is the ordinary `over`, so that a host can draw them onto what it has drawn.
uint splat_index_at(uint number) {
    return order.at[counts.at[0].mesh_groups.w - 1u - number];
}

// True when splats have a depth in the host's buffer.
layout(constant_id = 5) const bool DEPTH = false;

// True where nobody has found the quads: those of tiles whose lists had no room.
layout(constant_id = 7) const bool BOXES = false;

// The box around a splat's contour, as far as it is in the picture. It covers more pixels than the quad: of most of them the
// fragment stage finds nothing, and next to nothing (TRIM_DEVIATIONS) of those behind a cut.
Quad box(Splat splat) {
    if (splat.conic_cut.z == Z_CUT_AWAY) {
        return Quad(vec2(0.0), vec2(0.0), vec2(0.0));
    }
    vec2 centre = splat.centre_conic.xy;
    vec3 conic = vec3(splat.centre_conic.zw, splat.conic_cut.x);
    float extent = opacity_extent(splat.conic_cut.y);
    // By the ratio, since the square of what is left of a huge splat's conic is 0.
    vec2 half_sides = extent * vec2(1.0 / conic.x, length(vec2(1.0, conic.y / conic.x)) / conic.z);
    vec2 low = max(centre - vec2(widened(half_sides.x), widened(half_sides.y)), vec2(0.0));
    vec2 high = max(low, min(centre + vec2(widened(half_sides.x), widened(half_sides.y)), VIEW.size.xy));
    // Corners are sums with the centre, which far outside the picture is known to a few units in its last place.
    vec2 half_size = 0.5 * (high - low) + 1.0 + 1e-6 * abs(centre);
    return Quad(0.5 * (low + high) - centre, vec2(half_size.x, 0.0), vec2(0.0, half_size.y));
}

Quad quad_of(uint splat_index, Splat splat) {
    return BOXES ? box(splat) : quads.at[splat_index];
}

// Corner 0 to 3 of a strip.
vec4 corner(Splat splat, Quad quad, uint number) {
    float first = (number & 1u) == 0u ? -1.0 : 1.0;
    float second = (number & 2u) == 0u ? -1.0 : 1.0;
    vec2 at = splat.centre_conic.xy + quad.middle + first * quad.first + second * quad.second;
    return vec4(2.0 * at * VIEW.size.zw - 1.0, DEPTH ? host_depth(splat.curvature_depth.w) : 0.0, 1.0);
}

// The centre in the coordinates of gl_FragCoord, and k0 k1.
vec4 fragment_centre(Splat splat) {
    return vec4(splat.centre_conic.xy + push.params.origin, splat.centre_conic.zw);
}

#endif
