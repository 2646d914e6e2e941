// Buffer 1 of every shader that looks at Gaussians: GAUSSIAN_WORDS floats each, as src/passes/scene_buffers.rs packs
// them: centre, opacity, the three standard deviations, the rotation's x y z w. Not a struct, whose vec4s would be
// padded to 48 bytes.
#ifndef RARA_GAUSSIAN
#define RARA_GAUSSIAN
#include "footprint.glsl"

BUFFER(readonly, 1, float, gaussians)

vec3 three_floats(uint at) {
    return vec3(gaussians.at[at], gaussians.at[at + 1u], gaussians.at[at + 2u]);
}

vec4 four_floats(uint at) {
    return vec4(three_floats(at), gaussians.at[at + 3u]);
}

// Centre and opacity alone: enough to tell that most of what is out of view is.
vec4 position_opacity(uint index) {
    return four_floats(index * GAUSSIAN_WORDS);
}

Gaussian load_gaussian(uint index) {
    uint at = index * GAUSSIAN_WORDS;
    return Gaussian(four_floats(at), three_floats(at + 4u), four_floats(at + 7u));
}

#endif
