// The code that the two front ends of the splat pass share: the n-th splat from the back, and its corners.
#ifndef RARA_CORNERS
#define RARA_CORNERS
#include "frame.glsl"
#include "host_depth.glsl"
#include "cut.glsl"

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
