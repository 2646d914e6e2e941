// Phi with a relative error of 2e-5 in its lower tail, for shares that something is divided by.
#ifndef RARA_TAIL
#define RARA_TAIL

// Mills's ratio Phi(-x) / exp(-x^2 / 2) of x >= 0.
float mills(float x) {
    float t = 1.0 / (1.0 + 0.37 * x);
    return t * (0.14672541 + t * (0.15906193 + t * (0.0711053 + t * (0.21612205 - 0.09302393 * t))));
}

float tail_phi(float z) {
    float tail = exp(-0.5 * z * z) * mills(abs(z));
    return z < 0.0 ? tail : 1.0 - tail;
}

// Phi(z) / Phi(front), at most 1, with a relative error of 4e-5 however little of the normal distribution is left.
float tail_ratio(float z, float front) {
    if (z >= front) {
        return 1.0;
    }
    if (front < 0.0) {
        return exp(0.5 * (front - z) * (front + z)) * mills(-z) / mills(-front);
    }
    return tail_phi(z) / tail_phi(front);
}

#endif
