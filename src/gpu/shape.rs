//! The kind of machine that a device is, which decides which pipelines suit it.

use ash::vk;

use super::devices::DeviceInfo;
use super::requirements::Support;
use rara_base::error::{Error, Result};

/// The kind of machine that runs the stages. It decides which pipelines are used and how finely their work is divided;
/// pictures depend on it only by the rounding of sums.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(tag = "kind", rename_all = "lowercase"))]
pub enum DeviceShape {
    /// A driver that runs shaders on the processor's cores: few invocations that each do much.
    Cpu,
    /// A graphics processor: many invocations, whose memory accesses are served together.
    Gpu {
        /// The invocations of a subgroup that pipelines ask for, a power of two within [`Support::full_subgroups`]; 0 for
        /// pipelines without subgroup operations.
        subgroup: u32,
    },
}

/// The size that pipelines were written with in mind. Drivers that offer several take it; the others have one.
const USUAL_SUBGROUP: u32 = 32;

/// The shared memory of a workgroup that pipelines for GPUs take at most, bytes.
const SHARED_MEMORY: u32 = 28 << 10;

impl DeviceShape {
    /// The shape of a device and the reason for it: the one that is wanted, or else the one that suits its kind.
    #[doc(hidden)]
    pub fn choose(
        info: &DeviceInfo,
        support: &Support,
        wanted: Option<Self>,
        from_environment: Option<Self>,
    ) -> Result<(Self, &'static str)> {
        if let Some(shape) = wanted {
            shape.check(support)?;
            return Ok((shape, "asked for by the device's description"));
        }
        if let Some(shape) = from_environment {
            return Ok((shape, "asked for by RARA_SHAPE"));
        }
        Ok(match info.kind {
            vk::PhysicalDeviceType::CPU => (Self::Cpu, "a CPU driver"),
            _ if support.max_shared_memory < SHARED_MEMORY => {
                (Self::Cpu, "a GPU with little shared memory")
            }
            _ => (Self::gpu(support), "a GPU"),
        })
    }

    /// The shape that `RARA_SHAPE` asks for, if it is set; one that the device can have.
    pub(crate) fn from_environment(support: &Support) -> Result<Option<Self>> {
        let Some(text) = std::env::var_os("RARA_SHAPE") else {
            return Ok(None);
        };
        let shape = Self::named(&text.to_string_lossy(), support)?;
        shape.check(support).map(|()| Some(shape))
    }

    /// A GPU's shape with the subgroups that suit a device.
    fn gpu(support: &Support) -> Self {
        let [least, most] = support.full_subgroups;
        Self::Gpu {
            subgroup: USUAL_SUBGROUP.clamp(least, most),
        }
    }

    /// The shape that `RARA_SHAPE` names: `cpu`, `gpu`, or `gpu:N` for subgroups of N.
    fn named(text: &str, support: &Support) -> Result<Self> {
        let shape = match text.split_once(':') {
            None if text == "cpu" => Some(Self::Cpu),
            None if text == "gpu" => Some(Self::gpu(support)),
            Some(("gpu", size)) => size.parse().ok().map(|subgroup| Self::Gpu { subgroup }),
            _ => None,
        };
        shape.ok_or_else(|| {
            Error::Invalid(format!(
                "RARA_SHAPE is {text:?}; it can be cpu, gpu, or gpu:N with subgroups of N invocations"
            ))
        })
    }

    /// Refuses subgroups that the device cannot be asked for.
    fn check(self, support: &Support) -> Result<()> {
        let [least, most] = support.full_subgroups;
        match self {
            Self::Gpu { .. } if support.max_shared_memory < SHARED_MEMORY => {
                Err(Error::Invalid(format!(
                    "the pipelines for GPUs need {SHARED_MEMORY} bytes of shared memory, and this device has {} \
                     (maxComputeSharedMemorySize)",
                    support.max_shared_memory
                )))
            }
            Self::Gpu { subgroup }
                if subgroup != 0
                    && !(subgroup.is_power_of_two() && (least..=most).contains(&subgroup)) =>
            {
                Err(Error::Invalid(format!(
                    "whole subgroups of {subgroup} invocations cannot be had: this device has them from {least} to {most} \
                     (0: none, or subgroupSizeControl and computeFullSubgroups are not enabled)"
                )))
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
