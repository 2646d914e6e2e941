// The decision whether the pairs of tile and splat have room, and the commands that follow from it. Included after the buffer
// `counts` is declared.
#ifndef RARA_ROOM
#define RARA_ROOM

// Returns whether tiles draw the splats. If not, the frame's quads are drawn instead. One invocation decides for the frame.
bool decide_room(uint pairs) {
    bool tiled = pairs <= EYE.room.pair_capacity;
    uint strips = (tile_rows() + STRIP_ROWS - 1u) / STRIP_ROWS;
    uvec2 quads = (uvec2(EYE.tiles.tile_columns, tile_rows()) + QUAD_TILES - 1u) / QUAD_TILES;
    counts.at[0].pairs = pairs;
    counts.at[0].tiled = tiled ? 1u : 0u;
    counts.at[0].tile_groups = uvec4(tiled ? STRIP_ROWS * EYE.tiles.tile_columns : 0u, strips, 1u, 0u);
    counts.at[0].composite = uvec4(6u * quads.x * quads.y, tiled ? 1u : 0u, 0u, 0u);
    if (tiled || EYE.room.redrawn != 0u) {
        counts.at[0].draw.y = 0u;
    }
    return tiled;
}

#endif
