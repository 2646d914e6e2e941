// The entries of the combined record that is being written (cut.glsl). Included after the buffer `cut_records` is declared.
#ifndef RARA_REGION_WRITTEN
#define RARA_REGION_WRITTEN
#include "region/entry.glsl"

// The place of the record that is written.
uint written_record;

uint listed_operators(uint entry) {
    return operators_of(written_record, entry);
}

void list_operators(uint entry, uint operators) {
    cut_records.at[written_record + CUT_HEADER + ENTRY_VECTORS * entry + 1u].w = float(operators);
}

void write_entry(uint entry, UnitSurface s, uint operators) {
    uint at = written_record + CUT_HEADER + ENTRY_VECTORS * entry;
    cut_records.at[at] = s.half_space;
    cut_records.at[at + 1u] = vec4(s.diagonal, float(operators));
    cut_records.at[at + 2u] = vec4(s.across, 0.0);
}

#endif
