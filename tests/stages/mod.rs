//! The buffers that each stage writes on the device are read back and compared with the stage's twin in single
//! precision in `src/reference`: integers exactly except for ties, which are counted, floats to stated units in the
//! last place.

mod frame;
mod layers;
mod ties;

mod bin;
mod classify;
mod clip;
mod compact;
mod cutoff;
mod depth;
mod project;
mod sort;
mod sweep;
