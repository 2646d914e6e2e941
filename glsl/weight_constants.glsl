// The settings that the weight of cut splats depends on are constants of the pipeline, so that it holds only the code that
// its mode needs.
#ifndef RARA_WEIGHT_CONSTANTS
#define RARA_WEIGHT_CONSTANTS
#include "types.glsl"

layout(constant_id = 0) const uint CLIP_MODE = MODE_NONE; // MODE_*
layout(constant_id = 1) const bool SEVERAL = false; // whether a splat may be cut by more than one surface
layout(constant_id = 12) const bool COMBINED = false; // whether it may be cut by surfaces that bend, or that combine by operators
layout(constant_id = 15) const bool MESHES = false; // whether the faces of a mesh may cut it
layout(constant_id = 16) const bool MANY = false; // whether more than RECORD_SURFACES may cut it
layout(constant_id = 2) const uint DECAY = DECAY_DEPTH; // DECAY_*
layout(constant_id = 3) const uint MISS = MISS_PEAK; // MISS_*
layout(constant_id = 4) const uint PHI_FORM = PHI_QUINTIC; // PHI_*: which approximation of Phi

#endif
