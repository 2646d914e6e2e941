// Which tiles a splat contributes to: for each row of tiles, the columns between the ends that the contour alpha = 1/255
// reaches there. That is exact but for a margin; a bounding box would give a slanting needle its whole square.
#ifndef RARA_BIN
#define RARA_BIN
#include "cut.glsl"
#include "extent.glsl"
#include "frame.glsl"
#include "runs.glsl"

struct Outline {
    vec2 centre; // px
    vec3 conic; // Cholesky factor, 1/px
    float power; // q on the contour
    float slope; // by how much the middle of the contour's chord moves along x a pixel along y
    float tip; // y relative to the centre, at which the contour reaches farthest to the right
    float half_height; // half the contour's height, px
    float margin; // px
    vec2 sides; // what the splat's quad leaves: first and last x, px
    vec3 line; // a cut splat is cut away where line.x + line.y dx + line.z dy is negative
    uvec2 rows; // first and last (exclusive) row of tiles
};

const vec3 NO_LINE = vec3(1.0, 0.0, 0.0);

// The line behind which a carried weight's z is below -TRIM_DEVIATIONS, within a box around the splat's centre.
vec3 cut_away_line(vec3 linear, vec3 curvature, vec2 box) {
    precise float rise = max(curvature.x, 0.0) * box.x * box.x + abs(curvature.y) * box.x * box.y
        + max(curvature.z, 0.0) * box.y * box.y;
    precise vec3 line = vec3(linear.x + TRIM_DEVIATIONS + rise, linear.yz);
    return line;
}

// First and last (exclusive) tile with a pixel centre in [low, high].
uvec2 tiles_between(float low, float high, float pixels, uint side) {
    float first = max(ceil(low - 0.5), 0.0);
    float last = min(floor(high - 0.5), pixels - 1.0);
    return first <= last ? uvec2(to_uint(first) / side, to_uint(last) / side + 1u) : uvec2(0u);
}

// All of a splat's outline but what its quad leaves.
Outline contour(Splat splat) {
    precise Outline o;
    o.centre = splat.centre_conic.xy;
    o.conic = vec3(splat.centre_conic.zw, splat.conic_cut.x);
    float extent = opacity_extent(splat.conic_cut.y);
    o.power = extent * extent;
    precise float k = o.conic.x * o.conic.x + o.conic.y * o.conic.y;
    precise float width = extent / o.conic.x;
    o.slope = -o.conic.y * o.conic.z / k;
    o.tip = -o.conic.y / o.conic.z * width;
    // Near the contour's ends its chord is a root of a difference, which is off by the root of single precision.
    o.margin = 0.01 + 4e-4 * width + 1e-6 * largest(vec3(o.centre, 0.0));
    o.half_height = extent * sqrt(k) / (o.conic.x * o.conic.z) + o.margin;
    o.line = NO_LINE;
    vec3 linear = vec3(splat.conic_cut.zw, splat.colour_cut.w);
    if (abs(linear.x) < Z_RANGE) {
        o.line = cut_away_line(linear, splat.curvature_depth.xyz, vec2(width, o.half_height));
    } else if (linear.x < -Z_RANGE) {
        OpenStrip strip = open_strip_of(linear, splat.curvature_depth.xyz);
        o.line = vec3(strip.away, strip.slope);
    }
    return o;
}

Outline outline(Splat splat, Quad quad) {
    precise Outline o = contour(splat);
    vec2 middle = o.centre + quad.middle;
    vec2 half_sides = abs(quad.first) + abs(quad.second);
    o.sides = middle.x + vec2(-half_sides.x, half_sides.x);
    float top = max(middle.y - half_sides.y, o.centre.y - o.half_height);
    float bottom = min(middle.y + half_sides.y, o.centre.y + o.half_height);
    o.rows = tiles_between(top, bottom, VIEW.size.y, TILE_HEIGHT);
    return o;
}

// What a quad leaves of an outline, in two words: first and last (exclusive) row of tiles, and those columns of pixels.
uvec2 bounds(Outline o) {
    float width = VIEW.size.x;
    vec2 columns = clamp(vec2(ceil(o.sides.x - 0.5), floor(o.sides.y - 0.5) + 1.0), 0.0, width);
    return uvec2(o.rows.x | o.rows.y << 16, to_uint(columns.x) | to_uint(columns.y) << 16);
}

uvec2 rows_of(uvec2 bounds) {
    return uvec2(bounds.x & 0xffffu, bounds.x >> 16);
}

// Those of the pixels, so that they reach the same tiles.
vec2 sides_of(uvec2 bounds) {
    return vec2(float(bounds.y & 0xffffu) + 0.5, float(bounds.y >> 16) - 0.5);
}

