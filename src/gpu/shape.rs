//! The kind of machine that a device is, which decides which kernels suit it.

use ash::vk;

use super::DeviceInfo;

/// The kind of machine that runs the stages. It decides which kernels are used and how finely their work is divided;
/// pictures depend on it only by the rounding of sums.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DeviceShape {
    /// A driver that runs shaders on the processor's cores: few invocations that each do much.
    Cpu,
    /// A graphics processor: many invocations, whose memory accesses are served together.
    Gpu,
}

impl DeviceShape {
    /// The kind of a device, unless `RARA_SHAPE` says otherwise: tests run the kernels of either kind on any device.
    pub(crate) fn of(info: &DeviceInfo) -> Self {
        let is = match info.kind {
            vk::PhysicalDeviceType::CPU => Self::Cpu,
            _ => Self::Gpu,
        };
        match std::env::var("RARA_SHAPE").as_deref() {
            Ok("cpu") => Self::Cpu,
            Ok("gpu") => Self::Gpu,
            Ok(other) => {
                log::warn!("RARA_SHAPE is {other:?}, neither cpu nor gpu: it is ignored");
                is
            }
            Err(_) => is,
        }
    }
}
