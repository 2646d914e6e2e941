//! rara draws 3D Gaussian Splatting scenes with Vulkan and cuts them exactly.

pub mod camera;
pub mod clip;
pub mod error;
mod files;
pub mod gpu;
pub mod headless;
pub mod limits;
pub mod measure;
pub mod picture;
pub mod reference;
pub mod scene;
pub mod settings;
pub mod stats;

pub use camera::Camera;
pub use clip::{Clip, ClipOp, Plane};
pub use error::{Error, Result};
pub use headless::{Headless, HeadlessDesc};
pub use picture::Picture;
pub use scene::Gaussians;
pub use settings::{Decay, ExactForm, Miss, Mode, Raster, Settings};
pub use stats::{Counts, FrameStats, PassTime};
