//! Files to Gaussians and back, and synthetic scenes. No Vulkan, no `unsafe`.

#![forbid(unsafe_code)]

mod bounds;
mod gaussians;
mod generate;
pub mod ply;
mod report;
mod save;

pub use bounds::{Bounds, extent_along};
pub use gaussians::{Gaussians, sh_coefficients};
pub(crate) use generate::random::Random;
pub use generate::{Kind, generate};
pub use ply::{Loaded, load, load_from};
pub use report::{LoadReport, Remark};
pub use save::save_ply;
