//! Buffers are storage that shaders reach by address or binding, mapped where the host writes or reads.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{AllocationCreateDesc, AllocationScheme};

use super::device::Device;
use super::failure::failed;
use super::lent::{Location, Memory};
use super::write_only::WriteOnly;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

/// Allocations from this size on get memory of their own; smaller ones share blocks. With a lower limit small buffers would
/// waste pages and the driver's limited number of allocations; with a higher one freed buffers would leave large holes.
const DEDICATED_FROM: u64 = 16 << 20;

/// The description from which a buffer is created.
#[derive(Debug, Clone, Copy)]
pub struct BufferDesc<'a> {
    pub name: &'a str,
    /// Bytes; at least 16 are allocated and a multiple of 16.
    pub size: u64,
    pub location: Location,
}

/// A buffer with every usage that a pass can ask of it, shared by its clones; dropping the last frees it.
///
/// The device must be done with it by then: who submits work waits for it first.
#[derive(Debug, Clone)]
pub struct Buffer(Arc<BufferInner>);

#[derive(Debug)]
struct BufferInner {
    device: Device,
    handle: vk::Buffer,
    address: u64,
    size: u64,
    name: Box<str>,
    location: Location,
    /// `None` only while being made or dropped.
    allocation: Option<Memory>,
}

impl Device {
    #[doc(hidden)]
    pub fn create_buffer(&self, desc: &BufferDesc<'_>) -> Result<Buffer> {
        use vk::BufferUsageFlags as Usage;
        let size = desc.size.max(1).next_multiple_of(16);
        let full = |why: &str| {
            let what = format!(
                "buffer \"{}\" of {} could not be allocated",
                desc.name,
                bytes(size)
            );
            let used = bytes(self.device_bytes());
            Error::Memory(format!(
                "{what} ({why}); {used} are in use by this renderer"
            ))
        };
        if size > self.support().max_buffer_size {
            return Err(full(&format!(
                "the device's largest is {}",
                bytes(self.support().max_buffer_size)
            )));
        }
        let has_address = self.support().buffer_device_address;
        let mut usage = Usage::STORAGE_BUFFER
            | Usage::TRANSFER_SRC
            | Usage::TRANSFER_DST
            | Usage::INDIRECT_BUFFER;
        if has_address {
            usage |= Usage::SHADER_DEVICE_ADDRESS;
        }
        let mut info = vk::BufferCreateInfo::default().size(size).usage(usage);
        if self.families().len() > 1 {
            info = info
                .sharing_mode(vk::SharingMode::CONCURRENT)
                .queue_family_indices(self.families());
        }
        // SAFETY: the device is alive as long as `self`.
        let handle =
            unsafe { self.raw().create_buffer(&info, None) }.map_err(failed("vkCreateBuffer"))?;
        // From here on dropping `buffer` cleans up.
        let mut buffer = BufferInner {
            device: self.clone(),
            handle,
            address: 0,
            size,
            name: desc.name.into(),
            location: desc.location,
            allocation: None,
        };
        // SAFETY: the buffer was created just now.
        let requirements = unsafe { self.raw().get_buffer_memory_requirements(handle) };
        let allocation = self.allocate(&AllocationCreateDesc {
            name: desc.name,
            requirements,
            location: match desc.location {
                Location::GpuOnly => MemoryLocation::GpuOnly,
                Location::Upload => MemoryLocation::CpuToGpu,
                Location::Readback => MemoryLocation::GpuToCpu,
            },
            linear: true,
            allocation_scheme: if requirements.size >= DEDICATED_FROM {
                AllocationScheme::DedicatedBuffer(handle)
            } else {
                AllocationScheme::GpuAllocatorManaged
            },
        });
        let allocation = allocation.map_err(|refusal| refusal.error(full))?;
        let allocation = buffer.allocation.insert(allocation);
        // SAFETY: the memory fits the requirements it was allocated for, and the buffer is not bound yet.
        unsafe {
            self.raw()
                .bind_buffer_memory(handle, allocation.memory(), allocation.offset())
        }
        .map_err(failed("vkBindBufferMemory"))?;
        if has_address {
            let info = vk::BufferDeviceAddressInfo::default().buffer(handle);
            // SAFETY: the buffer is bound and has the address usage, and the device has the feature.
            buffer.address = unsafe { self.raw().get_buffer_device_address(&info) };
        }
        self.set_name(handle, desc.name);
        log::debug!("buffer \"{}\" of {} was made", desc.name, bytes(size));
        Ok(Buffer(Arc::new(buffer)))
    }
}

