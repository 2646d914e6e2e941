//! What frames cost a GPU, as far as it can be known without one: the commands that a frame records, how wide its passes are
//! and how long their chains of loads, and what a GPU's compiler makes of its pipelines. `budget.toml` says how much each may
//! have, so that a change that costs more has to change that file too. The same frames are recorded to see that no barrier is missing.
//!
//! The compiler is Mesa's for AMD, RADV, on devices that the library of the package mesa-drm-shim pretends there are. It
//! compiles as for real ones; what it draws there means nothing, and nothing here looks at pictures or times.

#![allow(unreachable_pub, reason = "modules of one test share with each other")]

#[path = "../common/mod.rs"]
mod common;
// What shaders declare, as build.rs reads it.
#[path = "../../src/codegen/spirv.rs"]
#[allow(dead_code, reason = "the names and workgroups are a part of it")]
mod spirv;

mod budget;
mod frames;
mod hazards;
mod model;
mod passes;
mod pipelines;
