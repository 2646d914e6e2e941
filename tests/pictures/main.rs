//! What is drawn: against the reference, against itself by other ways, in time and in memory.

#[path = "../common/mod.rs"]
mod common;

mod accuracy;
mod agreement;
mod classification;
mod curves;
mod debug_view;
mod determinism;
mod invariance;
mod large;
mod layers;
mod memory;
mod paper;
mod pipeline_cache;
mod precision;
mod reuse;
mod stress;
