// The decision whether the pairs of tile and splat have room, and the commands that follow from it. Included after the buffer
// `counts` is declared.
#ifndef RARA_ROOM
#define RARA_ROOM

// Returns whether each tile has a list of its own. If not, coarse lists are written instead. One invocation decides for the frame.
bool decide_room(uint pairs) {
    bool has_room = pairs <= EYE.room.pair_capacity;
    uint strips = (tile_rows() + STRIP_ROWS - 1u) / STRIP_ROWS;
    uvec2 quads = (uvec2(EYE.tiles.tile_columns, tile_rows()) + QUAD_TILES - 1u) / QUAD_TILES;
    counts.at[0].pairs = pairs;
    counts.at[0].has_room = has_room ? 1u : 0u;
    counts.at[0].tile_groups = uvec4(STRIP_ROWS * EYE.tiles.tile_columns, strips, 1u, 0u);
    counts.at[0].composite = uvec4(6u * quads.x * quads.y, 1u, 0u, 0u);
    return has_room;
}

#endif
