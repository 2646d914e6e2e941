#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a cutoff Gaussian writes its cutoff record: everything that the fragment stage needs to weight it. Where more
// surfaces cut it than a record has room for, it also writes a long record behind those of all Gaussians.
#define MESHES_BINDING 7
#include "beam.glsl"
#include "region/surface.glsl"
#include "cut.glsl"
#include "curve.glsl"
#include "region/carried_bend.glsl"

layout(local_size_x = SPLAT_GROUP_SIZE) in;
layout(constant_id = 12) const bool SEVERAL = false; // whether a splat may be cut by more than one surface
layout(constant_id = 16) const bool MANY = false; // whether more than RECORD_SURFACES may cut it

BUFFER(readonly, 2, Gaussian, gaussians)
BUFFER(readonly, 3, uint, cutoffs)
BUFFER(, 4, FrameCounts, counts)
BUFFER(, 5, vec4, cut_records)
BUFFER(readonly, 6, uint, shortlists)
#include "region/reduced.glsl"

// A half-space in the beam form. Dividing by the largest component keeps the squares of sigmas of 1e5 and 1e-7 in range.
vec4 beam_plane(vec4 half_space) {
    float size = largest(half_space.xyz);
    return size > 0.0 ? half_space / size : vec4(vec3(0.0), half_space.w >= 0.0 ? 1.0 : -1.0);
}

// A half-space in the affine form. Given the pixel, the Gaussian seen through the low-pass has, along the normal a,
// mean g + k.delta and variance s^2 (the update of a Kalman filter that has observed the pixel):
//   k = S^-1 B a, s^2 = |a|^2 - (B a)^T S^-1 (B a), with S = B B^T + L the splat's 2D covariance,
// so the share on the visible side is Phi((g + k.delta) / s). Both are written as sums of squares over det S.
vec4 affine_plane(Footprint f, vec4 half_space) {
    vec3 a = half_space.xyz;
    vec3 c = cross(f.b1, f.b2);
    vec3 a1 = cross(a, f.b1);
    vec3 a2 = cross(a, f.b2);
    float ac = dot(a, c);
    float variance = ac * ac + f.low_pass * (dot(a1, a1) + dot(a2, a2)) + f.low_pass * f.low_pass * dot(a, a);
    vec2 slope = vec2(dot(c, a2) + f.low_pass * dot(a, f.b1), -dot(c, a1) + f.low_pass * dot(a, f.b2));
    if (!(variance > 0.0)) {
        return vec4(half_space.w >= 0.0 ? 40.0 : -40.0, 0.0, 0.0, 0.0);
    }
    float inverse = inversesqrt(variance / f.det);
    // The rasteriser carries no more than that; beyond 40 deviations all distances are alike.
    return vec4(clamp(half_space.w * inverse, -1e20, 1e20), slope * (f.scale / f.det * inverse), 0.0);
}

// The weight of one surface that the rasteriser carries.
void write_carried(uint base, vec3 linear, vec3 curvature) {
    cut_records.at[base] = vec4(vec3(0.0), float(1u << CUT_COUNT_SHIFT));
    cut_records.at[base + CUT_HEADER] = vec4(linear, 0.0);
    cut_records.at[base + CUT_HEADER + 1u] = vec4(curvature, 0.0);
}

// Writes what the weight of one surface follows from.
void write_terms(uint base, TermCurves t) {
    cut_records.at[base] = vec4(t.value.at, t.value.slope, float(1u << CUT_COUNT_SHIFT | CUT_TERMS | CUT_STRIP));
    cut_records.at[base + 1u] = vec4(t.value.bend, t.value.ripple);
    cut_records.at[base + 2u] = t.value.twist;
    cut_records.at[base + 3u] = t.value.wave;
    cut_records.at[base + 4u] = vec4(t.variance.at, t.variance.slope, t.bend.at);
    cut_records.at[base + 5u] = vec4(t.variance.bend, t.bend.slope.x);
    cut_records.at[base + 6u] = t.variance.twist;
    cut_records.at[base + 7u] = vec4(t.bend.slope.y, t.bend.bend);
}

void write_strip(uint base, OpenStrip strip, vec3 conic) {
    vec2 slope = strip.slope.x * vec2(conic.x, 0.0) + strip.slope.y * conic.yz;
    cut_records.at[base + EYE.weight.cut_stride - 1u] = vec4(slope, strip.away, strip.whole);
}

