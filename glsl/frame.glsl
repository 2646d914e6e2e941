// Buffer 0 of every shader holds what is constant in the frame, and behind it the scene's layers. It is used in place
// (FRAME.scene.layer_count) and never copied, since a copy would load all of it.
#ifndef RARA_FRAME
#define RARA_FRAME
#include "types.glsl"
#include "buffers.glsl"

COMMON_BUFFER_OF(readonly, 0, frame, FrameData constants; LayerData layers[])
#define FRAME frame.constants
// The eye whose picture is computed.
#define EYE 0
#define VIEW FRAME.views[EYE]

// True when lines of sight are parallel to the view axis, and have no eye.
bool is_orthographic() {
    return VIEW.projection == PROJECTION_ORTHOGRAPHIC;
}

uint tile_rows() {
    return FRAME.tiles.tile_count / FRAME.tiles.tile_columns;
}

#endif
