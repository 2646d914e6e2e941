// One declaration for a storage buffer, two ways to reach it. A shader says
//     BUFFER(readonly, 0, Gaussian, gaussians)
// and uses gaussians.at[i]. By default the buffer is reached through its device address in the push constants: fast,
// and not bound by the device's limit on binding sizes (128 MiB on lavapipe). With RARA_BOUND it is a bound storage
// buffer, which the validation layer's synchronisation checks can watch. The access qualifier is the pass's only
// declaration of what it does to the buffer: build.rs reads it from the SPIR-V, the recorder derives barriers from it.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(push_constant, std430) uniform Push {
    uvec2 address[10];
    uint param[12];
} push;

#ifdef RARA_BOUND
#define BUFFER(access, index, Type, name) \
    layout(set = 0, binding = index, std430) access buffer name##Block { Type at[]; } name;
#else
#define BUFFER(access, index, Type, name) \
    layout(buffer_reference, std430, buffer_reference_align = 16) access buffer name##Block { Type at[]; }; \
    name##Block name = name##Block(push.address[index]);
#endif

// The number of this workgroup when a dispatch is folded into rows.
#define LINEAR_GROUP (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x)
