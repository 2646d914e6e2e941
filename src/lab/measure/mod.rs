//! Measures: how far apart two pictures are, and what drawing them costs.

#![forbid(unsafe_code)]

mod pareto;
mod popping;
mod processor;
mod qualities;

pub use pareto::undominated;
pub use popping::{Popping, popping};
pub use processor::processor_ms;
pub use qualities::{Qualities, Truth, edge_distance, pieces_apart, share_of_way};

pub use rara_reference::comparison::{Comparison, Pixels, compare, compare_within};
pub use rara_reference::differences::{Differences, differences, psnr, same_size};
