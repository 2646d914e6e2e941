// Buffer 0 of every shader holds constants, and behind them the scene's layers: of a frame, which begin with those of its cut,
// or, where OF_CUT is defined, of a cut alone, which knows no eye. They are used in place (CUT.scene.layer_count) and never
// copied, since a copy would load all of them.
#ifndef RARA_FRAME
#define RARA_FRAME
#include "types.glsl"
#include "buffers.glsl"

#ifdef OF_CUT
COMMON_BUFFER_OF(readonly, 0, cut, CutData constants; CutLayer layers[])
#define CUT cut.constants
#define CUT_LAYER(number) cut.layers[number]
#else
COMMON_BUFFER_OF(readonly, 0, frame, FrameData constants; LayerData layers[])
#define CUT frame.constants.cut
#define EYE frame.constants.eye
#define CUT_LAYER(number) frame.layers[number].cut
#define VIEW EYE.view

// True when lines of sight are parallel to the view axis, and have no eye.
bool is_orthographic() {
    return VIEW.projection == PROJECTION_ORTHOGRAPHIC;
}

uint tile_rows() {
    return EYE.tiles.tile_count / EYE.tiles.tile_columns;
}
#endif

#endif
