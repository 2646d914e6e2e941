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
            // Without a strip it is open everywhere.
            bool has_strip = (to_uint(cut_records.at[base].w) & CUT_STRIP) != 0u;
            vec4 strip = has_strip ? cut_records.at[base + FRAME.weight.cut_stride - 1u] : vec4(0.0, 0.0, 1.0, -1.0);
            weight.linear = vec3(uintBitsToFloat(Z_RECORD + cut), strip.xy);
            weight.curvature = vec3(strip.zw, 0.0);
        }
    }
    return weight;
}

#endif
