// How a Gaussian's spherical harmonics lie in the buffer `sh`: src/passes/sh_storage.rs writes them. Number k is
// coefficient k / 3, channel k % 3. Included by project.comp only, after it has declared `sh`.
//   SH_FLOAT   a word each
//   SH_HALF    two to a word, the first in the low half
//   SH_BYTE    halves: the constant term's three channels, and a scale; then four to a word, 127 being the scale
#ifndef RARA_SH_STORAGE
#define RARA_SH_STORAGE

layout(constant_id = 1) const uint SH_FORMAT = 0u;

// Words of a Gaussian with so many numbers.
uint sh_words(uint numbers) {
    return SH_FORMAT == SH_FLOAT ? numbers : SH_FORMAT == SH_HALF ? (numbers + 1u) / 2u : 2u + numbers / 4u;
}

float sh_half(uint base, uint k) {
    vec2 pair = unpackHalf2x16(sh.at[base + (k >> 1)]);
    return (k & 1u) == 0u ? pair.x : pair.y;
}

// What a byte counts; nothing for the other formats.
float sh_unit(uint base) {
    return SH_FORMAT == SH_BYTE ? unpackHalf2x16(sh.at[base + 1u]).y / 127.0 : 0.0;
}

float sh_number(uint base, float unit, uint k) {
    if (SH_FORMAT == SH_FLOAT) {
        return uintBitsToFloat(sh.at[base + k]);
    }
    if (SH_FORMAT == SH_HALF || k < 3u) {
        return sh_half(base, k);
    }
    uint rest = k - 3u;
    return unit * float(bitfieldExtract(int(sh.at[base + 2u + (rest >> 2)]), int(8u * (rest & 3u)), 8));
}

#endif
