//! The stages of the frame, one file each: buffers in, buffers out. [`frame::STAGES`] lists them in order.

mod bin;
mod block_list;
mod block_order;
mod blocks;
mod buffers;
mod classify;
mod clip;
mod compact;
mod cutoff;
pub(crate) mod depth;
mod depth_keys;
mod frame;
mod kept;
mod laws;
mod layers;
#[cfg_attr(not(feature = "view"), allow(dead_code))]
mod lines;
mod occluders;
mod pair_estimate;
mod pipelines;
mod plan;
mod project;
mod radix;
mod reclip;
mod recording;
mod region;
mod scene_buffers;
mod scene_layer;
mod sh_storage;
mod shaders;
mod shared;
mod sizes;
mod sort;
pub(crate) mod splat;
mod stage;
mod storage;
mod tile_picture;
mod tile_work;
pub(crate) mod tiles;
mod variants;
mod view;
mod weight;
mod work;
#[cfg(feature = "lab")]
mod working;

pub(crate) use buffers::{Buffers, Spare};
pub(crate) use frame::{DRAW, record};
pub(crate) use kept::Kept;
#[cfg(feature = "view")]
pub(crate) use lines::{Lines, PictureLine};
pub(crate) use occluders::Occluders;
pub(crate) use pipelines::Pipelines;
pub(crate) use plan::{Plan, SceneFacts};
pub(crate) use recording::Resources;
pub use scene_buffers::{SceneBuffers, Staging};
pub use scene_layer::SceneLayer;
pub(crate) use sizes::Sizes;
pub(crate) use stage::Targets;
pub(crate) use tile_picture::{TilePicture, TilePixels};
pub(crate) use tile_work::TileWork;
pub(crate) use work::Work;
