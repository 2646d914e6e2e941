//! Files to Gaussians and back, and synthetic scenes. No Vulkan, no `unsafe`.

#![forbid(unsafe_code)]

mod bounds;
mod gaussians;
mod generate;
mod layer;
#[cfg(feature = "ply")]
mod load;
mod numbers;
mod parts;
#[cfg(feature = "ply")]
mod ply;
#[cfg(feature = "ply")]
mod report;
#[cfg(feature = "ply")]
mod save;

pub use bounds::{Bounds, extent_along};
pub use gaussians::{GaussianArrays, Gaussians, sh_coefficients};
#[cfg(feature = "lab")]
pub(crate) use generate::random::Random;
pub use generate::{Kind, generate};
pub(crate) use layer::check_clip;
pub use layer::{Layer, LayerState, Scene};
pub(crate) use numbers::Numbers;
pub use parts::Part;
#[cfg(feature = "ply")]
pub use {
    load::{Loaded, load, load_from},
    report::{LoadReport, Remark},
    save::save_ply,
};
