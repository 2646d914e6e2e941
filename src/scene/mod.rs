//! Files to Gaussians and back, and synthetic scenes. No Vulkan, no `unsafe`.

mod gaussians;

pub use gaussians::{Gaussians, sh_coefficients};
