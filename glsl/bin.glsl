// Which tiles a splat contributes to: for each row of tiles, the columns between the ends that the contour alpha = 1/255
// reaches there. Exact but for a margin, where a bounding box would give a slanting needle its whole square.
#ifndef RARA_BIN
#define RARA_BIN
#include "footprint.glsl"
#include "sort.glsl"

struct Outline {
    vec2 centre; // px
    vec3 conic; // Cholesky factor, 1/px
    float power; // q on the contour
    float slope; // by how much the middle of the contour's chord moves along x a pixel along y
    float tip; // y relative to the centre, at which the contour reaches farthest to the right
    float reach; // half the contour's height, px
    float margin; // px
    vec2 sides; // what the splat's quad leaves: first and last x, px
    uvec2 rows; // first and last (exclusive) row of tiles
};

// First and last (exclusive) tile with a pixel centre in [low, high].
uvec2 tiles_between(float low, float high, float pixels, uint side) {
    float first = max(ceil(low - 0.5), 0.0);
    float last = min(floor(high - 0.5), pixels - 1.0);
    return first <= last ? uvec2(uint(first) / side, uint(last) / side + 1u) : uvec2(0u);
}

Outline outline(Splat splat) {
    Outline o;
    o.centre = splat.centre_conic.xy;
    o.conic = vec3(splat.centre_conic.zw, splat.conic_cut.x);
    float extent = opacity_extent(splat.conic_cut.y);
    o.power = extent * extent;
    float k = o.conic.x * o.conic.x + o.conic.y * o.conic.y;
    float width = extent / o.conic.x;
    o.slope = -o.conic.y * o.conic.z / k;
    o.tip = -o.conic.y / o.conic.z * width;
    // Near the contour's ends its chord is a root of a difference, off by the root of single precision.
    o.margin = 0.01 + 4e-4 * width + 1e-6 * largest(vec3(o.centre, 0.0));
    o.reach = extent * sqrt(k) / (o.conic.x * o.conic.z) + o.margin;
    vec2 middle = o.centre + splat.middle.xy;
    vec2 half_sides = abs(splat.axes.xy) + abs(splat.axes.zw);
    o.sides = middle.x + vec2(-half_sides.x, half_sides.x);
    float top = max(middle.y - half_sides.y, o.centre.y - o.reach);
    float bottom = min(middle.y + half_sides.y, o.centre.y + o.reach);
    o.rows = tiles_between(top, bottom, FRAME.size.y, TILE_HEIGHT);
    return o;
}

// Half the contour's chord along x at a height above the centre.
float half_chord(Outline o, float y) {
    float k = o.conic.x * o.conic.x + o.conic.y * o.conic.y;
    float rest = o.conic.x * o.conic.z * y;
    return sqrt(max(0.0, k * o.power - rest * rest)) / k;
}

uvec2 tiles_in_row(Outline o, uint row) {
    float top = float(row * TILE_HEIGHT) + 0.5 - o.centre.y;
    float bottom = min(top + float(TILE_HEIGHT - 1u), o.reach);
    top = max(top, -o.reach);
    float right_at = clamp(o.tip, top, bottom);
    float left_at = clamp(-o.tip, top, bottom);
    float left = o.centre.x + o.slope * left_at - half_chord(o, left_at) - o.margin;
    float right = o.centre.x + o.slope * right_at + half_chord(o, right_at) + o.margin;
    // The comparisons are false for what is no number: beyond single precision the quad's sides are all there is.
    left = left > o.sides.x ? left : o.sides.x;
    right = right < o.sides.y ? right : o.sides.y;
    return tiles_between(left, right, FRAME.size.x, TILE_WIDTH);
}

#endif
