// The surfaces of a combined record (cut.glsl). Included after the buffer `cut_records` is declared.
#ifndef RARA_REGION_ENTRY
#define RARA_REGION_ENTRY
#include "cut.glsl"
#include "region/unit_surface.glsl"

UnitSurface entry_of(uint base, uint entry) {
    uint at = base + CUT_HEADER + ENTRY_VECTORS * entry;
    return UnitSurface(cut_records.at[at], cut_records.at[at + 1u].xyz, cut_records.at[at + 2u].xyz);
}

uint operators_of(uint base, uint entry) {
    return to_uint(cut_records.at[base + CUT_HEADER + ENTRY_VECTORS * entry + 1u].w);
}

#endif
