//! The memory that a cut or an eye computes in, and the memory that it has outgrown.

use std::sync::Arc;

use crate::passes::{Buffers, Owner, Sizes, Spare};
use rara_base::error::{Error, Result};
use rara_gpu::Device;

/// The buffers of a cut, or those that all frames of an eye share, one after the other.
#[derive(Debug)]
pub(super) struct Memory<P: Owner> {
    buffers: Option<Arc<Buffers<P>>>,
    /// Buffers that frames in flight may still use, with the number of frames prepared when they were replaced.
    retired: Vec<(u64, Arc<Buffers<P>>)>,
}

impl<P: Owner> Default for Memory<P> {
    fn default() -> Self {
        Self {
            buffers: None,
            retired: Vec::new(),
        }
    }
}

impl<P: Owner> Memory<P> {
    pub(super) fn fits(&self, plan: &P) -> bool {
        let buffers = self.buffers.as_ref();
        buffers.is_some_and(|buffers| buffers.fit(&Sizes::new(plan)))
    }

    /// The bytes that [`reserve`](Self::reserve) allocates beside what it keeps, and those that it frees before that.
    pub(super) fn change(&self, need: &Sizes<P>, frames: (u64, u64)) -> [u64; 2] {
        let (all, spare) = self.kept(need);
        let (prepared, finished) = frames;
        // What no frame in flight uses goes before the rest comes.
        let goes = self.buffers.as_ref().filter(|_| finished >= prepared);
        let goes = goes.map_or(0, |buffers| buffers.outgrown(&spare));
        [spare.missing(&all), goes]
    }

    /// The sizes of all buffers, those that are there and larger than needed included, and the buffers that can be kept.
    fn kept(&self, need: &Sizes<P>) -> (Sizes<P>, Spare) {
        let had = self.buffers.as_deref();
        let serving = had.filter(|buffers| buffers.sizes().serve(need));
        // Nothing becomes smaller, so that going back to a frame before allocates nothing.
        let all = match serving {
            Some(buffers) => need.clone().or(buffers.sizes()),
            None => need.clone(),
        };
        let spare = serving.map(|buffers| buffers.spare(&all, |has, needs| has >= needs));
        (all, spare.unwrap_or_default())
    }

    /// Replaces the buffers that are smaller than these sizes, and keeps the others; after an error there are none. It is
    /// given how many frames were prepared, and how many of these are finished.
    pub(super) fn reserve(
        &mut self,
        device: &Device,
        (plan, need): (&P, Sizes<P>),
        (prepared, finished): (u64, u64),
    ) -> Result<()> {
        let (all, spare) = self.kept(&need);
        // Free first: both together may not fit.
        let outgrown = self.buffers.take();
        let had_spare = outgrown.is_some();
        // What is used again lives on in the new buffers too.
        self.retired
            .extend(outgrown.map(|buffers| (prepared, buffers)));
        self.free_finished(finished);
        let made = match (Buffers::new(device, plan, all, &spare), had_spare) {
            (Err(Error::Memory(_)), true) => {
                drop(spare); // what was kept may be larger than this plan needs
                Buffers::new(device, plan, need, &Spare::default())
            }
            (made, _) => made,
        };
        self.buffers = Some(Arc::new(made?));
        Ok(())
    }

    /// Adds the further buffers of a reclipped frame, after so many prepared ones; after an error the buffers are as they were.
    pub(super) fn extend(&mut self, device: &Device, plan: &P, prepared: u64) -> Result<()> {
        let (had, need) = (self.buffers(), Sizes::new(plan));
        if had.fit(&need) {
            return Ok(());
        }
        let all = need.or(had.sizes());
        let spare = had.spare(&all, |has, needs| has >= needs);
        let missing = spare.missing(&all);
        device.check_budget("a frame that takes over from the one before", missing, 0)?;
        let made = Buffers::new(device, plan, all, &spare)?;
        let had = self.buffers.replace(Arc::new(made));
        self.retired.extend(had.map(|buffers| (prepared, buffers)));
        Ok(())
    }

    /// Frees buffers that only the first `finished` frames have used.
    pub(super) fn free_finished(&mut self, finished: u64) {
        self.retired.retain(|(prepared, _)| *prepared > finished);
    }

    /// Frees all that a plan does not need, once all frames are finished; after an error there is nothing.
    pub(super) fn trim(&mut self, device: &Device, plan: Option<&P>) -> Result<()> {
        self.retired.clear();
        let had = self.buffers.take();
        if let Some(plan) = plan {
            let sizes = Sizes::new(plan);
            let exact = |buffers: &Buffers<P>| buffers.spare(&sizes, |has, needs| has == needs);
            let spare = had.as_deref().map(exact).unwrap_or_default();
            drop(had);
            self.buffers = Some(Arc::new(Buffers::new(device, plan, sizes, &spare)?));
        }
        Ok(())
    }

    pub(super) fn bytes(&self) -> u64 {
        let retired = self.retired.iter().map(|(_, buffers)| buffers);
        let mut all: Vec<_> = retired
            .chain(&self.buffers)
            .flat_map(|buffers| buffers.all())
            .collect();
        all.sort_unstable_by_key(|buffer| buffer.handle());
        all.dedup_by_key(|buffer| buffer.handle());
        all.iter().map(|buffer| buffer.size()).sum()
    }

    /// Keeps the buffers of a frame that was prepared until it is finished, if they have been replaced since it was configured.
    /// Returns whether they have.
    pub(super) fn keep_replaced(&mut self, buffers: &Arc<Buffers<P>>, prepared: u64) -> bool {
        let current = self.buffers.as_ref();
        let is_replaced = current.is_none_or(|current| !Arc::ptr_eq(current, buffers));
        if is_replaced {
            self.retired.push((prepared, buffers.clone()));
        }
        is_replaced
    }

    /// The buffers, if a frame has been configured.
    pub(super) fn allocated(&self) -> Option<&Buffers<P>> {
        self.buffers.as_deref()
    }

    /// The buffers of a frame that is configured.
    pub(super) fn buffers(&self) -> &Arc<Buffers<P>> {
        self.buffers.as_ref().expect("reserve() allocates them")
    }
}
