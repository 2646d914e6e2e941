// The share of a normal distribution that lies within a closed mesh, as a sum over its faces. Seen from the mean, a face hides a cone; what
// lies behind the face in it is 1/(4 pi) of the integral, over the face's solid angle, of the part of the distribution that is farther away
// than the face. A mesh's faces together hide what is outside of it, if the mean is inside, and else, less that, what is inside. So the
// sum is the share but for its whole part, and faces that are far away do not count.
//
// In the space where the distribution has deviations of 1 and mean 0, a face at the distance p has an integral that goes around its
// edges: that of 1 - p/r - 2 p (e(p) - e(r)) over the angle about the foot of the mean on its plane, where r is the distance of the
// edge, and e(r) = (Phi(r) - 1/2)/r is smooth. The first two terms give the solid angle, which is known; the rest changes so little that
// four points on an edge suffice to 1e-4. Since whole turns do not count, solid angles are multiplied as complex numbers, not added; an
// edge's part comes from how it lies in the face's plane, which needles leave its digits. Twin: src/reference/region/face_mass.rs.
#ifndef RARA_REGION_FACE_MASS
#define RARA_REGION_FACE_MASS
#include "region/faces.glsl"

// Beyond so many deviations nothing counts.
const float MASS_REACH = 4.5;
// A sum may be off by so much.
const float MASS_DOUBT = 0.02;
// An edge's points are chosen as if it were seen from this far, by half the tangent of half the angle.
const float EDGE_REACH = 2.0;
// Gauss and Legendre's four points, and their weights.
const vec4 EDGE_POINTS = vec4(-0.8611363, -0.3399810, 0.3399810, 0.8611363);
const vec4 EDGE_WEIGHTS = vec4(0.3478548, 0.6521452, 0.6521452, 0.3478548);

// e(r) of squares of r, to 7e-6: its inverse square is 4 r r and a polynomial that falls to nothing.
vec4 excess(vec4 square) {
    vec4 u = min(0.0625 * square, vec4(1.0));
    vec4 low = ((29.669094 * u - 113.81287) * u + 166.47692) * u - 98.476655;
    vec4 rest = (((low * u - 13.395231) * u + 53.764092) * u - 30.498537) * u + 6.2832458;
    return inversesqrt(4.0 * square + rest);
}

// A turn by one angle and another, each of length 1.
vec2 turned(vec2 one, vec2 other) {
    return vec2(one.x * other.x - one.y * other.y, one.x * other.y + one.y * other.x);
}

vec2 of_length_one(vec2 turn) {
    return turn * inversesqrt(max(dot(turn, turn), 1e-30));
}

// A corner of a face as seen from the foot: where it is, and how far it is from the foot and from the mean.
struct FaceCorner {
    vec3 at;
    float from_foot, from_mean;
};

// A face as seen from the mean, and what it hides.
struct FaceSight {
    vec3 normal;
    float p;
    float nearest; // e(p)
    bool is_over; // the foot is on the face
    vec2 turn; // half the solid angle
    float rest; // by how much that is too large
};

void add_hidden_edge(inout FaceSight face, FaceCorner a, FaceCorner b) {
    vec3 along = b.at - a.at;
    along /= max(length(along), 1e-30);
    float start = dot(a.at, along);
    float end = dot(b.at, along);
    float aside = dot(cross(a.at, along), face.normal);
    face.is_over = face.is_over && aside > 0.0;
    float square_p = face.p * face.p;
    float square_aside = aside * aside;
    // The integral of p/r is the difference of two arctangents of p t / (aside r).
    float size = max((square_p + square_aside) * a.from_foot * b.from_foot, 1e-30);
    float cosine = (square_aside * a.from_mean * b.from_mean + square_p * start * end) / size;
    float sine = face.p * aside * (end * a.from_mean - start * b.from_mean) / size;
    vec2 half_turn = cosine > 0.0 ? vec2(1.0 + cosine, sine) : vec2(abs(sine), sine < 0.0 ? cosine - 1.0 : 1.0 - cosine);
    face.turn = turned(face.turn, of_length_one(vec2(half_turn.x, -half_turn.y)));
    float square_reach = square_aside + EDGE_REACH * EDGE_REACH;
    float reach = sqrt(square_reach);
    vec2 ends = vec2(start, end);
    ends /= reach + sqrt(square_reach + ends * ends);
    float half_size = 0.5 * (ends.y - ends.x);
    vec4 at = 0.5 * (ends.x + ends.y) + half_size * EDGE_POINTS;
    vec4 scale = 1.0 / (1.0 - at * at);
    vec4 place = 2.0 * reach * at * scale;
    vec4 square = square_aside + place * place;
    vec4 change = (face.nearest - excess(square_p + square)) / max(square, vec4(1e-12));
    face.rest += 4.0 * face.p * aside * reach * half_size * dot((1.0 + at * at) * scale * scale * change, EDGE_WEIGHTS);
}

// The sum of what faces hide.
struct HiddenSum {
    vec2 turn; // half of their solid angles, less whole turns
    float turns;
    float rest;
    float crossings; // how much more often the mesh winds around the mean than around the place where that is known
};

