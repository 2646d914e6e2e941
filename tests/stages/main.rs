//! What each stage writes on the device, read back and held to its twin in single precision in `src/reference`: integers
//! exactly but for ties, which are said, floats by stated units in the last place.

#![allow(unreachable_pub, reason = "modules of one test share with each other")]

#[path = "../common/mod.rs"]
mod common;
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
