// Where lines cross the faces of a mesh. Twin: src/scene/mesh/packed.rs.
#ifndef RARA_REGION_FACE_CROSSING
#define RARA_REGION_FACE_CROSSING

// A face's corners, which turn to the left as seen from outside.
struct Face {
    vec3 a, b, c;
};

// The face of a list of nine words each without gaps. They begin in a quad behind so many other words, and end at most two quads later.
Face packed_face(uint before, vec4 x, vec4 y, vec4 z) {
    vec4 a = before >= 2u ? vec4(x.zw, y.xy) : x;
    vec4 b = before >= 2u ? vec4(y.zw, z.xy) : y;
    vec2 c = before >= 2u ? z.zw : z.xy;
    bool is_odd = (before & 1u) != 0u;
    return is_odd ? Face(a.yzw, b.xyz, vec3(b.w, c)) : Face(a.xyz, vec3(a.w, b.xy), vec3(b.zw, c.x));
}

// Where a line crosses faces. It is sheared onto the axis along which it goes fastest, so that all edges are looked at along it.
struct FaceLine {
    vec3 origin;
    uint axis;
    vec2 slope;
    float speed;
};

vec3 turned_to_axis(vec3 v, uint axis) {
    return axis == 0u ? v.yzx : axis == 1u ? v.zxy : v;
}

FaceLine face_line(vec3 origin, vec3 direction) {
    vec3 size = abs(direction);
    uint axis = size.x > size.y && size.x > size.z ? 0u : size.y > size.z ? 1u : 2u;
    vec3 along = turned_to_axis(direction, axis);
    return FaceLine(origin, axis, along.xy / along.z, along.z);
}

vec3 sheared(FaceLine line, vec3 corner) {
    vec3 p = turned_to_axis(corner - line.origin, line.axis);
    return vec3(p.xy - line.slope * p.z, p.z);
}

// An edge's ends as all faces that share it see them, and where it passes the line: above it or below. An edge passes it only if
// its ends lie on both sides.
void add_edge(vec3 from, vec3 to, inout float turns, inout vec2 above, inout vec2 below) {
    bool is_left = from.x < 0.0;
    if (is_left == to.x < 0.0) {
        return;
    }
    vec3 left = is_left ? from : to;
    vec3 right = is_left ? to : from;
    float share = left.x / (left.x - right.x);
    vec2 at = clamp(mix(left.yz, right.yz, share), min(left.yz, right.yz), max(left.yz, right.yz));
    if (at.x >= 0.0) {
        turns += is_left ? -1.0 : 1.0;
        above = at;
    } else {
        below = at;
    }
}

// Where a line crosses a face, and by how much the winding number grows there: 0 where it does not. Over a closed mesh all these
// add up to 0 exactly: no line slips through an edge or a vertex, and none crosses there twice, however it is rounded.
float face_crossing(FaceLine line, Face face, out float t) {
    vec3 a = sheared(line, face.a);
    vec3 b = sheared(line, face.b);
    vec3 c = sheared(line, face.c);
    float turns = 0.0;
    vec2 above = vec2(0.0);
    vec2 below = vec2(0.0);
    add_edge(a, b, turns, above, below);
    add_edge(b, c, turns, above, below);
    add_edge(c, a, turns, above, below);
    float z = clamp(mix(below.y, above.y, below.x / (below.x - above.x)), min(below.y, above.y), max(below.y, above.y));
    t = z / line.speed;
    return turns == 0.0 ? 0.0 : line.speed > 0.0 ? -turns : turns;
}

#endif