// The outline that has these bounds.
Outline bounded_outline(Splat splat, uvec2 bounds) {
    precise Outline o = contour(splat);
    o.rows = rows_of(bounds);
    o.sides = sides_of(bounds);
    return o;
}

// Half the contour's chord along x at a height above the centre.
float half_chord(Outline o, float y) {
    precise float k = o.conic.x * o.conic.x + o.conic.y * o.conic.y;
    precise float rest = o.conic.x * o.conic.z * y;
    precise float half_length = sqrt(max(0.0, k * o.power - rest * rest)) / k;
    return half_length;
}

uvec2 tiles_in_row(Outline o, uint row) {
    precise float top = float(row * TILE_HEIGHT) + 0.5 - o.centre.y;
    precise float bottom = min(top + float(TILE_HEIGHT - 1u), o.half_height);
    top = max(top, -o.half_height);
    // The bits must be the same wherever this is computed: what one shader counts another writes.
    precise float right_at = clamp(o.tip, top, bottom);
    precise float left_at = clamp(-o.tip, top, bottom);
    precise float left = o.centre.x + o.slope * left_at - half_chord(o, left_at) - o.margin;
    precise float right = o.centre.x + o.slope * right_at + half_chord(o, right_at) + o.margin;
    // The comparisons are false for what is no number: beyond single precision the quad's sides are all there is.
    left = left > o.sides.x ? left : o.sides.x;
    right = right < o.sides.y ? right : o.sides.y;
    // The line is taken at the height where it leaves most.
    precise float least = o.line.x + max(o.line.z * top, o.line.z * bottom);
    precise float at = o.centre.x - least / o.line.y;
    left = o.line.y > 0.0 && at - o.margin > left ? at - o.margin : left;
    right = o.line.y < 0.0 && at + o.margin < right ? at + o.margin : right;
    if (o.line.y == 0.0 && least < 0.0) {
        return uvec2(0u);
    }
    return tiles_between(left, right, VIEW.size.x, TILE_WIDTH);
}

// A splat's tiles as a mask of MASK_SIDE x MASK_SIDE bits, row by row, from a first tile on. project.comp finds it once, in
// the order of memory, for the passes that follow the order of depth.
const uint MASK_SIDE = 8u;

// Stands for a mask's first tile where the mask cannot hold all tiles. No tile has this number: its row would be 65535.
const uint NO_MASK = ~0u;

// x: first column and, in the upper half, first row; y: 1 where the tiles are more than the mask holds; zw: the mask, or in
// its place the outline's bounds, from which the passes that need them find the tiles.
uvec4 tile_mask(Outline o) {
    if (o.rows.y - o.rows.x > MASK_SIDE) {
        return uvec4(0u, 1u, bounds(o));
    }
    uvec2 spans[MASK_SIDE];
    uint first = 0xffffu; // no column: a mask of nothing is one too, and not NO_MASK
    uint last = 0u;
    for (uint row = 0u; row < MASK_SIDE; row++) {
        spans[row] = o.rows.x + row < o.rows.y ? tiles_in_row(o, o.rows.x + row) : uvec2(0u);
        bool any = spans[row].x < spans[row].y;
        first = any ? min(first, spans[row].x) : first;
        last = any ? max(last, spans[row].y) : last;
    }
    if (last > first + MASK_SIDE) {
        return uvec4(0u, 1u, bounds(o));
    }
    uvec2 mask = uvec2(0u);
    for (uint row = 0u; row < MASK_SIDE; row++) {
        if (spans[row].x < spans[row].y) {
            uint bits = ((1u << (spans[row].y - spans[row].x)) - 1u) << (spans[row].x - first);
            mask[row >> 2] |= bits << ((row & 3u) * MASK_SIDE);
        }
    }
    return uvec4(first | o.rows.x << 16, 0u, mask);
}

// The tiles of one row that a splat touches.
struct Span {
    uint row;
    uvec2 columns; // first and last (exclusive)
};

// Takes the first span out of a mask. The bits of a row are next to each other.
Span next_span(uint origin, inout uvec2 mask) {
    bool below = mask.x == 0u;
    uint bits = below ? mask.y : mask.x;
    uint row = uint(findLSB(bits)) / MASK_SIDE;
    uint tiles = bitfieldExtract(bits, int(row * MASK_SIDE), int(MASK_SIDE));
    bits = bitfieldInsert(bits, 0u, int(row * MASK_SIDE), int(MASK_SIDE));
    mask = below ? uvec2(0u, bits) : uvec2(bits, mask.y);
    uint column = (origin & 0xffffu) + uint(findLSB(tiles));
    return Span((origin >> 16) + row + (below ? 4u : 0u), uvec2(column, column + uint(bitCount(tiles))));
}

// The place in span_counts of the number of tiles that a run's splats touch in all.
uint pairs_place(uint run) {
    return EYE.tiles.span_runs * tile_rows() + run;
}

#endif