// Writes the weight of one surface as a polynomial, if one is as good as the exact form. Else `strip` is where a surface of a
// combined record is open, on CPU drivers.
bool write_curve(uint base, CurveSource source, float opacity, out OpenStrip strip) {
    float extent = opacity_extent(opacity);
    CurveSamples samples;
    Curve square;
    Curve cubic;
    Curve quartic;
    bool is_settled = false;
    uint first = first_samples(source);
    // There is one copy of the samples' code for both turns.
    for (uint turn = 0u; turn < 2u && !is_settled; turn++) {
        take_samples(source, turn == 0u ? 0u : first, turn == 0u ? first : ALL_SAMPLES, extent, samples);
        if (turn == 0u) {
            fitted(samples.centre, samples.at, square, cubic, quartic);
            is_settled = is_close(square, source, samples, opacity, extent);
        }
    }
    if (is_settled || is_good(square, samples, opacity, extent)) {
        vec3 linear;
        vec3 curvature;
        in_pixels(square, source.conic, linear, curvature);
        write_carried(base, linear, curvature);
        return true;
    }
    if (is_good(quartic, samples, opacity, extent)) {
        cut_records.at[base] = vec4(quartic.at, quartic.slope, float(1u << CUT_COUNT_SHIFT | CUT_CURVE | CUT_STRIP));
        cut_records.at[base + 1u] = vec4(quartic.bend, quartic.ripple);
        cut_records.at[base + 2u] = quartic.twist;
        cut_records.at[base + CUT_HEADER] = quartic.wave;
        write_strip(base, open_strip(quartic, 1.001 * extent), source.conic);
        return true;
    }
    if (!(HAS_TERMS && COMBINED && source.bends)) {
        return false;
    }
    strip = open_strip(square, samples, CURVE_RINGS, extent);
    TermCurves fit = fitted_terms(samples);
    bool is_fitted = is_good(fit, samples, opacity, extent);
    if (is_fitted) {
        write_terms(base, fit);
        write_strip(base, strip, source.conic);
    }
    return is_fitted;
}

// Finds where one of several surfaces is open.
OpenStrip strip_of_surface(CurveSource source, float extent) {
    CurveSamples samples;
    take_samples(source, 0u, first_samples(source), extent, samples);
    Curve square;
    Curve cubic;
    Curve quartic;
    fitted(samples.centre, samples.at, square, cubic, quartic);
    return open_strip(square, samples, first_rings(source), extent);
}

// A splat of which all or nothing is kept.
void write_decided(uint base, bool is_kept) {
    float side = is_kept ? 1.0 : -1.0;
    if (CUT.region.mode == MODE_EXACT) {
        write_carried(base, vec3(40.0 * side, 0.0, 0.0), vec3(0.0));
        return;
    }
    cut_records.at[base] = vec4(1.0, 0.0, 0.0, float(1u << CUT_COUNT_SHIFT | CUT_BEAM));
    cut_records.at[base + 1u] = vec4(0.0, 1.0, 0.0, 0.0); // every pixel's line goes through the centre
    cut_records.at[base + 2u] = vec4(0.0);
    cut_records.at[base + CUT_HEADER] = vec4(vec3(0.0), side);
}

// True when a record's surfaces are planes that all combine alike, as a list of planes does.
bool are_planes(uint base, uint entries, out bool is_union) {
    bool has_and = false;
    bool bends = false;
    is_union = false;
    for (uint i = 0u; i < entries; i++) {
        uint at = base + CUT_HEADER + ENTRY_VECTORS * i;
        vec4 diagonal = cut_records.at[at + 1u];
        bends = bends || diagonal.xyz != vec3(0.0) || cut_records.at[at + 2u].xyz != vec3(0.0);
        uint operators = to_uint(diagonal.w);
        uint count = operator_count(operators);
        uint ors = uint(bitCount(operators >> OPERATOR_SHIFT));
        is_union = is_union || ors > 0u;
        has_and = has_and || ors < count;
    }
    return !bends && !(has_and && is_union);
}

