//! Device memory: from an allocator, or from the functions of a host that has one of its own.

use std::ffi::c_void;
use std::ptr::NonNull;
use std::sync::{MutexGuard, PoisonError};

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, Allocator};

use super::memory::Location;
use super::{Device, WriteOnly};

/// What a [`MemorySource`] is asked for.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct MemoryRequest<'a> {
    /// What it is for, such as the name of a buffer.
    pub name: &'a str,
    /// The size, the alignment and the types that will do.
    pub requirements: vk::MemoryRequirements,
    /// Who reaches it.
    pub location: Location,
}

/// A part of device memory that a [`MemorySource`] lends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LentMemory {
    /// The memory.
    pub memory: vk::DeviceMemory,
    /// Where the part begins in it, bytes; aligned as was asked for.
    pub offset: u64,
    /// The part as the host's processor sees it; null for [`Location::GpuOnly`].
    pub mapped: *mut c_void,
    /// Whatever the source knows it by; rara hands it back.
    pub token: usize,
}

// SAFETY: who lends memory promises that any thread may use the mapped part while it is lent.
unsafe impl Send for LentMemory {}
// SAFETY: as above.
unsafe impl Sync for LentMemory {}

/// A host's own allocator of device memory, for [`AdoptDesc::memory`](super::AdoptDesc::memory). Any thread that makes or drops
/// something calls it, several at once; [`Renderer::prepare`](crate::Renderer::prepare) and draws never do.
///
/// # Safety
/// What [`allocate`](Self::allocate) lends is of the device that was adopted, allocated with
/// `VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT`, of a type and a size that will do, and nobody else's until it is
/// [freed](Self::free). For [`Location::Upload`] and [`Location::Readback`] its type is host-coherent, and it is mapped: what is
/// for `Upload` for writing alone, since rara never reads it.
pub unsafe trait MemorySource: Send + Sync {
    /// Lends memory.
    ///
    /// # Errors
    /// The result of Vulkan's that says why there is none: the call that needed it fails with
    /// [`Error::Memory`](crate::Error::Memory).
    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<LentMemory, vk::Result>;

    /// Takes memory back. The device is done with it.
    fn free(&self, memory: LentMemory);
}

/// Device memory that something is bound to.
pub(super) enum Memory {
    Own(Allocation),
    Lent { lent: LentMemory, size: u64 },
}

impl Memory {
    /// # Safety
    /// It is not used any more once this is gone.
    pub(super) unsafe fn memory(&self) -> vk::DeviceMemory {
        match self {
            // SAFETY: the caller's promise.
            Self::Own(allocation) => unsafe { allocation.memory() },
            Self::Lent { lent, .. } => lent.memory,
        }
    }

    pub(super) fn offset(&self) -> u64 {
        match self {
            Self::Own(allocation) => allocation.offset(),
            Self::Lent { lent, .. } => lent.offset,
        }
    }

    pub(super) fn size(&self) -> u64 {
        match self {
            Self::Own(allocation) => allocation.size(),
            Self::Lent { size, .. } => *size,
        }
    }

    pub(super) fn is_dedicated(&self) -> bool {
        matches!(self, Self::Own(allocation) if allocation.is_dedicated())
    }

    pub(super) fn mapped(&self) -> Option<&[u8]> {
        match self {
            Self::Own(allocation) => allocation.mapped_slice(),
            Self::Lent { lent, size } => (!lent.mapped.is_null()).then(|| {
                let (first, size) = (lent.mapped.cast_const().cast(), *size as usize);
                // SAFETY: the source's promise.
                unsafe { std::slice::from_raw_parts(first, size) }
            }),
        }
    }

    pub(super) fn mapped_mut(&mut self) -> Option<WriteOnly<'_>> {
        let first = match self {
            Self::Own(allocation) => allocation.mapped_ptr(),
            Self::Lent { lent, .. } => NonNull::new(lent.mapped),
        };
        let bytes = NonNull::slice_from_raw_parts(first?.cast(), self.size() as usize);
        // SAFETY: the mapped part is as long as the memory, by the allocator's or the source's promise, and is borrowed as a
        // whole.
        Some(unsafe { WriteOnly::new(bytes) })
    }
}

impl Device {
    /// Memory from the host, or from the allocator. The error says why there is none.
    pub(super) fn take_memory(&self, desc: &AllocationCreateDesc<'_>) -> Result<Memory, String> {
        let Some(source) = self.memory_source() else {
            let allocation = self.allocator().allocate(desc);
            return allocation
                .map(Memory::Own)
                .map_err(|error| error.to_string());
        };
        let location = match desc.location {
            MemoryLocation::CpuToGpu => Location::Upload,
            MemoryLocation::GpuToCpu => Location::Readback,
            MemoryLocation::GpuOnly | MemoryLocation::Unknown => Location::GpuOnly,
        };
        let lent = source
            .allocate(&MemoryRequest {
                name: desc.name,
                requirements: desc.requirements,
                location,
            })
            .map_err(|result| format!("the host's allocator said {result:?}"))?;
        let vk::MemoryRequirements {
            size, alignment, ..
        } = desc.requirements;
        let wrong = if lent.memory == vk::DeviceMemory::null() {
            Some("is null".into())
        } else if !lent.offset.is_multiple_of(alignment.max(1)) {
            Some(format!(
                "is at {}, and needs a multiple of {alignment}",
                lent.offset
            ))
        } else if location != Location::GpuOnly && lent.mapped.is_null() {
            Some("is not mapped".into())
        } else {
            None
        };
        if let Some(wrong) = wrong {
            source.free(lent);
            return Err(format!("what the host's allocator lent {wrong}"));
        }
        Ok(Memory::Lent { lent, size })
    }

    /// Gives memory back to where it is from.
    pub(super) fn give_memory_back(&self, memory: Memory) {
        match memory {
            Memory::Own(allocation) => {
                if let Err(error) = self.allocator().free(allocation) {
                    log::error!("device memory could not be freed: {error}");
                }
            }
            Memory::Lent { lent, .. } => {
                let source = self.memory_source().expect("it has lent the memory");
                source.free(lent);
            }
        }
    }

    fn allocator(&self) -> MutexGuard<'_, Allocator> {
        let allocator = self.lent_allocator().lock();
        allocator.unwrap_or_else(PoisonError::into_inner)
    }
}
