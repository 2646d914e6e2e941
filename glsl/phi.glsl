// The normal distribution. Included after the constant PHI_FORM is declared.
#ifndef RARA_PHI
#define RARA_PHI
#include "types.glsl"

// Phi by a logistic of an odd quintic: its absolute error is 1.9e-5, and Phi(z) + Phi(-z) = 1 to rounding. Beyond |z| = 8
// the quintic would turn back.
float phi(float z) {
    float x = clamp(z, -8.0, 8.0);
    float s = x * x;
    if (PHI_FORM == PHI_LOGISTIC) {
        return 1.0 / (1.0 + exp2(-2.4550345 * x)); // 9.5e-3
    }
    if (PHI_FORM == PHI_CUBIC) {
        return 1.0 / (1.0 + exp2(-x * (2.3048539 + s * 0.1018025))); // 1.4e-4
    }
    return 1.0 / (1.0 + exp2(-x * (2.3017272 + s * (0.10617733 - 9.1122696e-4 * s))));
}

#endif
