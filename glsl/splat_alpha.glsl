// Alpha of a splat in a pixel, from its conic and, for cut splats only, the clip's weight; 0 where the splat does not count.
// `weight` is that weight, WEIGHT_WHOLE for a splat that is not cut. Included after weight.glsl.
#ifndef RARA_SPLAT_ALPHA
#define RARA_SPLAT_ALPHA
#include "weight_colour.glsl"

float splat_alpha(vec4 centre_conic, vec4 conic_cut, float slope, vec3 curvature, out float weight) {
    weight = WEIGHT_WHOLE;
    vec2 delta = gl_FragCoord.xy - centre_conic.xy;
    float u = centre_conic.z * delta.x;
    float v = centre_conic.w * delta.x + conic_cut.x * delta.y;
    float alpha = min(push.params.alpha_max, conic_cut.y * exp(-0.5 * (u * u + v * v)));
    // Thresholds are on the unclipped alpha, so that thin layers do not vanish when they are cut.
    if (!(alpha >= ALPHA_MIN)) {
        return 0.0;
    }
    if (CLIP_MODE >= MODE_RARA && conic_cut.z < Z_RANGE) {
        vec3 linear = vec3(conic_cut.zw, slope);
        if (CLIP_MODE == MODE_EXACT && linear.x > -Z_RANGE) {
            float z = linear.x + delta.x * (linear.y + curvature.x * delta.x + curvature.y * delta.y)
                + delta.y * (linear.z + curvature.z * delta.y);
            weight = phi(z);
        } else {
            weight = cut_weight(record_number(linear.x), delta, vec2(u, v), gl_FragCoord.xy);
        }
        alpha = decayed(alpha, weight);
    }
    return alpha;
}

#endif
