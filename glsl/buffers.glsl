// A shader's declarations to its host, by name. A buffer is declared as in
//     BUFFER(readonly, 0, Gaussian, gaussians)
// and used as gaussians.at[i]. By default the buffer is reached through its device address in the push constants: fast,
// and not bound by the device's limit on binding sizes (128 MiB on lavapipe). With RARA_BOUND it is a bound storage
// buffer, which the validation layer's synchronisation checks can watch. The access qualifier is the pass's only
// declaration of what it does to the buffer: the recorder derives barriers from it.
//
// RARA_MIXED is for CPU drivers. They load what all lanes share once from a bound buffer, and inside branches for each
// lane from an address. But what differs between lanes they load from a bound buffer by a branch for each lane and
// component: with bound buffers alone, lavapipe takes up to ten times as long to compile a shader. So a buffer that
// COMMON_BUFFER_OF declares, because all lanes read the same of it, is bound, and the others are reached by address.
//
// A shader that has parameters declares a struct before it includes anything, and names it, as in
//     struct Params { uint pass; };
//     #define PARAMS Params
// and uses push.params.pass. Numbers in which pipelines differ are specialisation constants with names.
//
// build.rs reads all three from the SPIR-V and makes Rust structs of them (src/codegen), so that a pass that leaves
// one out or gives it another type does not compile.
#ifndef RARA_BUFFERS
#define RARA_BUFFERS
#include "limits.glsl"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#define BOUND_BUFFER_OF(access, index, name, members) \
    layout(set = 0, binding = index, std430) access buffer name##Block { members; } name;

#ifdef RARA_BOUND
#ifdef PARAMS
layout(push_constant, std430) uniform Push {
    PARAMS params;
} push;
#endif
#define BUFFER_OF BOUND_BUFFER_OF
#else
layout(push_constant, std430) uniform Push {
    uvec2 address[MAX_BUFFERS];
#ifdef PARAMS
    PARAMS params;
#endif
} push;
#define BUFFER_OF(access, index, name, members) \
    layout(buffer_reference, std430, buffer_reference_align = 16) access buffer name##Block { members; }; \
    name##Block name = name##Block(push.address[index]);
#endif
#ifdef RARA_MIXED
#define COMMON_BUFFER_OF BOUND_BUFFER_OF
#else
#define COMMON_BUFFER_OF BUFFER_OF
#endif
#define BUFFER(access, index, Type, name) BUFFER_OF(access, index, name, Type at[])

// The number of this workgroup when a dispatch is folded into rows.
#define LINEAR_GROUP (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x)

#endif
