// Buffer 0 of every shader: what is constant in the frame, and behind it the layers, as many as the scene has. Used in place
// (FRAME.view.size), never copied: a copy would load all of it.
#ifndef RARA_FRAME
#define RARA_FRAME
#include "types.glsl"
#include "buffers.glsl"

BUFFER_OF(readonly, 0, frame, FrameData constants; LayerData layers[])
#define FRAME frame.constants

uint tile_rows() {
    return FRAME.tiles.tile_count / FRAME.tiles.tile_columns;
}

#endif
