// The README's links and pictures lead elsewhere in the generated pages. Markdown takes the first definition of a name,
// so these come first.
#![doc = include_str!("guide/links.md")]
#![cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/layers.md")))]
#![cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/brain.md")))]
#![cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/modes.md")))]
#![doc = include_str!("../README.md")]

#[cfg(feature = "bake")]
mod bake;
mod camera;
#[cfg(feature = "json")]
pub mod camera_files;
pub mod clip;
#[cfg(test)]
mod codegen;
mod depth;
mod error;
mod framing;
pub mod gpu;
pub mod guide;
#[cfg(feature = "json")]
mod json;
mod passes;
mod picture;
mod placement;
mod precision;
mod renderer;
pub mod scene;
mod session;
mod setters;
mod settings;
mod stats;
mod trace;

// The modules that measure and test rara itself. They are public only with the feature `lab`, and any version may change
// them.
#[cfg(feature = "lab")]
pub mod counted;
#[cfg(not(feature = "lab"))]
mod counted;
#[cfg(feature = "lab")]
pub mod files;
#[cfg(not(feature = "lab"))]
mod files;
#[cfg(feature = "lab")]
pub mod fnv;
#[cfg(not(feature = "lab"))]
mod fnv;
#[cfg(feature = "lab")]
pub mod limits;
#[cfg(not(feature = "lab"))]
mod limits;
#[cfg(feature = "lab")]
pub mod reference;
// What bakes asks the reference on which side of a clip a Gaussian is, and nothing else.
#[cfg(all(feature = "bake", not(feature = "lab")))]
#[allow(dead_code, unreachable_pub, unused_imports)]
mod reference;
#[cfg(feature = "lab")]
pub mod types;
#[cfg(not(feature = "lab"))]
mod types;

/// The versions that this crate's interface is made of.
pub use {ash, glam, gpu_allocator};

#[cfg(feature = "bake")]
pub use bake::{BakeCounts, BakeSettings, Baked, bake, bake_layer};
pub use camera::{Camera, Ndc, Projection};
#[doc(inline)]
pub use clip::{Clip, ClipOp, Plane, Quadric, Shape, Surface};
pub use depth::DepthMap;
pub use error::{Error, Result};
#[doc(inline)]
pub use gpu::{OnCompile, PipelineCache};
pub use passes::{SceneBuffers, SceneLayer, Staging};
#[cfg(feature = "picture")]
pub use picture::PngCompression;
pub use picture::{Channel, Cue, Cues, Picture};
pub use placement::Placement;
pub use precision::{PhiForm, Precision, Preset, ShFormat, TargetFormat};
pub use renderer::{
    ColorSpace, ConfiguredFrame, DepthDesc, ExpectedDepthDesc, FrameLimits, Pick, PickTicket,
    Picker, Picks, PreparedFrame, Renderer, RendererDesc,
};
#[doc(inline)]
pub use scene::{Bounds, GaussianArrays, Gaussians, Layer, LayerState, Scene};
pub use session::{Aov, Headless, HeadlessDesc, StoredPicture};
#[cfg(feature = "view")]
pub use session::{Line, Panel, Redraw, Windowed};
pub use settings::{Decay, ExactForm, Miss, Mode, Raster, Settings, Show};
pub use stats::{Counts, FrameStats, PassStatistics, PassTime, RasterChoice};
pub use trace::Trace;
