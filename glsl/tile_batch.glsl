// A batch of a tile's splats is loaded at once: each invocation loads one, hands it over, and all see them in turn. Included by
// tiles.glsl, which declares what is handed over.
#ifndef RARA_TILE_BATCH
#define RARA_TILE_BATCH

// A walk through the splats of the tile's cell.
struct Cell {
    uint words; // of bits; 0 where the tile has a list of its own
    uint row_place; // where the bits of its row are,
    uint column_place; // and of its column
    uint next; // the word that is looked at next
    uint left; // bits of the one before that are still to come
};
Cell cell = Cell(0u, 0u, 0u, 0u, 0u);

// Where lists are coarse, the tile's is that of its cell, whose end shows when it is reached.
void find_cell(uvec2 tile, inout uint begin, inout uint end) {
    uint side = tile_begins.at[cell_side_place()];
    if (side != 0u) {
        uint words = tile_begins.at[cell_words_place()];
        uvec2 at = tile / side;
        uint rows = cell_counts(side).y;
        uint bits = cell_bits_place(words);
        cell = Cell(words, bits + at.y * words, bits + (rows + at.x) * words, 0u, 0u);
        begin = 0u;
        end = 1u << 31u;
    }
}

// The bits of the cell's splats that a word holds.
uint cell_word(uint word) {
    return word < cell.words ? tile_splats.at[cell.row_place + word] & tile_splats.at[cell.column_place + word] : 0u;
}

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

// The invocation's splat of a batch of the tile's list, and its centre's x.
uint number_in_list(uint begin, uint first, uint end, out float x) {
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

uint own_word;

// Each invocation asks for one of the next words of the cell. Returns whether there is a bit in any.
bool share_words() {
    own_word = cell_word(cell.next + IN_BATCH);
    return !all_of(own_word == 0u);
}

uint shared_word(uint i) {
    return OF(i, own_word);
}

uint mine_number;

void hand_over_number(uint number) {
    mine_number = number;
}

uint number_taken_over(uint i) {
    return OF(i, mine_number);
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
            record.sides = RecordSides(OF(i, mine_record.sides.cutting), OF(i, mine_record.sides.visible), no_tile_faces());
        }
        if (MESHES) {
            TileFaces faces = mine_record.sides.faces;
            record.sides.faces.first = OF(i, faces.first);
            if (is_list(record.sides.faces)) {
                record.sides.faces = TileFaces(OF(i, faces.one), OF(i, faces.other), record.sides.faces.first, OF(i, faces.known), OF(i, faces.winding));
            }
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

uint number_in_list(uint, uint first, uint end, out float x) {
    uint number = tile_splats.at[min(first + IN_BATCH, end - 1u)];
    x = SPLAT_CENTRE(number).x;
    return number;
}

shared uint words[TILE_WIDTH * TILE_HEIGHT];

bool share_words() {
    barrier();
    words[IN_BATCH] = cell_word(cell.next + IN_BATCH);
    barrier();
    return true;
}

uint shared_word(uint i) {
    return words[i];
}

shared uint batch_numbers[STRONGEST ? TILE_WIDTH * TILE_HEIGHT : 1u];

// This comes before hand_over, whose barrier is for both.
void hand_over_number(uint number) {
    batch_numbers[IN_BATCH] = number;
}

uint number_taken_over(uint i) {
    return batch_numbers[i];
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

// The invocation's splat of a batch of the cell's, and its centre's x. All invocations go through the same bits, of which each
// keeps one. The last batch, which is not full, says where the list ends.
uint number_in_cell(uint first, inout uint end, out float x) {
    uint own = 0u; // by depth
    uint count = 0u;
    while (count < BATCH && (cell.left != 0u || cell.next < cell.words)) {
        if (cell.left != 0u) {
            uint bit = uint(findLSB(cell.left));
            cell.left &= cell.left - 1u;
            own = count == IN_BATCH ? 32u * (cell.next - 1u) + bit : own;
            count++;
        } else if (cell.next % BATCH != 0u || share_words()) {
            cell.left = shared_word(cell.next % BATCH);
            cell.next++;
        } else {
            cell.next += BATCH;
        }
    }
    end = count < BATCH ? first + count : end;
    uint number = tile_splats.at[own];
    x = SPLAT_CENTRE(number).x;
    return number;
}

#endif
