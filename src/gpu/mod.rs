//! Vulkan without a single Gaussian: device, memory, accesses and barriers, recording, pipelines, timing.

mod shader;

pub use shader::{BufferAccess, BufferUse, MAX_BUFFERS, MAX_PARAMS, Shader};
