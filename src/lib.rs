// The README's links and pictures lead elsewhere among generated pages: of a name's definitions the first counts.
#![doc = include_str!("guide/links.md")]
#![cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/layers.md")))]
#![doc = include_str!("../README.md")]

pub mod camera;
#[cfg(feature = "json")]
pub mod camera_files;
pub mod clip;
#[cfg(test)]
mod codegen;
pub mod depth;
pub mod error;
pub mod files;
mod framing;
pub mod gpu;
pub mod guide;
#[cfg(feature = "json")]
mod json;
pub mod limits;
#[cfg(feature = "lab")]
pub mod measure;
mod passes;
pub mod picture;
pub mod placement;
pub mod precision;
#[cfg(feature = "lab")]
pub mod reference;
pub mod renderer;
pub mod scene;
mod session;
pub mod settings;
pub mod stats;
#[cfg(feature = "lab")]
pub mod stress;
pub mod trace;
pub mod types;

/// The versions that this crate's interface is made of.
pub use {ash, glam, gpu_allocator};

pub use camera::Camera;
pub use clip::{Clip, ClipOp, Plane};
pub use depth::DepthMap;
pub use error::{Error, Result};
pub use gpu::PipelineCache;
pub use passes::{SceneBuffers, Staging};
pub use picture::Picture;
pub use placement::Placement;
pub use precision::{PhiForm, Precision, Preset, ShFormat, TargetFormat};
pub use renderer::{DepthDesc, ExpectedDepthDesc, Renderer, RendererDesc};
pub use scene::Gaussians;
pub use session::{Headless, HeadlessDesc};
#[cfg(feature = "view")]
pub use session::{Redraw, Windowed};
pub use settings::{Decay, ExactForm, Miss, Mode, Raster, Settings, Show};
pub use stats::{Counts, FrameStats, PassStatistics, PassTime, RasterChoice};
pub use trace::Trace;
