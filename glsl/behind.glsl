// Behind the pixels of the tiles' picture lie further words of each pixel: the parts that a frame has, one after the other.
#ifndef RARA_BEHIND
#define RARA_BEHIND

layout(constant_id = 17) const bool EXPECTED_DEPTH = false; // the sum of the splats' depths, each times what it adds to the alpha, and that alpha
layout(constant_id = 18) const bool WRITTEN_DEPTH = false; // the depth for the host's depth buffer
layout(constant_id = 19) const bool STRONGEST = false; // the number of the splat that adds most to the alpha

// Words behind the pixels, for each pixel, where a part begins.
const uint EXPECTED_WORDS = 0u;
const uint WRITTEN_WORDS = EXPECTED_DEPTH ? 2u : 0u;
const uint STRONGEST_WORDS = WRITTEN_WORDS + (WRITTEN_DEPTH ? 1u : 0u);

// The strongest splat of a pixel that has none.
const uint NO_SPLAT = ~0u;

#endif
