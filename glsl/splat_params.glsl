// The parameters of the splat pass and, with EXPECTED_DEPTH, of the pass that draws expected depths.
struct Params {
    vec2 origin; // where the viewport begins in the attachment, px
    vec2 principal_point; // of the camera, in the coordinates of gl_FragCoord, px
    float depth_offset; // what the host's depth buffer holds for a depth: see host_depth.glsl
    float depth_scale;
    float sigma; // the ellipsoid that mode `rara` traces, standard deviations
    uint cut_stride; // vec4s of a cutoff record
    float alpha_max; // the most that a splat covers of a pixel
#ifdef EXPECTED_DEPTH
    float unit; // what depths are multiplied by
#endif
};
#define PARAMS Params
