// The debug view shows a splat's side and weight instead of its colour. Twin: src/reference/splat.rs.
#ifndef RARA_WEIGHT_COLOUR
#define RARA_WEIGHT_COLOUR

// The weight of a splat that is not cut.
const float WEIGHT_WHOLE = 2.0;

// Blue for what is not cut; for what is cut, from red, where nothing is kept, to yellow, where all is.
vec3 weight_colour(float weight) {
    return weight == WEIGHT_WHOLE ? vec3(0.25, 0.45, 0.9) : vec3(1.0, clamp(weight, 0.0, 1.0), 0.0);
}

#endif
