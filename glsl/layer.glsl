// The layer that an invocation works on. Layers fill whole blocks, one after the other, so that a block's number says which
// layer it belongs to. A frame of one layer needs no search.
#ifndef RARA_LAYER
#define RARA_LAYER
#include "frame.glsl"

// True when the scene has several layers.
layout(constant_id = 9) const bool LAYERED = false;

// The number of the layer.
uint layer_number = 0u;

#define LAYER CUT_LAYER(layer_number)
#ifndef OF_CUT
#define LAYER_VIEW frame.layers[layer_number].view
#endif

// Makes LAYER that of a block.
void enter_layer_of_block(uint block) {
    if (LAYERED) {
        uint end = CUT.scene.layer_count;
        layer_number = 0u;
        while (end - layer_number > 1u) {
            uint middle = (layer_number + end) >> 1;
            if (CUT_LAYER(middle).content.first_block <= block) {
                layer_number = middle;
            } else {
                end = middle;
            }
        }
    }
}

// Gaussians of a block of this layer: all but a layer's last block are full.
uint block_length(uint block) {
    return min(LAYER.content.gaussian_end - block * BLOCK_SIZE, BLOCK_SIZE);
}

// A Gaussian's opacity in this layer.
float opacity_in_layer(Gaussian gaussian) {
    return gaussian.position_opacity.w * LAYER.content.opacity;
}

#endif
