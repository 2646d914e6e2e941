//! Vulkan without a single Gaussian: device, memory, accesses and barriers, recording, pipelines, timing.
//!
//! Everything here records into a command buffer that somebody else submits. The exceptions are [`Device::headless`],
//! [`Device::submit_and_wait`] with the uploads and downloads built on it, and the submissions of frames
//! in flight, as a window has them.
//!
//! Applications use the crate `rara`, which shows what of this is meant for them; the rest may change with any version.

mod access;
mod account;
mod ahead;
mod allocation;
mod attachments;
mod clock;
mod commands;
mod deferred;
mod depth_image;
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
#[doc(hidden)]
#[allow(missing_docs)] // no application sees it, nor the next ones
pub mod image;
#[cfg(feature = "lab")]
mod inspection;
#[cfg(feature = "lab")]
#[allow(missing_docs)]
mod inspector;
mod instance;
mod label;
mod layout;
mod lent;
#[allow(missing_docs)]
mod memory;
#[cfg(feature = "lab")]
mod modules;
mod open;
#[allow(missing_docs)]
mod pipeline;
mod pipeline_cache;
mod pipeline_file;
mod recorder;
mod requirements;
#[allow(missing_docs)]
mod shader;
mod shape;
mod specialized;
mod submission;
mod submit;
#[cfg(any(test, feature = "lab"))]
#[doc(hidden)]
pub mod testing;
mod timer;
mod tracker;
mod upload;
mod validation;
mod write_only;

pub use account::NamedBytes;
pub use attachments::{Attachments, DepthAttachment, Target};
pub use depth_image::{DepthImage, DepthUnder};
pub use desc::{AdoptDesc, DeviceDesc};
pub use device::{Device, OnCompile};
pub use devices::{DeviceInfo, list_devices};
pub use draw::Drawer;
pub use failure::failed;
pub use features::Features;
pub use image::{Image, ImageDesc};
#[cfg(feature = "lab")]
pub use inspector::{CompiledShader, DispatchNote, DispatchedGroups, RecordedCommands};
pub use lent::{LentMemory, Location, MemoryRequest, MemorySource};
pub use memory::{Buffer, BufferDesc};
#[cfg(feature = "lab")]
#[doc(hidden)]
pub use modules::replace_modules;
pub use pipeline::{ComputeDesc, ComputePipeline, DepthUse, GraphicsDesc, GraphicsPipeline};
pub use pipeline_cache::PipelineCacheId;
pub use pipeline_file::{PipelineCache, PipelineFile};
pub use recorder::{Groups, Recorder};
pub use requirements::{LEAST_SUBGROUP, Support, check};
pub use shader::{Bindings, BufferAccess, BufferUse, MAX_BUFFERS, Shader};
pub use shape::DeviceShape;
pub use timer::{PassSpan, Timer, measures_dispatches};
pub use write_only::WriteOnly;
#[doc(hidden)]
pub use {
    access::Access,
    clock::Calibration,
    instance::Instance,
    recorder::group_grid,
    requirements::offers,
    shader::MAX_PARAMS,
    submission::Submission,
    tracker::{Draws, Tracker},
};
