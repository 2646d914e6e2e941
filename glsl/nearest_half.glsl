// The nearest 16-bit float, as src/passes/sh_storage.rs finds it: packHalf2x16 may round in any direction.
#ifndef RARA_NEAREST_HALF
#define RARA_NEAREST_HALF

// Its bits. Ties go to even; a value beyond the largest, or no number, becomes the largest.
uint nearest_half(float value) {
    const uint LARGEST = 0x477fe000u; // 65504
    const uint LEAST_NORMAL = 0x38800000u; // 2^-14
    uint bits = floatBitsToUint(value);
    uint sign = bits >> 16 & 0x8000u;
    uint size = min(bits & 0x7fffffffu, LARGEST);
    if (size < LEAST_NORMAL) {
        return sign | uint(roundEven(uintBitsToFloat(size) * 16777216.0)); // multiples of 2^-24
    }
    uint even = size >> 13 & 1u;
    return sign | (size - (SH_EXPONENT_BIAS << 23) + 0xfffu + even) >> 13;
}

#endif
