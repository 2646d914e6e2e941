// The part of a splat's weight that the rasteriser carries: see cut.glsl. Included after the buffer `cut_records` is
// declared.
#ifndef RARA_CARRIED
#define RARA_CARRIED
#include "bin.glsl"
#include "quad.glsl"

Carried whole_weight() {
    return Carried(vec3(Z_WHOLE, 0.0, 0.0), vec3(0.0));
}

Carried carried_weight(uint cut) {
    Carried weight = whole_weight();
    if (cut != NOT_CUT) {
        uint base = cut * FRAME.weight.cut_stride;
        if (cut_records.at[base].w == float(1u << CUT_COUNT_SHIFT)) {
            weight.linear = cut_records.at[base + CUT_HEADER].xyz;
            weight.curvature = cut_records.at[base + CUT_HEADER + 1u].xyz;
        } else {
            weight.linear = vec3(Z_RECORD, float(cut & 0xffffu), float(cut >> 16));
        }
    }
    return weight;
}

// The line beyond which a splat is cut away: by its curve where a record holds one, else the given line.
vec3 cut_away_line_of_record(vec3 line, uint cut, Carried weight, vec3 conic, float extent) {
    uint base = cut * FRAME.weight.cut_stride;
    vec4 linear = cut_records.at[base];
    if (weight.linear.x >= -Z_RANGE || (to_uint(linear.w) & CUT_CURVE) == 0u) {
        return line;
    }
    return cut_away_line_of_curve(linear, cut_records.at[base + 1u], cut_records.at[base + 2u], cut_records.at[base + CUT_HEADER], conic, 1.001 * extent);
}

#endif
