//! Files to Gaussians and back, and synthetic scenes. No Vulkan, no `unsafe`.

#![forbid(unsafe_code)]

#[cfg(feature = "ply")]
mod assemble;
mod bounds;
mod cross_section;
#[cfg(feature = "ply")]
mod format;
#[cfg(feature = "formats")]
mod formats;
mod gaussians;
mod generate;
mod layer;
#[cfg(feature = "ply")]
mod load;
mod numbers;
mod parts;
mod placed;
#[cfg(feature = "ply")]
mod ply;
mod predicate;
mod predicate_text;
mod property;
#[cfg(feature = "ply")]
mod report;
#[cfg(feature = "ply")]
mod save;

pub use bounds::{Bounds, extent_along};
pub use cross_section::cross_section;
pub use gaussians::{GaussianArrays, Gaussians, sh_coefficients};
#[doc(hidden)]
pub use generate::Random;
pub use generate::{Kind, generate};
pub(crate) use layer::check_clip;
pub use layer::{Layer, LayerState, Scene};
pub(crate) use numbers::Numbers;
pub use parts::Part;
pub use predicate::{Attribute, Comparison, Predicate};
pub use property::Property;
#[cfg(feature = "ply")]
pub use {
    format::Format,
    load::{Loaded, load, load_from, load_from_with, load_with},
    report::{LoadReport, Remark},
    save::{save, save_ply, saved_format},
};

/// The spherical harmonic of degree 0: the density of the colour that does not depend on the direction.
const SH_0: f64 = 0.282_094_791_773_878_14;
