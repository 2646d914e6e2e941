// What a block's bounds leave open of its layer's region, written as the block's shortlist.
#ifndef RARA_REGION_BLOCK_SHORTLIST
#define RARA_REGION_BLOCK_SHORTLIST
#include "block.glsl"

#define HAS_PARTS SHORTLISTED
#include "region/parts.glsl"

// The place of the shortlist that is written.
uint written_shortlist;

uint listed_operators(uint entry) {
    return shortlists.at[written_shortlist + 2u + 2u * entry];
}

void list_operators(uint entry, uint operators) {
    shortlists.at[written_shortlist + 2u + 2u * entry] = operators;
}

void write_shortlist(uint block, Block bounds) {
    vec3 middle = block_middle(bounds);
    vec3 half_size = block_half(bounds);
    float support = SHORTLIST_WIDENING * block_support(bounds, 1.0);
    written_shortlist = block * SHORTLIST_WORDS;
    uint first_part = gl_LocalInvocationIndex * PART_DEPTH;
    uint depth = 0u;
    uint entries = 0u;
    bool has_room = !cuts_all();
    parts[first_part] = side_undecided() == SIDE_VISIBLE ? 1u : 0u;
    for (uint i = 0u; i < LAYER.region.surface_count && has_room; i++) {
        uint surface = LAYER.region.first_surface + i;
        uint side = surface_box_side(surface, middle, half_size, support);
        uint part = side == SIDE_VISIBLE ? 1u : 0u;
        if (side == SIDE_CUTOFF) {
            has_room = entries < SHORTLIST_SURFACES;
            if (has_room) {
                shortlists.at[written_shortlist + 1u + 2u * entries] = surface;
                list_operators(entries, 0u);
                part = 2u + entries++;
            }
        }
        push_part(part, surfaces.at[surface].operators, first_part, depth, entries);
    }
    uint side = parts[first_part] == 0u ? SIDE_INVISIBLE : parts[first_part] == 1u ? SIDE_VISIBLE : SIDE_CUTOFF;
    shortlists.at[written_shortlist] = has_room ? entries << 2 | side : ALL_SURFACES;
}

#endif
