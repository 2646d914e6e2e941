// The part of a splat's weight that the rasteriser carries: see cut.glsl. Included after the buffer `cut_records` is
// declared, and the buffer `counts`.
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
        uint record = cut;
        uint base = record * EYE.weight.cut_stride;
        uint flags = to_uint(cut_records.at[base].w);
        if ((flags & CUT_LONG) != 0u) {
            flags &= ~CUT_LONG;
            if (counts.at[0].long_strides <= EYE.weight.long_strides) {
                record = record_number(cut_records.at[base + EYE.weight.cut_stride - 1u].x);
                base = record * EYE.weight.cut_stride;
                flags = to_uint(cut_records.at[base].w);
            }
        }
        if (flags == 1u << CUT_COUNT_SHIFT) {
            weight.linear = cut_records.at[base + CUT_HEADER].xyz;
            weight.curvature = cut_records.at[base + CUT_HEADER + 1u].xyz;
        } else {
            // Without a strip it is open everywhere.
            bool has_strip = (flags & CUT_STRIP) != 0u;
            vec4 strip = has_strip ? cut_records.at[base + EYE.weight.cut_stride - 1u] : vec4(0.0, 0.0, 1.0, -1.0);
            weight.linear = vec3(uintBitsToFloat(Z_RECORD + record), strip.xy);
            weight.curvature = vec3(strip.zw, 0.0);
        }
    }
    return weight;
}

#endif
