// A batch of a tile's splats is loaded at once: each invocation loads one, hands it over, and all see them in turn. Included by
// tiles.glsl, which declares what is handed over.
#ifndef RARA_TILE_BATCH
#define RARA_TILE_BATCH

#ifdef RARA_SUBGROUP

#define BATCH gl_SubgroupSize
#define IN_BATCH gl_SubgroupInvocationID
#define OF(invocation, value) subgroupShuffle(value, invocation)
// Code for whole splats alone needs fewer registers and masks than the code that weighs.
const bool WHOLE_ALONE = CLIP_MODE >= MODE_RARA;

// A vote: drivers for CPUs ask one invocation after the other, but shuffle with an instruction.
bool all_of(bool agrees) {
    uint against = agrees ? 0u : 1u;
    for (uint apart = gl_SubgroupSize / 2u; apart > 0u; apart /= 2u) {
        against |= OF(gl_SubgroupInvocationID ^ apart, against);
    }
    return against == 0u;
}

// Splats lie apart in memory. An invocation asks for those of several batches together, so as to wait for all of them at once: by
// a float of each, which brings the rest of it into the cache.
const uint AHEAD = 8u;
uint ahead[AHEAD];
float ahead_x[AHEAD];

// The invocation's splat of a batch, and its centre's x.
uint number_in_batch(uint begin, uint first, uint end, out float x) {
    uint batch = (first - begin) / BATCH % AHEAD;
    if (batch == 0u) {
        for (uint k = 0u; k < AHEAD; k++) {
            ahead[k] = tile_splats.at[min(first + k * BATCH + IN_BATCH, end - 1u)];
        }
        for (uint k = 0u; k < AHEAD; k++) {
            ahead_x[k] = SPLAT_CENTRE(ahead[k]).x;
        }
    }
    x = ahead_x[batch];
    return ahead[batch];
}

Seen mine;
Record mine_record;

void hand_over(Seen splat, Record record) {
    mine = splat;
    mine_record = record;
}

SplatDepth mine_depth;

void hand_over_depth(SplatDepth depth) {
    mine_depth = depth;
}

vec4 mean_depth_taken_over(uint i) {
    return OF(i, mine_depth.mean);
}

// What the clip leaves of a splat that is cut lies between its bounds.
void take_over_bounds(uint i, inout SplatDepth depth) {
    depth.far = OF(i, mine_depth.far);
    depth.near = OF(i, mine_depth.near);
}

Seen taken_over(uint i) {
    Seen splat;
    splat.centre_conic = OF(i, mine.centre_conic);
    splat.conic_opacity = OF(i, mine.conic_opacity);
    splat.colour = OF(i, mine.colour);
    splat.linear = vec3(Z_WHOLE, 0.0, 0.0);
    splat.curvature = vec3(0.0);
    if (CLIP_MODE >= MODE_RARA || RECLIPPED) {
        splat.linear.x = OF(i, mine.linear.x);
    }
    splat.far = DEPTH_FORM != DEPTH_NONE ? OF(i, mine.far) : 0.0;
    return splat;
}

UnitSurface surface_of(uint i, UnitSurface surface) {
    return UnitSurface(OF(i, surface.half_space), OF(i, surface.diagonal), OF(i, surface.across));
}

// Takes over the weight of a splat that is cut: the polynomial that it carries, and its record if it has one.
Record weight_taken_over(uint i, inout Seen splat) {
    Record record;
    if (CLIP_MODE >= MODE_RARA || RECLIPPED) {
        splat.linear.yz = OF(i, mine.linear.yz);
    }
    if (CLIP_MODE == MODE_EXACT) {
        splat.curvature = OF(i, mine.curvature);
    }
    if (splat.linear.x < -Z_RANGE) {
        record.base = OF(i, mine_record.base);
        for (uint k = 0u; k <= CUT_HEADER; k++) {
            record.begin[k] = OF(i, mine_record.begin[k]);
        }
        if (COMBINED && (record_flags(record) & CUT_TERMS) != 0u) {
            for (uint k = CUT_HEADER + 1u; k < TERMS_VECTORS; k++) {
                record.begin[k] = OF(i, mine_record.begin[k]);
            }
        }
        record.sides = all_cutting();
        if (SEVERAL && COMBINED) {
            record.sides = RecordSides(OF(i, mine_record.sides.cutting), OF(i, mine_record.sides.visible));
        }
        record.surfaces.answers = COMBINED && CLIP_MODE == MODE_EXACT ? OF(i, mine_record.surfaces.answers) : 0u;
        if (record.surfaces.answers != 0u) {
            record.surfaces.first = surface_of(i, mine_record.surfaces.first);
        }
        if (record.surfaces.answers != 0u && record.surfaces.answers != FIRST_KEEPS) {
            record.surfaces.second = surface_of(i, mine_record.surfaces.second);
        }
    }
    return record;
}

bool all_done() {
    return all_of(done);
}

#else

#define BATCH (gl_WorkGroupSize.x * gl_WorkGroupSize.y)
#define IN_BATCH gl_LocalInvocationIndex
const bool WHOLE_ALONE = false; // it would be the same code twice

uint number_in_batch(uint, uint first, uint end, out float x) {
    uint number = tile_splats.at[min(first + IN_BATCH, end - 1u)];
    x = SPLAT_CENTRE(number).x;
    return number;
}

shared Seen batch[TILE_WIDTH * TILE_HEIGHT];
shared SplatDepth batch_depths[FINDS_DEPTH ? TILE_WIDTH * TILE_HEIGHT : 1u];
shared uint at_work; // 1 when an invocation is not done

void hand_over(Seen splat, Record) {
    batch[IN_BATCH] = splat;
    barrier();
}

// This comes before hand_over, whose barrier is for both.
void hand_over_depth(SplatDepth depth) {
    batch_depths[IN_BATCH] = depth;
}

vec4 mean_depth_taken_over(uint i) {
    return batch_depths[i].mean;
}

void take_over_bounds(uint i, inout SplatDepth depth) {
    depth = batch_depths[i];
}

Seen taken_over(uint i) {
    Seen splat = batch[i];
    if (CLIP_MODE < MODE_RARA && !RECLIPPED) {
        splat.linear = vec3(Z_WHOLE, 0.0, 0.0);
    }
    return splat;
}

Record weight_taken_over(uint, inout Seen splat) {
    return record_of(splat.linear);
}

// Also waits until all have seen the batch before.
bool all_done() {
    barrier();
    if (IN_BATCH == 0u) {
        at_work = 0u;
    }
    barrier();
    if (!done) {
        atomicOr(at_work, 1u);
    }
    barrier();
    return at_work == 0u;
}

#endif

#endif
