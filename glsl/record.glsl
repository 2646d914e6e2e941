// A cut splat's record (cut.glsl) as tiles read it. Included after the buffer `cut_records` and the parameter cut_stride are declared.
#ifndef RARA_RECORD
#define RARA_RECORD
#include "cut.glsl"

#ifdef RARA_SUBGROUP

// Where the record is, and its first vec4s, which suffice for one surface: an invocation loads them once for all.
struct Record {
    uint base;
    vec4 begin[TERMS_VECTORS]; // beyond the first CUT_HEADER + 1 only those of a surface's terms
    RecordSides sides;
    TileSurfaces surfaces;
};
#define RECORD_AT(record, i) record.begin[i]

uint record_base(Record record) {
    return record.base;
}

// The record that a splat's carried slopes name, if they name one.
Record record_of(vec3 linear) {
    Record record;
    record.sides = all_cutting();
    record.surfaces.answers = 0u;
    if (linear.x < -Z_RANGE) {
        record.base = record_number(linear.x) * push.params.cut_stride;
        for (uint i = 0u; i <= CUT_HEADER; i++) {
            record.begin[i] = cut_records.at[record.base + i];
        }
        if (COMBINED && (to_uint(record.begin[0].w) & CUT_TERMS) != 0u) {
            for (uint i = CUT_HEADER + 1u; i < TERMS_VECTORS; i++) {
                record.begin[i] = cut_records.at[record.base + i];
            }
        }
    }
    return record;
}

#else

// On GPUs each pixel reads the record itself: it would take too many registers.
struct Record {
    vec3 linear;
};
#define RECORD_AT(record, i) cut_records.at[record_base(record) + i]

uint record_base(Record record) {
    return record_number(record.linear.x) * push.params.cut_stride;
}

Record record_of(vec3 linear) {
    return Record(linear);
}

#endif

// The polynomials of a record that holds a surface's terms.
TermCurves record_terms(Record record) {
    vec4 at[TERMS_VECTORS];
    for (uint i = 0u; i < TERMS_VECTORS; i++) {
        at[i] = RECORD_AT(record, i);
    }
    return terms_of(at);
}

uint record_flags(Record record) {
    return to_uint(RECORD_AT(record, 0).w);
}

RecordSides record_sides(Record record) {
#ifdef RARA_SUBGROUP
    return record.sides;
#else
    return all_cutting();
#endif
}

TileSurfaces record_surfaces(Record record) {
    TileSurfaces surfaces;
#ifdef RARA_SUBGROUP
    surfaces = record.surfaces;
#else
    surfaces.answers = 0u;
#endif
    return surfaces;
}

#endif
