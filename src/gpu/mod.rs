//! Vulkan without a single Gaussian: device, memory, accesses and barriers, recording, pipelines, timing.
//!
//! Everything here records into a command buffer that somebody else submits, except [`Device::headless`],
//! [`Device::submit_and_wait`] and the uploads and downloads built on it, and what a window needs: surface, swapchain
//! and frames in flight.

mod access;
mod attachments;
mod clock;
mod commands;
mod device;
mod devices;
mod draw;
mod failure;
#[cfg(test)]
pub(crate) mod faults;
mod image;
#[cfg(feature = "view")]
mod in_flight;
mod instance;
mod layout;
mod memory;
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
mod timer;
mod tracker;
mod upload;
mod validation;

pub use access::Access;
pub use attachments::{Attachments, DepthAttachment, Target};
pub use clock::Calibration;
pub use device::{Device, NamedBytes};
pub use devices::{DeviceInfo, list_devices};
pub use draw::Drawer;
pub use image::{Image, ImageDesc};
#[cfg(feature = "view")]
pub(crate) use in_flight::{FRAMES, InFlight};
pub use layout::Bindings;
pub use memory::{Buffer, BufferDesc, Location};
pub use open::{AdoptDesc, DeviceDesc};
pub use pipeline::{ComputeDesc, ComputePipeline, GraphicsDesc, GraphicsPipeline};
pub use pipeline_cache::PipelineCacheId;
pub use pipeline_file::PipelineCache;
pub(crate) use pipeline_file::PipelineFile;
pub use recorder::{DepthImage, Groups, Recorder, group_grid};
pub use requirements::{Features, Support, check};
pub use shader::{BufferAccess, BufferUse, MAX_BUFFERS, MAX_PARAMS, Shader};
pub use shape::Shape;
#[cfg(feature = "view")]
pub(crate) use surface::{Surface, Window};
#[cfg(feature = "view")]
pub(crate) use swapchain::Swapchain;
pub use timer::{PassSpan, Timer};
pub use tracker::Tracker;