// Writes the surfaces of a list that cut a Gaussian, those that come first where there is no room for all. Returns how many cut it.
uint write_list(Footprint f, vec3 position, float deviations, bool is_union, uint room, inout uint at, out vec4 half_space) {
    uint cutting = 0u;
    uint room_at_last = room;
    float last = 1e30;
    half_space = vec4(0.0);
    if (MANY && surface_count() > room) {
        for (uint i = 0u; i < surface_count(); i++) {
            cutting += listed_gaussian_side(surface_at(i), f.axes, position, deviations) != side_undecided() ? 1u : 0u;
        }
        last = cutting > room ? last_precedence(f, position, deviations, room_at_last) : last;
    }
    uint written = 0u;
    for (uint i = 0u; i < surface_count(); i++) {
        uint surface = surface_at(i);
        // A surface that keeps the whole splat changes no intersection, and one that drops it changes no union.
        if (listed_gaussian_side(surface, f.axes, position, deviations) == side_undecided()) {
            continue;
        }
        half_space = plane_half_space(surface, f.axes, position);
        if (MANY && cutting > room) {
            float here = precedence(UnitSurface(half_space, vec3(0.0), vec3(0.0)));
            if (here > last || (here == last && room_at_last == 0u)) {
                continue;
            }
            room_at_last -= here == last ? 1u : 0u;
        }
        half_space = beam_plane(half_space);
        cut_records.at[at++] = is_union ? -half_space : half_space;
        written++;
    }
    return max(cutting, written);
}

// Writes a cutoff record that has room for so many surfaces. `depth` is how deep a stack of their answers may be. Returns how many
// surfaces cut the Gaussian.
uint write_record(uint base, uint room, uint index, out uint depth) {
    Gaussian gaussian = gaussians.at[index];
    vec3 position = gaussian.position_opacity.xyz;
    Footprint f = footprint(gaussian);
    float extent = opacity_extent(opacity_in_layer(gaussian));
    float sigma = largest(gaussian.scale.xyz);
    float deviations = band_in_view(f, sigma, extent);
    enter_shortlist(index / BLOCK_SIZE, deviations / band(extent));
    if (has_shortlist() && shortlist_side() != SIDE_CUTOFF) {
        leave_shortlist(); // it was another list by which the splat is cut
    }

    bool front = holds_the_eye(f, extent);
    bool beam = CUT.region.mode == MODE_RARA || is_beam(f, sigma) || (EYE.weight.form == FORM_AUTO && front);
    front = front && beam;

    written_record = base;
    depth = 2u;
    uint cutting = 0u;
    uint at = base + CUT_HEADER;
    bool is_combined = COMBINED && LAYER.region.combined != 0u;
    bool is_union = !is_combined && LAYER.region.op == OP_OR && LAYER.region.surface_count > 1u;
    bool has_faces = false;
    vec4 half_space;
    if (is_combined) {
        Rest rest = write_reduced(f, position, deviations, room);
        cutting = rest.cutting;
        depth = rest.depth;
        if (rest.decided < 2u) {
            // The rest of the region's expression has an answer that its parts' sides do not show.
            write_decided(base, rest.decided == 1u);
            return cutting;
        }
        has_faces = MESHES && rest.has_faces;
        is_combined = has_faces || !are_planes(base, rest.entries, is_union);
        if (is_combined) {
            at += ENTRY_VECTORS * rest.entries;
            half_space = cut_records.at[base + CUT_HEADER];
        } else {
            for (uint i = 0u; i < rest.entries; i++) {
                half_space = beam_plane(cut_records.at[base + CUT_HEADER + ENTRY_VECTORS * i]);
                cut_records.at[at++] = is_union ? -half_space : half_space;
            }
        }
    }
    if (!COMBINED || LAYER.region.combined == 0u) {
        cutting = write_list(f, position, deviations, is_union, room, at, half_space);
    }
    uint count = (at - base - CUT_HEADER) / (is_combined ? ENTRY_VECTORS : 1u);
    uint flags = count << CUT_COUNT_SHIFT | (is_combined ? CUT_COMBINED : 0u) | (has_faces ? CUT_FACES : 0u);
    if (is_union && count == 1u && !front && CUT.region.mode == MODE_EXACT) {
        cut_records.at[at - 1u] = half_space; // not its complement: without CUT_UNION a record holds what is kept
    } else if (is_union) {
        flags |= CUT_UNION;
    }
    if (!beam && count == 1u && !is_combined) {
        cut_records.at[base] = vec4(vec3(0.0), float(flags));
        cut_records.at[at - 1u] = affine_plane(f, half_space);
        cut_records.at[at] = vec4(0.0);
        return cutting;
    }
    // The footprint's own gradients are the same in all pixels.
    CurveSource source;
    source.h0 = vec4(f.b1, 0.0);
    source.h1 = vec4(f.b2, f.scale);
    source.h2 = vec4(vec3(0.0), f.low_pass);
    source.half_space = half_space;
    source.bends = is_combined;
    source.centre = f.screen_centre - VIEW.focal.zw;
    source.conic = conic_of(f);
    if (beam) {
        // The weight follows true rays. The gradients at a pixel are these less the pixel's position times `lean`.
        vec2 magnification = quotient(VIEW.focal.xy, f.w);
        vec3 b1 = magnification.x * f.m1;
        vec3 b2 = magnification.y * f.m2;
        vec3 lean = quotient(f.w_gradient, f.w);
        // They grow with the distance from the principal point, so the scale is the farthest pixel's.
        vec2 far = max(abs(VIEW.focal.zw), abs(VIEW.size.xy - VIEW.focal.zw));
        float size = max(largest(b1) + far.x * largest(lean), largest(b2) + far.y * largest(lean));
        // Mode `rara` has no low-pass to keep in proportion, so it also scales up what is tiny.
        float scale = 1.0 / max(size, CUT.region.mode == MODE_RARA ? 1e-30 : 1.0);
        source.h0 = vec4(b1 * scale, 0.0);
        source.h1 = vec4(b2 * scale, scale);
        source.h2 = vec4(lean * scale, LAYER.content.low_pass * scale * scale);
    }

    // A switch of zero asks for the exact form itself.
    bool is_fitted = !has_faces && CUT.region.mode == MODE_EXACT && EYE.weight.form == FORM_AUTO && !front
        && (beam ? EYE.weight.beam_switch > 0.0 : is_combined);
    float opacity = opacity_on_screen(f, gaussian);
    OpenStrip strip;
    bool has_strip = false;
    if (is_fitted && count == 1u) {
        if (COMBINED && is_combined) {
            source.surface = entry_of(base, 0u);
            vec3 linear;
            vec3 curvature;
            Sight sight = sight_through(source.h0, source.h1, source.h2, vec2(0.0), vec2(0.0));
            if (!beam && carried_bend(sight, source.surface, f.scale, linear, curvature)) {
                write_carried(base, linear, curvature);
                return cutting;
            }
        }
        if (write_curve(base, source, opacity, strip)) {
            return cutting;
        }
        has_strip = HAS_TERMS && is_combined;
    } else if (HAS_TERMS && COMBINED && SEVERAL && is_combined && is_fitted && count == 2u) {
        for (uint i = 0u; i < count; i++) {
            source.surface = entry_of(base, i);
            OpenStrip one = strip_of_surface(source, opacity_extent(opacity));
            if (i == 0u) {
                strip = one;
            } else {
                strip = joined(strip, one, is_or(operators_of(base, i), 0u));
            }
        }
        has_strip = true;
    }
    if (has_strip) {
        write_strip(base, strip, source.conic);
        flags |= CUT_STRIP;
    }
    if (front) {
        flags |= CUT_FRONT;
        cut_records.at[at] = beam_plane(vec4(f.m3, f.view_centre.z));
    }
    cut_records.at[base] = vec4(source.h0.xyz, float(flags | CUT_BEAM));
    cut_records.at[base + 1u] = source.h1;
    cut_records.at[base + 2u] = source.h2;
    return cutting;
}

