// How splats lie in the buffer `splats`, which whoever includes this declares as vec4s. For CPU drivers each is 64 bytes, a cache
// line. Pipelines for GPUs have the 48 bytes of all splats that every tile reads first, then the curvatures, of which only those
// of cut splats are written and read, and then the depths, four in the place of one.
#ifndef RARA_SPLATS
#define RARA_SPLATS
#include "frame.glsl"
#include "cut.glsl"

// True where the parts lie apart.
bool splats_lie_apart() {
    return EYE.order.sort_runs == 0u;
}

uint splat_place(uint splat) {
    return splat * (splats_lie_apart() ? 3u : 4u);
}

uint curvature_place(uint splat) {
    return splats_lie_apart() ? 3u * CUT.scene.gaussian_count + splat : 4u * splat + 3u;
}

uvec2 depth_place(uint splat) {
    return splats_lie_apart() ? uvec2(4u * CUT.scene.gaussian_count + splat / 4u, splat % 4u) : uvec2(4u * splat + 3u, 3u);
}

uint mean_depth_place(uint splat) {
    uint count = CUT.scene.gaussian_count;
    return 4u * count + (count + 3u) / 4u + 3u * splat;
}

#define SPLAT_CENTRE(splat) splats.at[splat_place(splat)]
#define SPLAT_CONIC(splat) splats.at[splat_place(splat) + 1u]
#define SPLAT_COLOUR(splat) splats.at[splat_place(splat) + 2u]
#define SPLAT_CURVATURE(splat) splats.at[curvature_place(splat)]
#define SPLAT_DEPTH(splat) splats.at[depth_place(splat).x][depth_place(splat).y]
#define SPLAT_MEAN_DEPTH(splat) splats.at[mean_depth_place(splat)]
#define SPLAT_FAR_BOUND(splat) splats.at[mean_depth_place(splat) + 1u]
#define SPLAT_NEAR_BOUND(splat) splats.at[mean_depth_place(splat) + 2u]

// A splat's curvature; nothing where it is whole.
#define CARRIED_CURVATURE(splat, conic_cut) ((conic_cut).z < Z_RANGE ? SPLAT_CURVATURE(splat).xyz : vec3(0.0))

#endif
