//! Tests that need no device: files of scenes and cameras.

mod cameras;
mod colmap;
mod formats;
mod in_memory;
mod ply;
mod regressions;
mod shared;
mod trained;
