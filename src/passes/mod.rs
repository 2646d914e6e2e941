//! The stages of the frame, one file each: buffers in, buffers out. [`frame`] lists them in order.

mod block_order;
mod blocks;
mod buffers;
mod classify;
mod clip;
mod compact;
mod context;
mod cutoff;
mod depth;
mod depth_keys;
mod frame;
mod occluders;
mod pair_room;
mod plan;
mod project;
mod scene_buffers;
mod sh_storage;
mod shaders;
mod sort;
mod splat;
mod stages;
mod sweep;
mod tiles;
mod work;

pub(crate) use buffers::Buffers;
pub(crate) use context::Context;
pub(crate) use frame::record;
pub(crate) use occluders::Occluders;
pub(crate) use pair_room::PairRoom;
pub(crate) use plan::{Plan, SceneFacts};
pub use scene_buffers::{SceneBuffers, Staging};
pub(crate) use stages::Stages;
pub(crate) use tiles::TileWork;
pub(crate) use work::{Kept, Work};
