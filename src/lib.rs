//! rara draws 3D Gaussian Splatting scenes with Vulkan and cuts them exactly.

pub mod camera;
pub mod camera_files;
pub mod clip;
pub mod error;
mod files;
mod framing;
pub mod gpu;
mod half;
pub mod headless;
pub mod limits;
pub mod measure;
mod passes;
pub mod picture;
pub mod precision;
pub mod reference;
pub mod renderer;
pub mod scene;
pub mod settings;
pub mod stats;
pub mod types;

pub use camera::Camera;
pub use clip::{Clip, ClipOp, Plane};
pub use error::{Error, Result};
pub use headless::{Headless, HeadlessDesc};
pub use passes::SceneBuffers;
pub use picture::Picture;
pub use precision::{PhiForm, Precision, Preset, ShFormat, TargetFormat};
pub use renderer::{Renderer, RendererDesc};
pub use scene::Gaussians;
pub use settings::{Decay, ExactForm, Miss, Mode, Raster, Settings};
pub use stats::{Counts, FrameStats, PassTime};
