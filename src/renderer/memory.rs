//! The memory that frames compute in, and the memory that they have outgrown.

use std::sync::Arc;

use super::estimate::PairEstimate;
use super::pair_room::PairRoom;
use super::request::FrameRequest;
use crate::passes::{Buffers, Plan, Sizes, Spare};
use rara_base::error::{Error, Result};
use rara_gpu::Device;
use rara_scene::settings::Raster;

/// The buffers that all frames share, one after the other.
#[derive(Debug, Default)]
pub(super) struct WorkingMemory {
    buffers: Option<Arc<Buffers>>,
    /// Buffers that frames in flight may still use, with the number of frames prepared when they were replaced.
    retired: Vec<(u64, Arc<Buffers>)>,
    pub(super) pairs: PairRoom,
    pub(super) estimate: PairEstimate,
}

impl WorkingMemory {
    pub(super) fn fits(&self, plan: &Plan) -> bool {
        let buffers = self.buffers.as_ref();
        buffers.is_some_and(|buffers| buffers.fit(&plan.sizes()))
    }

    /// Makes room for as many pairs as a frame has shown to be needed, and as a request of a picture of so many tiles is
    /// expected to have. Returns whether it is more than there was.
    pub(super) fn make_room(
        &mut self,
        request: &FrameRequest<'_>,
        tiles: u32,
        needed: u32,
        budget: Option<u64>,
    ) -> bool {
        let pairs = &mut self.pairs;
        let had = pairs.room();
        pairs.review(budget);
        pairs.make(request.scene.count, tiles, needed);
        if matches!(request.settings.raster, Raster::Auto | Raster::Tiles) && !pairs.is_fixed() {
            let whole = request.whole.unwrap_or(request.camera);
            pairs.expect(self.estimate.update(request.scene, request.camera, whole));
        }
        pairs.room() > had
    }

    /// Replaces the buffers that a plan does not fit into, and keeps the others; after an error there are none. `frames` are
    /// the numbers of frames that were prepared, and of those of them that are finished.
    pub(super) fn replace(
        &mut self,
        device: &Device,
        plan: &Plan,
        frames: (u64, u64),
    ) -> Result<()> {
        self.reserve(device, (plan, plan.sizes()), frames)
    }

    /// As [`replace`](Self::replace), by buffers of these sizes at least. Where the budget has no room for them, the buffers are
    /// as they were.
    pub(super) fn reserve(
        &mut self,
        device: &Device,
        (plan, need): (&Plan, Sizes),
        (prepared, finished): (u64, u64),
    ) -> Result<()> {
        let had = self.buffers.as_deref();
        let serving = had.filter(|buffers| buffers.sizes().serve(&need));
        // Nothing becomes smaller, so that going back to a frame before allocates nothing.
        let all = match serving {
            Some(buffers) => need.clone().or(buffers.sizes()),
            None => need.clone(),
        };
        let spare = serving.map(|buffers| buffers.spare(plan, &all, |has, needs| has >= needs));
        let spare = spare.unwrap_or_default();
        let missing = spare.missing(&all);
        // What no frame in flight uses goes before the rest comes.
        let goes = had.filter(|_| finished >= prepared);
        let goes = goes.map_or(0, |buffers| buffers.outgrown(&spare));
        device.check_budget("a frame's working memory", missing, goes)?;
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
    pub(super) fn extend(&mut self, device: &Device, plan: &Plan, prepared: u64) -> Result<()> {
        let (had, need) = (self.buffers(), plan.sizes());
        if had.fit(&need) {
            return Ok(());
        }
        let all = need.or(had.sizes());
        let spare = had.spare(plan, &all, |has, needs| has >= needs);
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
    pub(super) fn trim(&mut self, device: &Device, plan: Option<&Plan>) -> Result<()> {
        self.retired.clear();
        let had = self.buffers.take();
        if let Some(plan) = plan {
            let sizes = plan.sizes();
            let exact = |buffers: &Buffers| buffers.spare(plan, &sizes, |has, needs| has == needs);
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
        all.sort_unstable_by_key(|buffer| buffer.address());
        all.dedup_by_key(|buffer| buffer.address());
        all.iter().map(|buffer| buffer.size()).sum()
    }

    /// Keeps the buffers of a frame that was prepared until it is finished, if they have been replaced since it was configured.
    /// Returns whether they have.
    pub(super) fn keep_replaced(&mut self, buffers: &Arc<Buffers>, prepared: u64) -> bool {
        let current = self.buffers.as_ref();
        let is_replaced = current.is_none_or(|current| !Arc::ptr_eq(current, buffers));
        if is_replaced {
            self.retired.push((prepared, buffers.clone()));
        }
        is_replaced
    }

    /// The buffers, if a frame has been configured.
    pub(super) fn allocated(&self) -> Option<&Buffers> {
        self.buffers.as_deref()
    }

    /// The buffers of a frame that is configured.
    pub(super) fn buffers(&self) -> &Arc<Buffers> {
        self.buffers.as_ref().expect("replace() allocates them")
    }
}
