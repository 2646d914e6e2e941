//! What is made on a device: how much memory it takes, of which budget, and how many pipelines were compiled.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use gpu_allocator::vulkan::AllocationCreateDesc;

use super::Device;
use super::lent::Memory;
use super::memory::bytes;
use crate::{Error, Result};

/// A buffer's or an image's name, and the device memory that it takes.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct NamedBytes {
    /// Its name, which says what it is for.
    pub name: String,
    /// Its size.
    pub bytes: u64,
}

/// The device's memory and pipelines, counted as they come and go.
pub(super) struct Account {
    allocated: AtomicU64,
    allocated_at_most: AtomicU64,
    /// The most that `allocated` may become; the greatest number where there is no budget.
    budget: AtomicU64,
    allocations: AtomicU64,
    pipelines: AtomicU64,
    /// The memory by name. It is counted here, as a host's allocator holds more than our memory.
    by_name: Mutex<BTreeMap<String, u64>>,
}

impl Default for Account {
    fn default() -> Self {
        Self {
            allocated: AtomicU64::new(0),
            allocated_at_most: AtomicU64::new(0),
            budget: AtomicU64::new(u64::MAX),
            allocations: AtomicU64::new(0),
            pipelines: AtomicU64::new(0),
            by_name: Mutex::default(),
        }
    }
}

impl Account {
    fn change(&self, name: &str, change: impl FnOnce(u64) -> u64) {
        let by_name = self.by_name.lock();
        let mut by_name = by_name.unwrap_or_else(PoisonError::into_inner);
        let bytes = by_name.entry(name.to_owned()).or_default();
        *bytes = change(*bytes);
        if *bytes == 0 {
            by_name.remove(name);
        }
    }

    /// Counts a pipeline that was compiled.
    pub(super) fn count_pipeline(&self) {
        self.pipelines.fetch_add(1, Ordering::Relaxed);
    }
}

/// Why there is no memory.
pub(super) enum Refusal {
    /// It would be more than the budget.
    Budget(Error),
    /// The allocator's or the host's reason.
    Memory(String),
}

impl Refusal {
    /// The error of a call that needed the memory; `full` makes it of an allocator's reason.
    pub(super) fn error(self, full: impl FnOnce(&str) -> Error) -> Error {
        match self {
            Self::Budget(error) => error,
            Self::Memory(why) => full(&why),
        }
    }
}

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
    /// [`Renderer::trim`](crate::Renderer::trim) and scenes that are dropped give it back. Any thread may call this at any
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

    /// Allocations of device memory so far, freed or not. A frame within what [`Renderer::reserve`](crate::Renderer::reserve)
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
    pub(crate) fn check_budget(&self, what: &str, more: u64, goes: u64) -> Result<()> {
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
