// How a Gaussian's spherical harmonics lie in the buffer `sh`, which src/passes/sh_storage.rs writes. Coefficients are
// r, g, b; number k is coefficient k / 3, channel k % 3. Included by project.comp only, after it has declared `sh`.
//   SH_FLOAT   a word a number
//   SH_HALF    two numbers to a word, the first in the low half
//   SH_PACKED  halves: the constant term's three channels; beside the third, for degrees 1, 2 and 3, five bits each: the
//              exponent of their scale, a power of two; then a word a coefficient: 11, 11 and 10 bits, signed, the
//              largest being its degree's scale
//   SH_BYTE    halves: the constant term's three channels, and a scale; then four to a word, 127 being the scale
#ifndef RARA_SH_STORAGE
#define RARA_SH_STORAGE

layout(constant_id = 1) const uint SH_FORMAT = 0u;

// Words of a Gaussian with so many coefficients a channel.
uint sh_words(uint coefficients) {
    uint numbers = 3u * coefficients;
    return SH_FORMAT == SH_FLOAT ? numbers
        : SH_FORMAT == SH_HALF ? (numbers + 1u) / 2u
        : SH_FORMAT == SH_PACKED ? 1u + coefficients
        : 2u + numbers / 4u;
}

// The first word of a Gaussian.
uint sh_base(uint index) {
    return index * sh_words(CUT.scene.sh_coefficients);
}

float sh_half(uint base, uint k) {
    vec2 pair = unpackHalf2x16(sh.at[base + (k >> 1)]);
    return (k & 1u) == 0u ? pair.x : pair.y;
}

vec3 sh_floats(uint at) {
    return uintBitsToFloat(uvec3(sh.at[at], sh.at[at + 1u], sh.at[at + 2u]));
}

// The constant term, whose first word is given.
vec3 sh_constant(uint base, uint first) {
    return SH_FORMAT == SH_FLOAT ? uintBitsToFloat(uvec3(first, sh.at[base + 1u], sh.at[base + 2u]))
        : vec3(unpackHalf2x16(first), sh_half(base, 2u));
}

// The unit of an integer in each channel, a column for each degree from 1 on; unused where numbers are floats.
mat3 sh_units(uint base) {
    if (SH_FORMAT == SH_PACKED) {
        // The exponents are moved to where a float has its own.
        uvec3 exponents = uvec3(sh.at[base + 1u]) >> uvec3(16u, 21u, 26u) & 31u;
        vec3 scales = uintBitsToFloat(exponents + SH_EXPONENT_BIAS << 23);
        vec3 unit = vec3(1.0 / 1023.0, 1.0 / 1023.0, 1.0 / 511.0);
        return mat3(scales.x * unit, scales.y * unit, scales.z * unit);
    }
    vec3 unit = vec3(SH_FORMAT == SH_BYTE ? unpackHalf2x16(sh.at[base + 1u]).y / 127.0 : 0.0);
    return mat3(unit, unit, unit);
}

float sh_byte(uint base, uint k) {
    uint rest = k - 3u;
    return float(bitfieldExtract(int(sh.at[base + 2u + (rest >> 2)]), int(8u * (rest & 3u)), 8));
}

// Coefficient `i`, from 1 on; `unit` is its degree's column of sh_units().
vec3 sh_coefficient(uint base, vec3 unit, uint i) {
    uint k = 3u * i;
    if (SH_FORMAT == SH_FLOAT) {
        return sh_floats(base + k);
    }
    if (SH_FORMAT == SH_HALF) {
        return vec3(sh_half(base, k), sh_half(base, k + 1u), sh_half(base, k + 2u));
    }
    if (SH_FORMAT == SH_PACKED) {
        int word = int(sh.at[base + 1u + i]);
        return unit * vec3(bitfieldExtract(word, 0, 11), bitfieldExtract(word, 11, 11), word >> 22);
    }
    return unit * vec3(sh_byte(base, k), sh_byte(base, k + 1u), sh_byte(base, k + 2u));
}

#endif
