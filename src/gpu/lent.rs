//! Device memory: from an allocator, or from the functions of a host that has one of its own.

use std::ffi::c_void;
use std::ptr::NonNull;

use ash::vk;
use gpu_allocator::vulkan::Allocation;

use super::write_only::WriteOnly;

/// Who reaches a buffer's memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Location {
    /// The device alone.
    GpuOnly,
    /// Mapped, for the host to write.
    Upload,
    /// Mapped, for the host to read.
    Readback,
}

/// A request for memory to a [`MemorySource`].
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct MemoryRequest<'a> {
    /// The use of the memory, such as the name of a buffer.
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
    /// The offset of the part in the memory, in bytes, aligned as requested.
    pub offset: u64,
    /// The part as the host's processor sees it; null for [`Location::GpuOnly`].
    pub mapped: *mut c_void,
    /// A number by which the source recognises the memory; rara gives it back with the memory.
    pub token: usize,
}

// SAFETY: who lends memory promises that any thread may use the mapped part while it is lent.
unsafe impl Send for LentMemory {}
// SAFETY: as above.
unsafe impl Sync for LentMemory {}

/// A host's own allocator of device memory, for [`AdoptDesc::memory`](super::AdoptDesc::memory). Any thread that makes or drops
/// something calls it, several at once; `Renderer::prepare` and draws never do.
///
/// # Safety
/// What [`allocate`](Self::allocate) lends is of the device that was adopted, allocated with
/// `VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT` where `bufferDeviceAddress` is enabled, of a type and a size that will do, and
/// nobody else's until it is [freed](Self::free). For [`Location::Upload`] and [`Location::Readback`] its type is host-coherent, and it is mapped: what is
/// for `Upload` for writing alone, since rara never reads it.
pub unsafe trait MemorySource: Send + Sync {
    /// Lends memory.
    ///
    /// # Errors
    /// The result of Vulkan's that says why there is none: the call that needed it fails with
    /// [`Error::Memory`](rara_base::error::Error::Memory).
    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<LentMemory, vk::Result>;

    /// Takes memory back. The device is done with it.
    fn free(&self, memory: LentMemory);
}

/// Device memory that something is bound to.
#[derive(Debug)]
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

    /// True when the device sees what the host writes without more ado.
    pub(super) fn is_coherent(&self) -> bool {
        match self {
            Self::Own(allocation) => {
                let properties = allocation.memory_properties();
                properties.contains(vk::MemoryPropertyFlags::HOST_COHERENT)
            }
            Self::Lent { lent, .. } => !lent.mapped.is_null(),
        }
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
