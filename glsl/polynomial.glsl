// Polynomials in a splat's own coordinates u and v, in which alpha is opacity exp(-(u^2 + v^2) / 2): no pixel that counts is far
// from 0, and no power of a coordinate is large.
#ifndef RARA_POLYNOMIAL
#define RARA_POLYNOMIAL

// at + slope . (u, v) + bend . (u^2, u v, v^2) + twist . (u^3, u^2 v, u v^2, v^3)
//     + wave . (u^4, u^3 v, u^2 v^2, u v^3) + ripple v^4.
struct Curve {
    float at;
    vec2 slope;
    vec3 bend;
    vec4 twist;
    vec4 wave;
    float ripple;
};

// A curve as cutoff records hold it.
Curve curve_of(vec4 linear, vec4 bend, vec4 twist, vec4 wave) {
    return Curve(linear.x, linear.yz, bend.xyz, twist, wave, bend.w);
}

// A curve where u is given, a polynomial in v.
struct Section {
    float at, slope, bend, twist, ripple;
};

Section section(Curve c, float u) {
    Section s;
    s.at = c.at + u * (c.slope.x + u * (c.bend.x + u * (c.twist.x + u * c.wave.x)));
    s.slope = c.slope.y + u * (c.bend.y + u * (c.twist.y + u * c.wave.y));
    s.bend = c.bend.z + u * (c.twist.z + u * c.wave.z);
    s.twist = c.twist.w + u * c.wave.w;
    s.ripple = c.ripple;
    return s;
}

float section_z(Section s, float v) {
    return s.at + v * (s.slope + v * (s.bend + v * (s.twist + v * s.ripple)));
}

float curve_z(Curve c, vec2 d) {
    return section_z(section(c, d.x), d.y);
}

#endif
