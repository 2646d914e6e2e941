//! The sizes of an owner's memory, as they follow from plans.

use std::marker::PhantomData;

use crate::passes::owner::Owner;
use crate::passes::storage::Storage;

/// The bytes of each buffer that frames need.
#[derive(Debug)]
pub(crate) struct Sizes<P: Owner> {
    /// True when they are the most of many frames, whose scenes may be smaller.
    reserved: bool,
    /// Gaussians and blocks of the scene.
    scene: [u64; 2],
    /// By the places of the declarations.
    bytes: Vec<u64>,
    owner: PhantomData<P>,
}

impl<P: Owner> Clone for Sizes<P> {
    fn clone(&self) -> Self {
        let bytes = self.bytes.clone();
        Self { bytes, ..*self }
    }
}

impl<P: Owner> Sizes<P> {
    /// The sizes for a plan.
    pub(crate) fn new(plan: &P) -> Self {
        let bytes = P::storages().iter().map(|storage| (storage.bytes)(plan));
        Self {
            reserved: false,
            scene: plan.scene_size(),
            bytes: bytes.collect(),
            owner: PhantomData,
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

    pub(super) fn bytes(&self, storage: &Storage<P>) -> u64 {
        self.bytes[storage.place()]
    }

    /// All buffers and their bytes, by their places.
    pub(super) fn all(&self) -> impl Iterator<Item = (&'static Storage<P>, u64)> {
        let storages = P::storages().iter().copied();
        storages.zip(self.bytes.iter().copied())
    }

    pub(crate) fn largest(&self) -> u64 {
        self.bytes.iter().copied().max().unwrap_or(0)
    }
}
