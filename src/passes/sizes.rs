//! The sizes of the frame's working memory, as they follow from plans.

use crate::passes::plan::Plan;
use crate::passes::storage::Storage;

/// The bytes of each buffer that frames need.
#[derive(Debug, Clone)]
pub(crate) struct Sizes {
    /// True when they are the most of many frames, whose scenes may be smaller.
    reserved: bool,
    /// Gaussians and blocks of the scene.
    scene: [u64; 2],
    /// All buffers, by their places.
    storages: &'static [&'static Storage],
    /// Their bytes.
    bytes: Vec<u64>,
}

impl Sizes {
    /// The sizes of these buffers for a plan.
    pub(super) fn new(storages: &'static [&'static Storage], plan: &Plan) -> Self {
        Self {
            reserved: false,
            scene: [plan.gaussians(), plan.blocks()],
            storages,
            bytes: storages
                .iter()
                .map(|storage| (storage.bytes)(plan))
                .collect(),
        }
    }

    /// The same for any scene that is no larger.
    pub(crate) fn reserved(self) -> Self {
        let reserved = true;
        Self { reserved, ..self }
    }

    /// The larger of each.
    pub(crate) fn or(mut self, other: &Self) -> Self {
        self.reserved |= other.reserved;
        for (own, other) in self.bytes.iter_mut().zip(&other.bytes) {
            *own = (*own).max(*other);
        }
        for (own, other) in self.scene.iter_mut().zip(other.scene) {
            *own = (*own).max(other);
        }
        self
    }

    /// True when each is at least as large as another one, and they serve its scene.
    pub(super) fn hold(&self, need: &Self) -> bool {
        let mut pairs = self.bytes.iter().zip(&need.bytes);
        self.serve(need) && pairs.all(|(own, need)| own >= need)
    }

    /// True when they are reserved or of the same scene's size: one that goes from scene to scene keeps no more than it needs.
    pub(crate) fn serve(&self, other: &Self) -> bool {
        self.reserved || self.scene == other.scene
    }

    pub(super) fn bytes(&self, storage: &Storage) -> u64 {
        self.bytes[storage.place()]
    }

    /// All buffers and their bytes, by their places.
    pub(super) fn all(&self) -> impl Iterator<Item = (&'static Storage, u64)> {
        self.storages
            .iter()
            .copied()
            .zip(self.bytes.iter().copied())
    }

    pub(crate) fn largest(&self) -> u64 {
        self.bytes.iter().copied().max().unwrap_or(0)
    }
}
