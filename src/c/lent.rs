//! Device memory from a host's own allocator.

use std::ffi::{CString, c_char, c_void};
use std::ptr::null_mut;

use rara::ash::vk;
use rara::gpu::{LentMemory, Location, MemoryRequest, MemorySource};

use crate::boundary::invalid;

/// Who reaches device memory.
pub type RaraMemoryUse = u32;
/// The device alone.
pub const RARA_MEMORY_USE_DEVICE: RaraMemoryUse = 0;
/// Mapped and host-coherent, for the processor to write.
pub const RARA_MEMORY_USE_UPLOAD: RaraMemoryUse = 1;
/// Mapped and host-coherent, for the processor to read.
pub const RARA_MEMORY_USE_READBACK: RaraMemoryUse = 2;

/// What RaraAllocate is asked for.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraMemoryRequest {
    /// Its size in the library, which may be larger than in the host's header.
    pub struct_size: usize,
    /// What it is for, for debuggers: UTF-8, ends in NUL, and is gone after the call.
    pub name: *const c_char,
    /// Bytes.
    pub size: u64,
    /// The offset is a multiple of this.
    pub alignment: u64,
    /// A bit for each memory type that will do, as in VkMemoryRequirements.
    pub memory_type_bits: u32,
    /// Who reaches it.
    pub memory_use: RaraMemoryUse,
}

/// A part of device memory that a host lends.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraMemory {
    /// Its size in the library, which may be larger than in the host's header; the host leaves it as it is.
    pub struct_size: usize,
    /// The memory, allocated with VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT where bufferDeviceAddress is enabled.
    pub memory: vk::DeviceMemory,
    /// The offset of the part in it, bytes.
    pub offset: u64,
    /// The part as the processor sees it; null for RARA_MEMORY_USE_DEVICE.
    pub mapped: *mut c_void,
    /// Whatever the host knows it by, such as a VmaAllocation.
    pub user: *mut c_void,
}

/// Lends memory, with `allocator_user` of RaraAdoptDesc: fills `*memory`, which is all zero before but for its size, and
/// returns VK_SUCCESS, or returns why there is none; the call that needs it then fails with RARA_ERROR_MEMORY. It must throw
/// nothing.
pub type RaraAllocate = Option<
    unsafe extern "C" fn(
        user: *mut c_void,
        request: *const RaraMemoryRequest,
        memory: *mut RaraMemory,
    ) -> vk::Result,
>;

/// Takes back what RaraAllocate has lent, as it was lent. The device is done with it. It must throw nothing.
pub type RaraFree = Option<unsafe extern "C" fn(user: *mut c_void, memory: *const RaraMemory)>;

/// A host's functions, and what they are called with.
pub(crate) struct Lender {
    allocate:
        unsafe extern "C" fn(*mut c_void, *const RaraMemoryRequest, *mut RaraMemory) -> vk::Result,
    free: unsafe extern "C" fn(*mut c_void, *const RaraMemory),
    user: *mut c_void,
}

// SAFETY: whoever calls rara_device_adopt promises that any thread may call the functions with this pointer.
unsafe impl Send for Lender {}
// SAFETY: as above, several at once.
unsafe impl Sync for Lender {}

impl Lender {
    /// The functions of a description, if it has any.
    pub(crate) fn new(
        allocate: RaraAllocate,
        free: RaraFree,
        user: *mut c_void,
    ) -> rara::Result<Option<Self>> {
        match (allocate, free) {
            (None, None) => Ok(None),
            (Some(allocate), Some(free)) => Ok(Some(Self {
                allocate,
                free,
                user,
            })),
            (None, _) => {
                invalid("desc->allocate is null, and desc->free is not: give both or none")
            }
            (_, None) => {
                invalid("desc->free is null, and desc->allocate is not: give both or none")
            }
        }
    }
}

// SAFETY: as the host promises by RaraAllocate and RaraMemory.
unsafe impl MemorySource for Lender {
    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<LentMemory, vk::Result> {
        let name = CString::new(request.name.replace('\0', "")).unwrap_or_default();
        let asked = RaraMemoryRequest {
            struct_size: size_of::<RaraMemoryRequest>(),
            name: name.as_ptr(),
            size: request.requirements.size,
            alignment: request.requirements.alignment,
            memory_type_bits: request.requirements.memory_type_bits,
            memory_use: match request.location {
                Location::GpuOnly => RARA_MEMORY_USE_DEVICE,
                Location::Upload => RARA_MEMORY_USE_UPLOAD,
                Location::Readback => RARA_MEMORY_USE_READBACK,
            },
        };
        let mut lent = RaraMemory {
            struct_size: size_of::<RaraMemory>(),
            memory: vk::DeviceMemory::null(),
            offset: 0,
            mapped: null_mut(),
            user: null_mut(),
        };
        // SAFETY: the host's promise.
        match unsafe { (self.allocate)(self.user, &asked, &mut lent) } {
            vk::Result::SUCCESS => Ok(LentMemory {
                memory: lent.memory,
                offset: lent.offset,
                mapped: lent.mapped,
                token: lent.user as usize,
            }),
            result => Err(result),
        }
    }

    fn free(&self, memory: LentMemory) {
        let lent = RaraMemory {
            struct_size: size_of::<RaraMemory>(),
            memory: memory.memory,
            offset: memory.offset,
            mapped: memory.mapped,
            user: memory.token as *mut c_void,
        };
        // SAFETY: the host's promise; it is what it has lent.
        unsafe { (self.free)(self.user, &lent) };
    }
}
