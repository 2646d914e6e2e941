// A region as one Gaussian sees it: the surfaces that cut it, and how they combine once all others are decided. A part of
// the region is a word on a stack: 0 or 1 where it is decided, else 2 and the number of its first surface in the record,
// which ends with the part's last one. Included after the buffer `cut_records` is declared. Twin:
// src/reference/region/reduced.rs.
#ifndef RARA_REGION_REDUCED
#define RARA_REGION_REDUCED
#include "cut.glsl"
#include "footprint.glsl"
#include "region/answers.glsl"
#include "region/gaussian_side.glsl"

// Regions of 65536 surfaces need no more than 17.
const uint PART_DEPTH = 18u;

shared uint parts[COMBINED ? PART_DEPTH * SURVIVOR_GROUP_SIZE : 1u];
shared uint entry_joins[COMBINED ? MAX_CUTTING * SURVIVOR_GROUP_SIZE : 1u];

// The part that two parts make. `entries` is how many surfaces the record has so far.
uint joined(uint below, uint top, bool is_or, uint first_entry, inout uint entries) {
    bool below_decided = below < 2u;
    if (below_decided || top < 2u) {
        uint decided = below_decided ? below : top;
        uint rest = below_decided ? top : below;
        if (decided == (is_or ? 0u : 1u)) {
            return rest;
        }
        // The other part has no say, and its surfaces leave the record.
        if (rest >= 2u) {
            entries = rest - 2u;
        }
        return decided;
    }
    uint last = first_entry + entries - 1u;
    uint joins = entry_joins[last];
    uint count = join_count(joins);
    entry_joins[last] = joins + 1u + (is_or ? 1u << (JOIN_SHIFT + count) : 0u);
    return below;
}

// About how far a surface that cuts a Gaussian is from its centre, in standard deviations.
float nearness(UnitSurface s) {
    float slope = length(s.half_space.xyz) + sqrt(abs(s.half_space.w) * bend_norm(s));
    return min(abs(s.half_space.w) / max(slope, 1e-30), 1e29);
}

// The distance of the last of the MAX_CUTTING nearest surfaces, and how many at that distance are among them.
float farthest_counted(Footprint f, vec3 position, float deviations, out uint room) {
    float farthest = -1.0;
    room = MAX_CUTTING;
    while (true) {
        float next = 1e30;
        uint ties = 0u;
        for (uint i = 0u; i < LAYER.region.surface_count; i++) {
            uint surface = LAYER.region.first_surface + i;
            if (surface_gaussian_side(surface, f.axes, position, deviations) == SIDE_CUTOFF) {
                float here = nearness(unit_surface(surface, f.axes, position));
                ties = here > farthest && here < next ? 1u : here == next ? ties + 1u : ties;
                next = here > farthest ? min(next, here) : next;
            }
        }
        if (ties == 0u || ties >= room) {
            return next;
        }
        room -= ties;
        farthest = next;
    }
}

// Writes the surfaces that cut a Gaussian behind its record's header. Returns 0 or 1 where nothing or all is kept, whatever
// the pixel, else 2.
uint write_reduced(uint base, Footprint f, vec3 position, float deviations, out uint entries) {
    uint first_part = gl_LocalInvocationIndex * PART_DEPTH;
    uint first_entry = gl_LocalInvocationIndex * MAX_CUTTING;
    float farthest = 1e30;
    bool is_again = false;
    uint room = 0u;
    uint cutting = 0u;
    uint depth = 0u;
    entries = 0u;
    for (uint i = 0u; i <= LAYER.region.surface_count; i++) {
        if (i == LAYER.region.surface_count) {
            if (cutting <= MAX_CUTTING || is_again) {
                break;
            }
            // There are more than have room, so all is done again for the nearest.
            is_again = true;
            farthest = farthest_counted(f, position, deviations, room);
            depth = 0u;
            entries = 0u;
            i = 0u;
        }
        uint surface = LAYER.region.first_surface + i;
        uint side = surface_gaussian_side(surface, f.axes, position, deviations);
        uint part = side == SIDE_VISIBLE ? 1u : 0u;
        if (side == SIDE_CUTOFF) {
            cutting++;
            UnitSurface s = unit_surface(surface, f.axes, position);
            part = s.half_space.w >= 0.0 ? 1u : 0u;
            float here = nearness(s);
            bool counts = !is_again || here < farthest || (here == farthest && room > 0u);
            room -= is_again && here == farthest && room > 0u ? 1u : 0u;
            if (counts && entries < MAX_CUTTING) {
                float size = max(largest(s.half_space.xyz), max(largest(s.diagonal), largest(s.across)));
                float inverse = size > 0.0 ? 1.0 / size : 1.0;
                uint at = base + CUT_HEADER + ENTRY_VECTORS * entries;
                cut_records.at[at] = s.half_space * inverse;
                cut_records.at[at + 1u] = vec4(s.diagonal * inverse, 0.0);
                cut_records.at[at + 2u] = vec4(s.across * inverse, 0.0);
                entry_joins[first_entry + entries] = 0u;
                part = 2u + entries++;
            }
        }
        parts[first_part + depth++] = part;
        uint joins = surfaces.at[surface].joins;
        for (uint j = 0u; j < join_count(joins); j++) {
            depth--;
            uint top = parts[first_part + depth];
            uint below = parts[first_part + depth - 1u];
            parts[first_part + depth - 1u] = joined(below, top, joins_by_or(joins, j), first_entry, entries);
        }
    }
    for (uint i = 0u; i < entries; i++) {
        cut_records.at[base + CUT_HEADER + ENTRY_VECTORS * i + 1u].w = float(entry_joins[first_entry + i]);
    }
    return min(parts[first_part], 2u);
}

#endif
