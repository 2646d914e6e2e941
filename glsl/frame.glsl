// Buffer 0 of every shader: what is constant in the frame. Used in place (FRAME.view.size), never copied: a copy would load
// all planes, and index them in registers.
#ifndef RARA_FRAME
#define RARA_FRAME
#include "types.glsl"
#include "buffers.glsl"

BUFFER(readonly, 0, FrameData, frame)
#define FRAME frame.at[0]

uint tile_rows() {
    return FRAME.tiles.tile_count / FRAME.tiles.tile_columns;
}

#endif
