// The value that the host's depth buffer holds for a splat: the host's depth_offset plus its depth_scale over the
// splat's depth, or, of an orthographic camera, less its depth_scale times that. Splats before the buffer's nearest depth or beyond its farthest one are still drawn.
#ifndef RARA_HOST_DEPTH
#define RARA_HOST_DEPTH
#include "frame.glsl"

// The depth of a pixel that has none.
const float NO_DEPTH = 3e38;

float host_depth(float z) {
    precise float falling = is_orthographic() ? -push.params.depth_scale * z : push.params.depth_scale / z;
    precise float depth = push.params.depth_offset + falling;
    return clamp(depth, 0.0, 1.0);
}

#endif
