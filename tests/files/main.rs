//! Tests that need no device: files of scenes and cameras, and the benchmark's arithmetic.

mod benchmark;
mod cameras;
mod in_memory;
mod ply;
mod regressions;
