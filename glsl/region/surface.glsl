// The surfaces of the layers' regions, what the stages ask of one, and how their answers make the region's. A shape answers
// the questions in a file of its own. Twin: src/reference/region/surface.rs.
#ifndef RARA_REGION_SURFACE
#define RARA_REGION_SURFACE
#include "region/sides.glsl"
#include "layer.glsl"

// An includer may bind them elsewhere.
#ifndef SURFACES_BINDING
#define SURFACES_BINDING 1
#endif
BUFFER(readonly, SURFACES_BINDING, SurfaceData, surfaces)

// True when a region has parts or a surface that bends: without, there is no code for either.
layout(constant_id = 8) const bool COMBINED = false;

// True when a region has the inside of a mesh.
layout(constant_id = 15) const bool MESHES = false;

#include "region/plane.glsl"
#include "region/quadric.glsl"
#include "region/mesh.glsl"

// Returns the answer of the shape that a surface is. Each kind has a line here, which the build holds to the list of kinds in
// types.glsl, and a shape without the answer does not compile. `none` is never asked for: it stands where no surface bends.
#define RETURN_ANSWER(question, arguments, none) \
    switch (surfaces.at[surface].kind) { \
    case SURFACE_QUADRIC: \
        return COMBINED ? quadric_##question arguments : none; \
    case SURFACE_MESH: \
        return MESHES ? mesh_##question arguments : none; \
    default: /* SURFACE_PLANE */ \
        return plane_##question arguments; \
    }

// How far a point is from a surface, in the layer's units: positive where the surface keeps the point.
float surface_distance(uint surface, vec3 position) {
    RETURN_ANSWER(distance, (surface, position), 0.0)
}

// On which side of a surface a Gaussian is, whose band reaches the given number of standard deviations. A hard clip asks for
// the centre alone.
uint surface_gaussian_side(uint surface, mat3 axes, vec3 position, float deviations) {
    if (CUT.region.mode == MODE_HARD) {
        return surface_distance(surface, position) >= 0.0 ? SIDE_VISIBLE : SIDE_INVISIBLE;
    }
    if (CUT.region.trace_all != 0u) {
        return SIDE_CUTOFF;
    }
    RETURN_ANSWER(gaussian_side, (surface, axes, position, deviations), SIDE_CUTOFF)
}

// The same of a region that is a list: its surfaces are planes, of which none is clipped by its centre.
uint listed_gaussian_side(uint surface, mat3 axes, vec3 position, float deviations) {
    return CUT.region.trace_all != 0u ? SIDE_CUTOFF : plane_gaussian_side(surface, axes, position, deviations);
}

// On which side all Gaussians are whose centres lie in a box and that reach at most `support` from them, the layer's units.
uint surface_box_side(uint surface, vec3 middle, vec3 half_size, float support) {
    RETURN_ANSWER(box_side, (surface, middle, half_size, support), SIDE_CUTOFF)
}

// A surface in the unit space of a Gaussian that it cuts.
UnitSurface unit_surface(uint surface, mat3 axes, vec3 position) {
    RETURN_ANSWER(unit_surface, (surface, axes, position), plane_unit_surface(surface, axes, position))
}

// The half-space that a surface keeps of a Gaussian that it cuts, to first order about its centre: its normal in the
// Gaussian's unit space, and the centre's distance, the layer's units.
vec4 surface_half_space(uint surface, mat3 axes, vec3 position) {
    RETURN_ANSWER(half_space, (surface, axes, position), vec4(0.0))
}

// True where the region has parts, and is no list.
bool has_parts() {
    return COMBINED && LAYER.region.op == OP_PARTS;
}

// The answer of one surface that is the region's, whatever the others say: no intersection holds what one drops, and every
// union holds what one keeps.
uint side_that_decides() {
    return LAYER.region.op == OP_AND ? SIDE_INVISIBLE : SIDE_VISIBLE;
}

// The region's answer where no surface decides and none cuts.
uint side_undecided() {
    return LAYER.region.op == OP_AND ? SIDE_VISIBLE : SIDE_INVISIBLE;
}

// The region's answer after one more surface, from the answer by those before.
uint combined_side(uint side, uint one) {
    return side != side_that_decides() && (one == side_that_decides() || one == SIDE_CUTOFF) ? one : side;
}

#endif
