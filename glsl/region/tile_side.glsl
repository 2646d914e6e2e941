// The side of a tile in a cut splat: visible where the splat's weight is 1 in all of the tile's pixels, invisible where it is
// 0 in all of them. The answer is conservative: cutoff says that each pixel has to be weighed. Included after
// glsl/weight.glsl. Twin: src/reference/region/tile_side.rs.
#ifndef RARA_REGION_TILE_SIDE
#define RARA_REGION_TILE_SIDE
#include "record.glsl"
#include "region/sides.glsl"

// From a tile's middle to its outermost pixel centres, px.
const vec2 TILE_REACH = 0.5 * vec2(TILE_WIDTH - 1u, TILE_HEIGHT - 1u);
// Weights are taken for 0 and 1 this share beyond where they are, which covers the rounding of a pixel's z.
const float TILE_MARGIN = 1.01;
// Shares below 6e-6 are taken for none: from this difference of squares on, the ratio of two tails of the normal distribution
// is, and so is that of the tail beyond PHI_ONE to a half or more.
const float NO_TAIL = 25.5;

uint side_between(float low, float high, float certain) {
    return low > certain ? SIDE_VISIBLE : high < -certain ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

// A splat that carries its curve. `delta` is the tile's middle relative to the splat's centre.
uint carried_side(vec3 linear, vec3 curvature, vec2 delta) {
    vec3 squares = vec3(delta.x * delta.x, delta.x * delta.y, delta.y * delta.y);
    float z = linear.x + dot(linear.yz, delta) + dot(curvature, squares);
    vec2 slope = linear.yz + vec2(2.0 * curvature.x * delta.x + curvature.y * delta.y, curvature.y * delta.x + 2.0 * curvature.z * delta.y);
    vec2 r = TILE_REACH;
    float reach = dot(abs(slope), r) + dot(abs(curvature), vec3(r.x * r.x, r.x * r.y, r.y * r.y));
    return side_between(z - reach, z + reach, TILE_MARGIN * PHI_ONE);
}

// Returns the z that a tile takes for a splat with a record. Outside its open strip the splat is whole, or away.
float z_beyond_strip(vec3 linear, vec3 curvature, vec2 delta) {
    OpenStrip strip = open_strip_of(linear, curvature);
    float at = dot(strip.slope, delta);
    float reach = dot(abs(strip.slope), TILE_REACH);
    return strip.away + at + reach < 0.0 ? Z_CUT_AWAY : strip.whole + at - reach > 0.0 ? Z_WHOLE : linear.x;
}

// The least and the greatest of a polynomial in a tile. `uv` are the tile's middle in the splat's own coordinates, and `uv_reach` is
// how far its pixels' are from those.
vec2 curve_range(Curve c, vec2 uv, vec2 uv_reach) {
    float z = curve_z(c, uv);
    // The mean value theorem, with the largest slopes that the coordinates' magnitudes allow.
    float U = abs(uv.x) + uv_reach.x;
    float V = abs(uv.y) + uv_reach.y;
    vec3 bend = abs(c.bend);
    vec4 twist = abs(c.twist);
    vec4 wave = abs(c.wave);
    float along_u = abs(c.slope.x) + 2.0 * bend.x * U + bend.y * V + 3.0 * twist.x * U * U + 2.0 * twist.y * U * V
        + twist.z * V * V + 4.0 * wave.x * U * U * U + 3.0 * wave.y * U * U * V + 2.0 * wave.z * U * V * V + wave.w * V * V * V;
    float along_v = abs(c.slope.y) + bend.y * U + 2.0 * bend.z * V + twist.y * U * U + 2.0 * twist.z * U * V
        + 3.0 * twist.w * V * V + wave.y * U * U * U + 2.0 * wave.z * U * U * V + 3.0 * wave.w * U * V * V
        + 4.0 * abs(c.ripple) * V * V * V;
    float reach = along_u * uv_reach.x + along_v * uv_reach.y;
    return vec2(z - reach, z + reach);
}

// A record that is a curve.
uint curve_side(Record record, vec2 uv, vec2 uv_reach) {
    Curve curve = curve_of(RECORD_AT(record, 0), RECORD_AT(record, 1), RECORD_AT(record, 2), RECORD_AT(record, 3));
    vec2 z = curve_range(curve, uv, uv_reach);
    return side_between(z.x, z.y, TILE_MARGIN * PHI_ONE);
}

// A record of a surface's terms. Its function has the same sign as far along a line of sight as counts, if that of its value
// outweighs its slope and its bend there.
uint terms_side(Record record, vec2 uv, vec2 uv_reach) {
    TermCurves t = record_terms(record);
    vec2 value = curve_range(t.value, uv, uv_reach);
    vec2 variance = curve_range(t.variance, uv, uv_reach);
    vec2 bend = curve_range(t.bend, uv, uv_reach);
    float certain = TILE_MARGIN * PHI_ONE;
    float most_bend = max(-bend.x, bend.y) / max(variance.x, 1e-30);
    return side_between(value.x, value.y, certain * sqrt(max(variance.y, 0.0)) + (certain * certain + 1.0) * most_bend);
}

// The lines of sight of a tile's pixels: the middle one, and how far the others' terms are from its own. The gradients b1
// and b2 are linear in the pixel, and so is c, their cross product, since both lean alike.
struct TileSight {
    Sight s; // in mode `rara`, whose chords know no low-pass, without it
    vec2 delta_reach;
    vec2 b_reach;
    vec3 lean;
    vec3 c_x, c_y; // by how much c changes to the outermost pixels along x and along y
    float c_length, c_reach;
    vec3 det; // in the middle, the least, the greatest
};

float determinant(float c_length, vec2 b, float low_pass) {
    return c_length * c_length + low_pass * (dot(b, b) + low_pass);
}

TileSight tile_sight(Record record, vec2 delta, vec2 middle) {
    TileSight tile;
    tile.s = sight_through(RECORD_AT(record, 0), RECORD_AT(record, 1), RECORD_AT(record, 2), middle - principal_point(), delta);
    tile.s.low_pass = CLIP_MODE == MODE_RARA ? 0.0 : tile.s.low_pass;
    tile.lean = RECORD_AT(record, 2).xyz;
    tile.delta_reach = TILE_REACH * RECORD_AT(record, 1).w;
    tile.b_reach = TILE_REACH * length(tile.lean);
    tile.c_x = TILE_REACH.x * cross(tile.s.b2, tile.lean);
    tile.c_y = TILE_REACH.y * cross(tile.lean, tile.s.b1);
    tile.c_length = length(tile.s.c);
    tile.c_reach = length(tile.c_x) + length(tile.c_y);
    vec2 b = vec2(length(tile.s.b1), length(tile.s.b2));
    tile.det.x = determinant(tile.c_length, b, tile.s.low_pass);
    tile.det.y = determinant(max(tile.c_length - tile.c_reach, 0.0), max(b - tile.b_reach, 0.0), tile.s.low_pass);
    tile.det.z = determinant(tile.c_length + tile.c_reach, b + tile.b_reach, tile.s.low_pass);
    return tile;
}

// Bounds over a tile of what a plane's z (beam_z of glsl/sight.glsl) is made of: mean / sqrt(variance det), each a polynomial in
// the pixel that is bounded by itself. In mode `rara` z is the plane's distance along the line in units of the chord.
struct PlaneRange {
    float low, high; // the mean
    float variance_least, variance_most;
    bool far, near; // which part the plane may keep
};

PlaneRange plane_range(TileSight tile, vec4 half_space) {
    Sight s = tile.s;
    vec3 a = half_space.xyz;
    vec3 a1 = cross(a, s.b1);
    vec3 a2 = cross(a, s.b2);
    float a_length = length(a);
    vec2 across = vec2(length(a1), length(a2));
    vec2 across_reach = TILE_REACH * length(cross(a, tile.lean));
    float along = dot(a, s.c);
    float along_reach = abs(dot(a, tile.c_x)) + abs(dot(a, tile.c_y));
    float rest = s.low_pass * s.low_pass * a_length * a_length;
    vec2 across_least = max(across - across_reach, 0.0);
    vec2 across_most = across + across_reach;
    float along_least = max(abs(along) - along_reach, 0.0);
    float along_most = abs(along) + along_reach;
    float variance_least = along_least * along_least + s.low_pass * dot(across_least, across_least) + rest;
    float variance_most = along_most * along_most + s.low_pass * dot(across_most, across_most) + rest;
    vec2 k = vec2(dot(s.c, a2) + s.low_pass * dot(a, s.b1), -dot(s.c, a1) + s.low_pass * dot(a, s.b2));
    // The first component of k has a2 and b1, the second has a1 and b2.
    vec2 k_reach = across.yx * tile.c_reach + (tile.c_length + tile.c_reach) * across_reach.yx
        + s.low_pass * a_length * tile.b_reach;
    float mean = half_space.w * tile.det.x + dot(k, s.delta);
    float mean_reach = abs(half_space.w) * max(tile.det.z - tile.det.x, tile.det.x - tile.det.y)
        + dot(abs(s.delta), k_reach) + dot(tile.delta_reach, abs(k) + k_reach);
    // A plane whose `along` is no number may keep either part, and then settles nothing.
    return PlaneRange(mean - mean_reach, mean + mean_reach, variance_least, variance_most, !(along < -along_reach), !(along > along_reach));
}

// Bounds of a plane's z itself.
struct ZRange {
    float low, high;
    bool far, near;
};

ZRange z_range(TileSight tile, vec4 half_space) {
    PlaneRange plane = plane_range(tile, half_space);
    float scale_least = inversesqrt(max(plane.variance_most * tile.det.z, 1e-30));
    float scale_most = inversesqrt(max(plane.variance_least * tile.det.y, 1e-30));
    float low = plane.low * (plane.low > 0.0 ? scale_least : scale_most);
    float high = plane.high * (plane.high < 0.0 ? scale_least : scale_most);
    return ZRange(low, high, plane.far, plane.near);
}

// True when Phi(z) / Phi(front) is nearly 0. It grows with z and falls with front, so it is asked of the greatest z and the
// least front.
bool is_no_tail(float z, float front) {
    return front >= 0.0 ? z < -TILE_MARGIN * PHI_ONE : z < front && z * z - front * front > NO_TAIL;
}

// A record of planes. `delta` is the tile's middle relative to the splat's centre, `middle` the same in the picture.
uint planes_side(Record record, uint flags, vec2 delta, vec2 middle) {
    float certain = TILE_MARGIN * (CLIP_MODE == MODE_RARA ? push.params.sigma : PHI_ONE);
    bool from_inside = CLIP_MODE == MODE_EXACT && (flags & CUT_FRONT) != 0u;
    TileSight tile = tile_sight(record, delta, middle);
    uint count = flags >> CUT_COUNT_SHIFT;
    ZRange front;
    if (from_inside) {
        front = z_range(tile, plane_of(record_base(record), count));
    }
    bool visible = true;
    bool invisible = false;
    for (uint plane = 0u; plane < count; plane++) {
        ZRange z = z_range(tile, plane_of(record_base(record), plane));
        bool keeps = z.low > certain;
        bool drops = z.high < -certain;
        if (from_inside) {
            // Only the part in front of the eye counts: front_weight of glsl/weight.glsl.
            keeps = (!z.far || z.low > front.high) && (!z.near || is_no_tail(-z.low, front.low));
            drops = (!z.far || is_no_tail(z.high, front.low)) && (!z.near || -z.high > front.high);
        }
        visible = visible && keeps;
        invisible = invisible || drops;
    }
    if ((flags & CUT_UNION) != 0u) { // the planes are the complements
        return invisible ? SIDE_VISIBLE : visible ? SIDE_INVISIBLE : SIDE_CUTOFF;
    }
    return visible ? SIDE_VISIBLE : invisible ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

#include "region/tile_combination.glsl"

// The side of the tile with this middle, px, in a splat that is cut.
uint tile_side(vec3 linear, vec3 curvature, inout Record record, vec4 centre_conic, float conic_z, vec2 middle) {
    vec2 delta = middle - centre_conic.xy;
    if (CLIP_MODE == MODE_EXACT && linear.x > -Z_RANGE) {
        return carried_side(linear, curvature, delta);
    }
    uint flags = record_flags(record);
    bool is_terms = COMBINED && (flags & CUT_TERMS) != 0u;
    if (CLIP_MODE == MODE_EXACT && (is_terms || (flags & CUT_CURVE) != 0u)) {
        vec2 uv = vec2(centre_conic.z * delta.x, centre_conic.w * delta.x + conic_z * delta.y);
        vec2 reach = vec2(abs(centre_conic.z) * TILE_REACH.x, abs(centre_conic.w) * TILE_REACH.x + abs(conic_z) * TILE_REACH.y);
        return is_terms ? terms_side(record, uv, reach) : curve_side(record, uv, reach);
    }
    if (CLIP_MODE == MODE_RARA && MISS != MISS_PEAK) {
        return SIDE_CUTOFF; // lines of sight beside the ellipsoid are kept or dropped wherever they are
    }
    bool is_combined = COMBINED && (flags & CUT_COMBINED) != 0u;
    if (MESHES && (flags & CUT_FACES) == CUT_FACES) {
        return faces_side(record, flags, tile_sight(record, delta, middle));
    }
#ifdef RARA_SUBGROUP
    if (is_combined) {
        return combination_side(record, flags, delta, middle);
    }
#else
    // On GPUs these bounds would take more registers than all the rest of a pipeline for one surface, or for combined records.
    if (!SEVERAL || is_combined) {
        return SIDE_CUTOFF;
    }
#endif
    return planes_side(record, flags, delta, middle);
}

#endif
