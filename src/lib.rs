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

/// The Vulkan device that rara opens or that a host lends, its memory, and its compiled pipelines.
pub mod gpu {
    pub use rara_gpu::{
        AdoptDesc, Bindings, DepthImage, Device, DeviceDesc, DeviceInfo, DeviceShape, Features,
        LentMemory, Location, MemoryRequest, MemorySource, NamedBytes, OnCompile, PassSpan,
        PipelineCache, PipelineCacheId, Support, Target, WriteOnly, check, failed, list_devices,
    };
}

/// Scenes: loading and saving Gaussians, and generating synthetic ones.
pub mod scene {
    #[cfg(feature = "formats")]
    pub use rara_scene::{
        Annotations, FileLayer, Format, LoadOptions, LoadReport, Remark, SaveOptions, SceneFile,
        file_layers, load, load_from, load_from_with, load_layer, load_with, save, save_ply,
        save_with, saved_format, stated_up,
    };
    pub use rara_scene::{
        Attribute, Axis, Bounds, Clusters, Comparison, GaussianArrays, Gaussians, Kind, Layer,
        LayerState, Part, Predicate, Property, Scene, cross_section, extent_along, generate,
        sh_coefficients, sh_of_colour,
    };
    #[cfg(all(feature = "formats", feature = "json"))]
    pub use rara_scene::{layers, trained_folder};
}

/// The crates whose types the interface of this crate uses, in the versions that it uses.
pub use {ash, glam, gpu_allocator};

#[cfg(feature = "bake")]
pub use bake::{BakeCounts, BakeSettings, BakedGaussians, bake, bake_layer};
pub use passes::{LayerEdit, SceneBuffers, SceneLayer, Staging};
#[doc(hidden)]
pub use passes::{Lines, PictureLine};
pub use rara_base::error::{Error, Result};
pub use rara_base::stats::{Counts, PassStatistics};
#[doc(inline)]
pub use rara_gpu::{OnCompile, PipelineCache};
#[cfg(feature = "picture")]
pub use rara_scene::PngCompression;
#[doc(inline)]
pub use rara_scene::{
    Aov, Bounds, Camera, Channel, Clip, ClipOp, Cue, Cues, Decay, DepthMap, ExactForm,
    GaussianArrays, Gaussians, Layer, LayerState, Mesh, MeshReport, MeshRule, Miss, Mode, Ndc,
    PhiForm, Picture, Placement, Plane, Precision, Preset, Projection, Quadric, Raster, Scene,
    Setting, SettingKind, Settings, ShFormat, Shape, Show, SortBy, Surface, TargetFormat, Training,
};
pub use renderer::{
    ColorSpace, ConfiguredFrame, Cut, DepthDesc, ExpectedDepthDesc, FrameLimits, Kept, LayerEditor,
    MotionDesc, Outcome, Pick, PickTicket, Picker, Picks, PreparedFrame, Renderer, RendererDesc,
};
pub use session::{Headless, HeadlessDesc, StoredPicture};
pub use stats::{FrameStats, PassTime, RasterChoice};
pub use trace::Trace;
pub use types::PlainGaussian;
