//! The laboratory of rara: what measures it, and the experiments of the paper. What embeds rara compiles none of it.

#![forbid(unsafe_code)]

pub mod bench;
pub mod cases;
pub mod charts;
pub mod frames;
pub mod maps;
pub mod measure;
pub mod paper;
pub mod statistics;
pub mod stress;
pub mod study;
pub mod table;