impl Buffer {
    #[doc(hidden)]
    pub fn device(&self) -> &Device {
        &self.0.device
    }

    pub fn handle(&self) -> vk::Buffer {
        self.0.handle
    }

    /// The device address of its first byte; 0 where the device has no addresses.
    pub fn address(&self) -> u64 {
        self.0.address
    }

    /// Bytes it holds: the size asked for, rounded up to a multiple of 16.
    pub fn size(&self) -> u64 {
        self.0.size
    }

    pub fn name(&self) -> &str {
        &self.0.name
    }

    pub fn location(&self) -> Location {
        self.0.location
    }

    /// The bytes, for [`Location::Readback`] alone. Read them when the device is done writing and the recording ended with
    /// [`Recorder::ready_for_host`](super::Recorder::ready_for_host).
    ///
    /// # Panics
    /// If the memory is not for the host to read.
    pub fn mapped(&self) -> &[u8] {
        assert!(
            self.0.location == Location::Readback,
            "buffer \"{}\" is not for the host to read: it is {:?}",
            self.0.name,
            self.0.location
        );
        let bytes = self
            .0
            .allocation()
            .mapped()
            .expect("host-visible memory is mapped while it lives");
        &bytes[..self.0.size as usize]
    }

    /// The bytes, to be written while the device does not use them.
    ///
    /// # Panics
    /// If the memory is the device's alone, or the buffer has a clone.
    pub fn mapped_mut(&mut self) -> WriteOnly<'_> {
        assert!(
            self.0.location != Location::GpuOnly,
            "buffer \"{}\" is not mapped: it is GpuOnly",
            self.0.name
        );
        let size = self.0.size as usize;
        let owned = Arc::get_mut(&mut self.0).expect("what the host writes has no clones");
        let allocation = owned.allocation.as_mut().expect("taken only by drop");
        let mapped = allocation.mapped_mut();
        let mapped = mapped.expect("host-visible memory is mapped while it lives");
        mapped.first(size)
    }

    /// The bytes of memory of the [device's own](Location::GpuOnly) that the host may write all the same, as where both share
    /// it; `None` where it cannot, and they have to be copied. Nothing has used the buffer yet.
    #[doc(hidden)]
    pub fn shared_mut(&mut self) -> Option<WriteOnly<'_>> {
        let size = self.0.size as usize;
        let allocation = Arc::get_mut(&mut self.0)?.allocation.as_mut()?;
        let is_coherent = allocation.is_coherent();
        let mapped = allocation.mapped_mut().filter(|_| is_coherent)?;
        Some(mapped.first(size))
    }

    /// Panics with a sentence unless `size` bytes at `offset` lie inside.
    pub(crate) fn check_range(&self, offset: u64, size: u64) {
        let inside = offset
            .checked_add(size)
            .is_some_and(|end| end <= self.0.size);
        assert!(
            inside,
            "{} at {offset} do not lie in buffer \"{}\" of {}",
            counted(size, "byte"),
            self.0.name,
            counted(self.0.size, "byte")
        );
    }
}

impl BufferInner {
    fn allocation(&self) -> &Memory {
        self.allocation.as_ref().expect("taken only by drop")
    }
}

impl Drop for BufferInner {
    fn drop(&mut self) {
        // SAFETY: whoever submitted work with the buffer waited for it, as the type's contract says.
        unsafe { self.device.raw().destroy_buffer(self.handle, None) };
        if let Some(allocation) = self.allocation.take() {
            self.device.free(&self.name, allocation);
        }
    }
}

/// A number of bytes for people.
pub(crate) fn bytes(count: u64) -> String {
    match count {
        0..1024 => counted(count, "byte"),
        1024..0x10_0000 => format!("{:.1} KiB", count as f64 / 1024.0),
        0x10_0000..0x4000_0000 => format!("{:.1} MiB", count as f64 / f64::from(1 << 20)),
        _ => format!("{:.2} GiB", count as f64 / f64::from(1 << 30)),
    }
}
