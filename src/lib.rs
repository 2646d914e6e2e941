// The README's links and pictures lead elsewhere in the generated pages. Markdown takes the first definition of a name,
// so these come first.
#![doc = include_str!("guide/links.md")]
#![cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/layers.md")))]
#![cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/brain.md")))]
#![cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/modes.md")))]
#![doc = include_str!("../README.md")]

#[cfg(feature = "bake")]
mod bake;
#[cfg(test)]
mod codegen;
pub mod guide;
mod passes;
mod renderer;
mod session;
mod stats;
mod trace;
#[doc(hidden)]
pub mod types;

#[cfg(feature = "json")]
pub use rara_scene::camera_files;
pub use rara_scene::clip;

/// Vulkan without a single Gaussian: the device that is opened or lent, its memory, and the pipelines that are kept.
pub mod gpu {
    pub use rara_gpu::{
        AdoptDesc, Bindings, DepthImage, Device, DeviceDesc, DeviceInfo, DeviceShape, Features,
        LentMemory, Location, MemoryRequest, MemorySource, NamedBytes, OnCompile, PassSpan,
        PipelineCache, PipelineCacheId, Support, Target, WriteOnly, check, failed, list_devices,
    };
}

/// Files to Gaussians and back, and synthetic scenes.
pub mod scene {
    #[cfg(feature = "formats")]
    pub use rara_scene::{
        Annotations, Format, LoadReport, Remark, SaveOptions, SceneFile, load, load_from,
        load_from_with, load_with, save, save_ply, save_with, saved_format,
    };
    pub use rara_scene::{
        Attribute, Bounds, Comparison, GaussianArrays, Gaussians, Kind, Layer, LayerState, Part,
        Predicate, Property, Scene, cross_section, extent_along, generate, sh_coefficients,
    };
}

/// The versions that this crate's interface is made of.
pub use {ash, glam, gpu_allocator};

#[cfg(feature = "bake")]
pub use bake::{BakeCounts, BakeSettings, BakedGaussians, bake, bake_layer};
pub use passes::{SceneBuffers, SceneLayer, Staging};
pub use rara_base::error::{Error, Result};
pub use rara_base::stats::{Counts, PassStatistics};
#[doc(inline)]
pub use rara_gpu::{OnCompile, PipelineCache};
#[cfg(feature = "picture")]
pub use rara_scene::PngCompression;
#[doc(inline)]
pub use rara_scene::{
    Aov, Bounds, Camera, Channel, Clip, ClipOp, Cue, Cues, Decay, DepthMap, ExactForm,
    GaussianArrays, Gaussians, Layer, LayerState, Miss, Mode, Ndc, PhiForm, Picture, Placement,
    Plane, Precision, Preset, Projection, Quadric, Raster, Scene, Settings, ShFormat, Shape, Show,
    SortBy, Surface, TargetFormat, Training,
};
pub use renderer::{
    ColorSpace, ConfiguredFrame, DepthDesc, ExpectedDepthDesc, FrameLimits, Pick, PickTicket,
    Picker, Picks, PreparedFrame, Renderer, RendererDesc,
};
pub use session::{Headless, HeadlessDesc, StoredPicture};
#[cfg(feature = "view")]
pub use session::{Line, Panel, Redraw, Windowed};
pub use stats::{FrameStats, PassTime, RasterChoice};
pub use trace::Trace;