void main() {
    uint cut = LINEAR_GROUP * SPLAT_GROUP_SIZE + gl_LocalInvocationIndex;
    if (cut >= counts.at[0].cutoff) {
        return;
    }
    uint index = cutoffs.at[cut];
    enter_layer_of_block(index / BLOCK_SIZE);
    uint stride = EYE.weight.cut_stride;
    uint base = cut * stride;
    uint room = LAYER.region.combined != 0u ? RECORD_SURFACES : RECORD_PLANES;
    // There is one copy of the record's code for both.
    for (uint turn = 0u; turn < (MANY ? 2u : 1u); turn++) {
        uint depth;
        uint cutting = write_record(base, room, index, depth);
        if (!MANY || turn > 0u || cutting <= room || cutting > LONG_SURFACES || depth > LONG_DEPTH) {
            return;
        }
        room = cutting;
        uint vectors = CUT_HEADER + (LAYER.region.combined != 0u ? ENTRY_VECTORS : 1u) * room + 1u;
        uint strides = (vectors + stride - 1u) / stride;
        // Where a long record lies depends on the order of these additions, but no pixel does: either all have room, or none is used.
        uint place = atomicAdd(counts.at[0].long_strides, strides);
        atomicAdd(counts.at[0].long_records, 1u);
        if (place + strides > EYE.weight.long_strides) {
            return;
        }
        uint number = CUT.scene.gaussian_count + place;
        cut_records.at[base].w = float(to_uint(cut_records.at[base].w) & ~CUT_STRIP | CUT_LONG);
        cut_records.at[base + stride - 1u].x = uintBitsToFloat(Z_RECORD + number);
        base = number * stride;
    }
}
