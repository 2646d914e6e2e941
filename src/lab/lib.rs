//! The laboratory of rara: what measures it, and the experiments of the paper. What embeds rara compiles none of it.

pub mod cases;
pub mod measure;
pub mod stress;
