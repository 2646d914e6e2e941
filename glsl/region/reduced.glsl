// A region as one Gaussian sees it: the surfaces that cut it, and how they combine once all others are decided. Included
// after the buffer `cut_records` is declared. Twin: src/reference/region/reduced.rs.
#ifndef RARA_REGION_REDUCED
#define RARA_REGION_REDUCED
#include "cut.glsl"
#include "footprint.glsl"
#include "region/gaussian_side.glsl"

#define HAS_PARTS COMBINED
#define PART_ENTRIES MAX_CUTTING
#include "region/parts.glsl"

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
        for (uint i = 0u; i < surface_count(); i++) {
            uint surface = surface_at(i);
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
    for (uint i = 0u; i <= surface_count(); i++) {
        if (i == surface_count()) {
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
        uint surface = surface_at(i);
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
                entry_operators[first_entry + entries] = 0u;
                part = 2u + entries++;
            }
        }
        push_part(part, operators_at(i), first_part, first_entry, depth, entries);
    }
    for (uint i = 0u; i < entries; i++) {
        cut_records.at[base + CUT_HEADER + ENTRY_VECTORS * i + 1u].w = float(entry_operators[first_entry + i]);
    }
    return min(parts[first_part], 2u);
}

#endif
