// Every number that host and shaders share. build.rs turns each line into a Rust constant of the same name
// (`rara::limits`), so a value stands here and nowhere else.

// Low-pass that 3DGS adds to the projected covariance's diagonal, px^2. Scenes are trained with it.
const float LOW_PASS = 0.3;
// Centres nearer than this along the view axis are culled, world units.
const float NEAR_Z = 0.2;
// The projection's Jacobian is evaluated with x/z and y/z clamped this share of the picture beyond each edge.
const float CLAMP_MARGIN = 0.15;
// Largest opacity of a splat in a pixel.
const float ALPHA_MAX = 0.99;
// 1 / ALPHA_MIN: a splat contributes nothing to a pixel in which its unclipped alpha is below 1/255.
const float ALPHA_MIN_INVERSE = 255.0;
// A cut splat is weighted by the perspective-exact form where sigma_max / Z exceeds this, by the affine form below.
const float BEAM_SWITCH = 0.02;
// Most half-spaces in a clip. Raising it lengthens the frame's uniform block and the cutoff records of such clips.
const uint MAX_CLIP_PLANES = 32u;
// Degree 3: the most coefficients a colour channel has.
const uint MAX_SH_COEFFICIENTS = 16u;
