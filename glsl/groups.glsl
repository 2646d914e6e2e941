// Indirect dispatches.
#ifndef RARA_GROUPS
#define RARA_GROUPS
#include "types.glsl"

// Workgroups for `count` items, folded into rows when there are more than a row holds; w is the count.
uvec4 groups(uint count, uint size) {
    uint needed = (count + size - 1u) / size;
    return uvec4(min(needed, GROUP_COLUMNS), (needed + GROUP_COLUMNS - 1u) / GROUP_COLUMNS, 1u, count);
}

#endif
