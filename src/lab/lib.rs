//! The laboratory of rara: what measures it, and the experiments of the paper. What embeds or draws with rara compiles none of
//! it; the program `rara-lab` runs it.

#![deny(unsafe_code)] // only what measures Vulkan itself needs it
#![allow(missing_docs)] // it is no API

pub mod bench;
pub mod cases;
pub mod charts;
pub mod frames;
pub mod measure;
pub mod paper;
pub mod run_time;
pub mod statistics;
pub mod stress;
pub mod study;
pub mod table;
