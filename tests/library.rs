//! The tests of the library in one executable: a module for each room, as `tools/rooms` has them.

#![allow(unreachable_pub, reason = "modules of one test share with each other")]

#[path = "common/canvas/mod.rs"]
mod canvas;
mod common;
// What shaders declare, as build.rs reads it.
#[path = "../src/codegen/spirv.rs"]
#[allow(dead_code, reason = "the names and workgroups are a part of it")]
mod spirv;

mod alone;
mod api;
mod files;
mod gpu_cost;
mod host;
mod pictures;
mod portability;
mod shapes;
mod stages;
