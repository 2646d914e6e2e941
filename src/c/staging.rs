//! The host's own memory, which scenes are copied from.

use std::ffi::c_void;

use rara::ash::vk;
use rara::{Result, Staging};

use crate::boundary::{RaraResult, Versioned, guard, invalid, memory, read, versioned, write};

/// A part of the host's memory that the device can copy from.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraStaging {
    /// Set by rara_staging_default.
    pub struct_size: usize,
    /// A buffer created with VK_BUFFER_USAGE_TRANSFER_SRC_BIT.
    pub buffer: vk::Buffer,
    /// The offset of the part in the buffer, bytes. Default: 0.
    pub offset: u64,
    /// The part, mapped for writing: it is never read.
    pub mapped: *mut c_void,
    /// Its length in bytes; it may be longer than what is needed.
    pub size: usize,
}

versioned!(RaraStaging);

/// No memory; the host replaces the buffer and what follows. `staging_size` is sizeof *staging.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_staging_default(
    staging: *mut RaraStaging,
    staging_size: usize,
) -> RaraResult {
    guard(|| write(staging, staging_size, &Versioned::BLANK, "staging"))
}

/// # Safety
/// `staging` is null, or points to one that is as its fields say, and nobody else uses its range for `'a`.
pub(crate) unsafe fn staging<'a>(staging: *const RaraStaging) -> Result<Staging<'a>> {
    let staging = read(staging, Versioned::BLANK, "staging")?;
    if staging.buffer == vk::Buffer::null() {
        return invalid("staging->buffer is null");
    }
    if staging.offset.checked_add(staging.size as u64).is_none() {
        return invalid("staging->offset and staging->size are beyond any buffer");
    }
    Ok(Staging {
        buffer: staging.buffer,
        offset: staging.offset,
        bytes: memory(staging.mapped, staging.size, "staging->mapped")?,
    })
}
