//! Scenes: Gaussians, their files and synthetic ones; what cuts them, sees them and places them; the settings of a picture of
//! them, and pictures. No Vulkan, no `unsafe`.
//!
//! Applications use the crate `rara`, which shows what of this is meant for them; the rest may change with any version.

#![forbid(unsafe_code)]

#[cfg(feature = "formats")]
mod annotations;
#[cfg(feature = "formats")]
mod assemble;
mod axis;
mod bounds;
pub mod camera;
#[cfg(feature = "json")]
pub mod camera_files;
pub mod clip;
mod clusters;
mod cross_section;
pub mod depth;
#[cfg(feature = "formats")]
mod failure;
#[cfg(feature = "formats")]
mod format;
#[cfg(feature = "formats")]
mod formats;
mod framing;
mod gaussians;
mod generate;
mod harmonics;
#[cfg(feature = "formats")]
mod input;
#[cfg(feature = "json")]
#[doc(hidden)]
pub mod json_kind;
mod layer;
#[cfg(all(feature = "formats", feature = "json"))]
pub mod layers;
#[cfg(feature = "formats")]
mod load;
pub mod mesh;
mod numbers;
mod parts;
pub mod picture;
mod placed;
pub mod placement;
#[cfg(feature = "formats")]
mod ply;
pub mod precision;
mod predicate;
mod predicate_text;
mod property;
#[cfg(feature = "formats")]
mod report;
#[cfg(feature = "formats")]
mod save;
#[cfg(feature = "formats")]
mod scene_file;
mod setting;
pub mod settings;
mod text_reader;
#[cfg(all(feature = "formats", feature = "json"))]
pub mod trained_folder;
mod training;

pub use camera::{Camera, Ndc, Projection};
pub use clip::{Clip, ClipOp, Plane, Quadric, Shape, Surface};
pub use depth::DepthMap;
#[cfg(feature = "picture")]
pub use picture::PngCompression;
pub use picture::{Aov, Channel, Cue, Cues, Picture};
pub use placement::Placement;
pub use precision::{PhiForm, Precision, Preset, ShFormat, TargetFormat};
pub use setting::{Setting, SettingKind};
pub use settings::{Decay, ExactForm, Miss, Mode, Raster, Settings, Show};

pub use axis::Axis;
#[doc(hidden)]
pub use axis::direction;
pub use bounds::{Bounds, extent_along};
pub use clusters::Clusters;
pub use cross_section::cross_section;
pub use gaussians::{GaussianArrays, Gaussians, sh_coefficients, sh_of_colour};
#[doc(hidden)]
pub use generate::Random;
pub use generate::{Kind, generate};
pub use layer::check_clip;
pub use layer::{Layer, LayerState, Scene};
pub use mesh::{Mesh, MeshReport, MeshRule};
pub use numbers::Numbers;
pub use parts::Part;
pub use predicate::{Attribute, Comparison, Predicate};
pub use property::Property;
pub use training::{SortBy, Training};
#[cfg(feature = "formats")]
pub use {
    annotations::Annotations,
    format::Format,
    formats::{FileLayer, file_layers, load_layer},
    input::LoadOptions,
    load::{load, load_from, load_from_with, load_with},
    ply::stated_up,
    report::{LoadReport, Remark},
    save::{SaveOptions, save, save_ply, save_with, saved_format},
    scene_file::SceneFile,
};

// What examples in the documentation name as users of rara do.
#[doc(hidden)]
pub use text_reader::ShapeTree;
#[doc(hidden)]
pub use {
    glam,
    rara_base::error::{Error, Result},
};
#[doc(hidden)]
pub extern crate self as scene;

/// The spherical harmonic of degree 0: the density of the colour that does not depend on the direction.
const SH_0: f64 = 0.282_094_791_773_878_14;
