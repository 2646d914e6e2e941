// How much larger quads are than what they have to cover.
#ifndef RARA_WIDENED
#define RARA_WIDENED

// A little wider than exact: the fragment stage decides what is inside, and the quad must only not be too small.
// Rasterisers may move its corners by half of the least precision that Vulkan allows them, 1/32 px.
float widened(float half_side) {
    return 1.001 * half_side + 0.04;
}

#endif
