//! The laboratory of rara: what measures it, and the experiments of the paper. What embeds rara compiles none of it.

#![forbid(unsafe_code)]

pub mod cases;
pub mod charts;
pub mod statistics;
pub mod study;
