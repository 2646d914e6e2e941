//! Vulkan without a single Gaussian: device, memory, accesses and barriers, recording, pipelines, timing.
//!
//! Everything here records into a command buffer that somebody else submits. The exceptions are [`Device::headless`],
//! [`Device::submit_and_wait`] with the uploads and downloads built on it, and a window's surface, swapchain and frames in
//! flight.

#![cfg_attr(
    not(feature = "lab"),
    allow(
        dead_code,
        unreachable_pub,
        reason = "tests and measurements use more of it than frames do"
    )
)]

mod access;
mod account;
mod ahead;
mod allocation;
mod attachments;
mod clock;
mod commands;
mod desc;
mod device;
mod devices;
mod draw;
mod failure;
#[cfg(any(test, feature = "lab"))]
#[doc(hidden)]
pub mod faults;
mod features;
mod functions;
mod image;
#[cfg(feature = "view")]
mod in_flight;
#[cfg(feature = "lab")]
mod inspection;
#[cfg(feature = "lab")]
mod inspector;
mod instance;
mod label;
mod layout;
mod lent;
mod memory;
mod one_off;
mod open;
mod pipeline;
mod pipeline_cache;
mod pipeline_file;
mod recorder;
mod requirements;
mod shader;
mod shape;
mod submit;
#[cfg(feature = "view")]
mod surface;
#[cfg(feature = "view")]
mod swapchain;
#[cfg(any(test, feature = "lab"))]
#[doc(hidden)]
pub mod testing;
mod timer;
mod tracker;
mod upload;
mod validation;
mod write_only;

pub use account::NamedBytes;
pub use attachments::Target;
pub use desc::{AdoptDesc, DeviceDesc};
pub use device::{Device, OnCompile};
pub use devices::{DeviceInfo, list_devices};
pub use failure::failed;
pub use features::Features;
pub use lent::{LentMemory, Location, MemoryRequest, MemorySource};
pub use pipeline_cache::PipelineCacheId;
pub use pipeline_file::PipelineCache;
pub use recorder::DepthImage;
pub use requirements::LEAST_SUBGROUP;
pub use requirements::{Support, check};
pub use shader::Bindings;
pub use shape::DeviceShape;
pub use timer::PassSpan;
pub use write_only::WriteOnly;

#[cfg(not(feature = "lab"))]
pub use inner::*;
#[cfg(feature = "lab")]
pub use inner::*;
pub use pipeline_file::PipelineFile;
#[cfg(feature = "view")]
pub use {
    in_flight::{FRAMES, InFlight},
    surface::{Surface, Window},
    swapchain::Swapchain,
};

/// The tools that frames are recorded with; public for tests and measurements only.
mod inner {
    pub use super::attachments::{Attachments, DepthAttachment};
    pub use super::draw::Drawer;
    pub use super::image::{Image, ImageDesc};
    #[cfg(feature = "lab")]
    pub use super::inspector::{CompiledShader, Dispatched, DispatchedGroups, Recorded};
    pub use super::memory::{Buffer, BufferDesc};
    pub use super::pipeline::{ComputeDesc, ComputePipeline, GraphicsDesc, GraphicsPipeline};
    #[cfg(feature = "lab")]
    pub use super::recorder::group_grid;
    pub use super::recorder::{Groups, Recorder};
    pub use super::shader::{BufferAccess, BufferUse, MAX_BUFFERS, Shader};
    pub use super::timer::Timer;
    #[cfg(feature = "lab")]
    pub use super::{access::Access, clock::Calibration, shader::MAX_PARAMS, tracker::Tracker};
}
