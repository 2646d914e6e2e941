// Real spherical harmonics up to degree 3 with the signs and constants of 3DGS.
#ifndef RARA_SPHERICAL_HARMONICS
#define RARA_SPHERICAL_HARMONICS

const float SH_0 = 0.28209479177387814;
const float SH_1 = 0.4886025119029199;
const float SH_2[5] = float[](1.0925484305920792, -1.0925484305920792, 0.31539156525252005, -1.0925484305920792,
                              0.5462742152960396);
const float SH_3[7] = float[](-0.5900435899266435, 2.890611442640554, -0.4570457994644658, 0.3731763325901154,
                              -0.4570457994644658, 1.445305721320277, -0.5900435899266435);

// The basis functions of a direction; those above `degree` are zero.
void sh_basis(vec3 d, uint degree, out float basis[MAX_SH_COEFFICIENTS]) {
    for (uint i = 0u; i < MAX_SH_COEFFICIENTS; i++) {
        basis[i] = 0.0;
    }
    basis[0] = SH_0;
    if (degree < 1u) {
        return;
    }
    basis[1] = -SH_1 * d.y;
    basis[2] = SH_1 * d.z;
    basis[3] = -SH_1 * d.x;
    if (degree < 2u) {
        return;
    }
    vec3 s = d * d;
    basis[4] = SH_2[0] * d.x * d.y;
    basis[5] = SH_2[1] * d.y * d.z;
    basis[6] = SH_2[2] * (2.0 * s.z - s.x - s.y);
    basis[7] = SH_2[3] * d.x * d.z;
    basis[8] = SH_2[4] * (s.x - s.y);
    if (degree < 3u) {
        return;
    }
    basis[9] = SH_3[0] * d.y * (3.0 * s.x - s.y);
    basis[10] = SH_3[1] * d.x * d.y * d.z;
    basis[11] = SH_3[2] * d.y * (4.0 * s.z - s.x - s.y);
    basis[12] = SH_3[3] * d.z * (2.0 * s.z - 3.0 * s.x - 3.0 * s.y);
    basis[13] = SH_3[4] * d.x * (4.0 * s.z - s.x - s.y);
    basis[14] = SH_3[5] * d.z * (s.x - s.y);
    basis[15] = SH_3[6] * d.x * (s.x - 3.0 * s.y);
}

#endif
