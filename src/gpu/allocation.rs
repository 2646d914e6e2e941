//! Takes device memory within the budget, and gives it back.

use std::cmp::Reverse;
use std::sync::atomic::Ordering;
use std::sync::{MutexGuard, PoisonError};

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{AllocationCreateDesc, Allocator};

use super::account::{NamedBytes, Refusal};
use super::device::Device;
use super::lent::{Location, Memory, MemoryRequest};
use super::memory::bytes;
use rara_base::error::{Error, Result};

impl Device {
    /// Bytes of device memory that live buffers and images take.
    pub fn device_bytes(&self) -> u64 {
        self.account().allocated.load(Ordering::Relaxed)
    }

    /// The most that [`device_bytes`](Self::device_bytes) has ever been.
    pub fn peak_device_bytes(&self) -> u64 {
        self.account().allocated_at_most.load(Ordering::Relaxed)
    }

    /// Sets the most bytes of device memory that all that is made on this device may take together: scenes, renderers'
    /// working memory and images; `None`, as in the beginning, for no limit but the device's. What would exceed it fails with
    /// [`Error::Budget`] before any of it is allocated. What is there already stays, also where that is more:
    /// `Renderer::trim` and scenes that are dropped give it back. Any thread may call this at any
    /// time.
    pub fn set_memory_budget(&self, budget: Option<u64>) {
        let most = budget.unwrap_or(u64::MAX);
        self.account().budget.store(most, Ordering::Relaxed);
    }

    /// The most bytes of device memory that may be taken, as [`set_memory_budget`](Self::set_memory_budget) has set it.
    pub fn memory_budget(&self) -> Option<u64> {
        let most = self.account().budget.load(Ordering::Relaxed);
        (most < u64::MAX).then_some(most)
    }

    /// Allocations of device memory so far, freed or not. A frame within what `Renderer::reserve`
    /// has made room for adds none.
    pub fn allocation_count(&self) -> u64 {
        self.account().allocations.load(Ordering::Relaxed)
    }

    /// Pipelines compiled so far, dropped or not; those that a cache had count too.
    pub fn pipeline_count(&self) -> u64 {
        self.account().pipelines.load(Ordering::Relaxed)
    }

    /// The memory of live buffers and images by name, the largest first and with what alignment adds; those of one name
    /// are added up.
    pub fn memory_by_name(&self) -> Vec<NamedBytes> {
        let by_name = self.account().by_name.lock();
        let mut sums: Vec<NamedBytes> = by_name
            .unwrap_or_else(PoisonError::into_inner)
            .iter()
            .map(|(name, bytes)| NamedBytes {
                name: name.clone(),
                bytes: *bytes,
            })
            .collect();
        sums.sort_by_key(|sum| Reverse(sum.bytes)); // a stable sort, so that equals stay in the order of their names
        sums
    }

    /// Refuses so many more bytes, for `what`, where they would exceed the budget once others have gone.
    #[doc(hidden)]
    pub fn check_budget(&self, what: &str, more: u64, goes: u64) -> Result<()> {
        let used = self.device_bytes().saturating_sub(goes);
        let most = self.memory_budget();
        match most.filter(|most| used.saturating_add(more) > *most) {
            Some(most) => Err(over_budget(what, more, used, most)),
            None => Ok(()),
        }
    }

    pub(super) fn allocate(
        &self,
        desc: &AllocationCreateDesc<'_>,
    ) -> std::result::Result<Memory, Refusal> {
        let account = self.account();
        // Taken before it is there, so that two threads together cannot exceed the budget either.
        let (size, most) = (
            desc.requirements.size,
            account.budget.load(Ordering::Relaxed),
        );
        let fits = |used: u64| used.checked_add(size).filter(|sum| *sum <= most);
        let (set, fetch) = (Ordering::Relaxed, Ordering::Relaxed);
        if let Err(used) = account.allocated.fetch_update(set, fetch, fits) {
            let what = format!("\"{}\"", desc.name);
            return Err(Refusal::Budget(over_budget(&what, size, used, most)));
        }
        let allocation = match self.take_memory(desc) {
            Ok(allocation) => allocation,
            Err(why) => {
                account.allocated.fetch_sub(size, Ordering::Relaxed);
                return Err(Refusal::Memory(why));
            }
        };
        // An allocator may take more than was asked for.
        let beyond = allocation.size().saturating_sub(size);
        let before = account.allocated.fetch_add(beyond, Ordering::Relaxed);
        account
            .allocated_at_most
            .fetch_max(before + beyond, Ordering::Relaxed);
        account.allocations.fetch_add(1, Ordering::Relaxed);
        account.change(desc.name, |bytes| bytes + size + beyond);
        self.name_memory(desc.name, &allocation);
        Ok(allocation)
    }

    pub(super) fn free(&self, name: &str, allocation: Memory) {
        let account = self.account();
        account
            .allocated
            .fetch_sub(allocation.size(), Ordering::Relaxed);
        account.change(name, |bytes| bytes - allocation.size());
        self.give_memory_back(allocation);
    }

    /// Memory from the host, or from the allocator. The error says why there is none.
    fn take_memory(&self, desc: &AllocationCreateDesc<'_>) -> std::result::Result<Memory, String> {
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
    fn give_memory_back(&self, memory: Memory) {
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

    /// Names the memory of something of a name for debuggers.
    fn name_memory(&self, name: &str, allocation: &Memory) {
        // Blocks that a host's allocator shares among its buffers and ours are the host's to name.
        let is_lent = self.memory_source().is_some();
        if !is_lent && (allocation.is_dedicated() || self.is_own()) {
            let name = if allocation.is_dedicated() {
                name
            } else {
                "shared"
            };
            // SAFETY: the memory is alive as long as the allocation, and only named here.
            self.set_name(unsafe { allocation.memory() }, name);
        }
    }
}

fn over_budget(what: &str, more: u64, used: u64, most: u64) -> Error {
    Error::Budget(format!(
        "{what} needs {} of device memory, and {} of the budget of {} are in use; raise it (Device::set_memory_budget), drop \
         scenes and renderers, give back what no frame needs (Renderer::trim), or ask for less: smaller pictures, fewer \
         Gaussians or surfaces",
        bytes(more),
        bytes(used),
        bytes(most)
    ))
}