// Adds a face. `known` is where it is known how often the mesh winds around it.
void add_face(inout HiddenSum sum, Face face, vec3 known) {
    vec3 normal = cross(face.b - face.a, face.c - face.a);
    float size = length(normal);
    if (!(size > 0.0)) {
        return;
    }
    normal /= size;
    float p = dot(normal, face.a);
    // Two faces see the edge between them alike, so that no line slips through it.
    precise vec3 ab = cross(face.a, face.b);
    precise vec3 bc = cross(face.b, face.c);
    precise vec3 ca = cross(face.c, face.a);
    precise vec3 sides = vec3(dot(known, ab), dot(known, bc), dot(known, ca));
    bool is_in_cone = all(greaterThan(sides, vec3(0.0))) || all(lessThan(sides, vec3(0.0)));
    bool is_known_outside = dot(normal, known) > p;
    sum.crossings += is_in_cone && is_known_outside != p < 0.0 ? is_known_outside ? 1.0 : -1.0 : 0.0;
    vec3 low = min(min(face.a, face.b), face.c);
    vec3 high = max(max(face.a, face.b), face.c);
    if (any(greaterThan(low, vec3(MASS_REACH))) || any(lessThan(high, vec3(-MASS_REACH))) || abs(p) > MASS_REACH) {
        return;
    }
    vec3 foot = p * normal;
    face = Face(face.a - foot, face.b - foot, face.c - foot);
    vec3 squares = vec3(dot(face.a, face.a), dot(face.b, face.b), dot(face.c, face.c));
    vec3 from_foot = sqrt(squares);
    vec3 from_mean = sqrt(squares + p * p);
    FaceCorner a = FaceCorner(face.a, from_foot.x, from_mean.x);
    FaceCorner b = FaceCorner(face.b, from_foot.y, from_mean.y);
    FaceCorner c = FaceCorner(face.c, from_foot.z, from_mean.z);
    FaceSight sight = FaceSight(normal, p, excess(vec4(p * p)).x, true, vec2(1.0, 0.0), 0.0);
    add_hidden_edge(sight, a, b);
    add_hidden_edge(sight, b, c);
    add_hidden_edge(sight, c, a);
    vec2 turn = sight.is_over ? -sight.turn : sight.turn;
    // Each is less than half a turn: a sum that goes past half a turn gets the other sign.
    vec2 next = turned(sum.turn, turn);
    bool is_left = sum.turn.y >= 0.0;
    if (is_left != next.y >= 0.0 && is_left == turn.y >= 0.0) {
        sum.turns += is_left ? 1.0 : -1.0;
    }
    sum.turn = of_length_one(next);
    sum.rest += sight.rest;
}

// A space in which a normal distribution has deviations of 1 and mean 0: the map there from that of the faces.
struct EvenSpace {
    mat3 map;
    vec3 mean;
};

// A vertex has no solid angle as seen from itself: the mean is this much aside of where it could be one.
const vec3 NUDGE = vec3(1.1e-5, -2.3e-5, 1.7e-5);

Face in_space(EvenSpace space, Face face) {
    return Face(space.map * face.a - space.mean, space.map * face.b - space.mean, space.map * face.c - space.mean);
}

// The share that a mesh keeps of a normal distribution about a point of the unit space, where its faces do not cut each other. `back` is
// the inverse of its deviations.
float faces_share(uint base, Faces faces, TileFaces list, vec3 mean, mat3 deviations, mat3 back) {
    EvenSpace space = EvenSpace(back * to_unit(faces), back * mean + NUDGE);
    mat3 sizes = mat3(abs(space.map[0]), abs(space.map[1]), abs(space.map[2]));
    // A record knows how often the mesh winds around the centre.
    vec3 known = back * list.known - space.mean;
    HiddenSum sum = HiddenSum(vec2(1.0, 0.0), 0.0, 0.0, 0.0);
    for (FaceWalk walk = face_walk(faces, list);;) {
        while (is_at_node(walk)) {
            WalkedNode node = walked_node(faces, walk.node);
            vec3 from = abs(space.map * (0.5 * (node.low + node.high)) - space.mean);
            vec3 beyond = max(from - sizes * (0.5 * (node.high - node.low)), vec3(0.0));
            enter(walk, node, dot(beyond, beyond) <= MASS_REACH * MASS_REACH);
        }
        Face face;
        if (!takes_face(base, faces, walk, face)) {
            break;
        }
        add_face(sum, in_space(space, face), known);
    }
    float hidden = atan(sum.turn.y, sum.turn.x) * 0.15915494 + sum.turns - 0.07957747 * sum.rest; // 1/(2 pi), 1/(4 pi)
    float share = fract(-hidden);
    // Where hardly anything is kept or dropped, rounding does not say which; how often the mesh winds around the mean does, but on a face.
    if (min(share, 1.0 - share) < MASS_DOUBT) {
        float winding = (is_list(list) ? list.winding : faces.winding) + sum.crossings;
        if (faces.is_walked && !is_list(list)) {
            winding = faces_keep(base, faces, mean + deviations * NUDGE) != faces.keeps_outside ? 1.0 : 0.0;
        }
        float whole = winding - hidden;
        share = whole > -MASS_DOUBT && whole < 1.0 + MASS_DOUBT ? clamp(whole, 0.0, 1.0) : share;
    }
    return faces.keeps_outside ? 1.0 - share : share;
}

#endif
