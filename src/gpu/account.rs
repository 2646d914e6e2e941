//! What is made on a device: how much memory it takes, of which budget, and how many pipelines were compiled.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use rara_base::error::Error;

/// A buffer's or an image's name, and the device memory that it takes.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct NamedBytes {
    /// The name of the memory, which says what it is for.
    pub name: String,
    /// The size of the memory, in bytes.
    pub bytes: u64,
}

/// The device's memory and pipelines, counted as they come and go.
pub(super) struct Account {
    pub(super) allocated: AtomicU64,
    pub(super) allocated_at_most: AtomicU64,
    /// The most that `allocated` may become; the greatest number where there is no budget.
    pub(super) budget: AtomicU64,
    pub(super) allocations: AtomicU64,
    pub(super) pipelines: AtomicU64,
    /// The memory by name. It is counted here, as a host's allocator holds more than our memory.
    pub(super) by_name: Mutex<BTreeMap<String, u64>>,
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
    pub(super) fn change(&self, name: &str, change: impl FnOnce(u64) -> u64) {
        let by_name = self.by_name.lock();
        let mut by_name = by_name.unwrap_or_else(PoisonError::into_inner);
        let bytes = by_name.entry(name.to_owned()).or_default();
        *bytes = change(*bytes);
        if *bytes == 0 {
            by_name.remove(name);
        }
    }

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
