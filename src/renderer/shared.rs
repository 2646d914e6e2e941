//! Compiled pipelines that renderers share, so that several views compile nothing twice and recording takes no lock.

use std::sync::{Arc, Mutex, PoisonError};

use crate::passes::{PipelineKey, Pipelines};
use rara_base::error::Result;
use rara_gpu::{Bindings, Device};

type ByBindings = [Option<Arc<Pipelines>>; 3];

/// Calls a function with each pipeline that something needs.
type Needs<'a> = &'a dyn Fn(&mut dyn FnMut(PipelineKey));

/// A renderer's view of the compiled pipelines.
#[derive(Debug, Default)]
pub(super) struct SharedPipelines {
    /// The pipelines of all renderers. Only [`ensure`](Self::ensure) locks them, and only where one is missing; it puts
    /// more in and takes none out, so that frames in flight keep theirs.
    pub(super) all: Arc<Mutex<ByBindings>>,
    /// The pipelines that this renderer has seen.
    seen: ByBindings,
}

impl SharedPipelines {
    /// The same pipelines, for another renderer.
    pub(super) fn sharing(&self) -> Self {
        Self {
            all: self.all.clone(),
            seen: ByBindings::default(),
        }
    }

    /// True when a renderer has made all pipelines that are needed.
    pub(super) fn has_all(&self, bindings: Bindings, needs: Needs<'_>) -> bool {
        let at = bindings as usize;
        let has_all = |pipelines: &Pipelines| has_all(pipelines, needs);
        let all = || self.all.lock().unwrap_or_else(PoisonError::into_inner);
        // Without the lock where nothing is new.
        self.seen[at].as_deref().is_some_and(has_all) || all()[at].as_deref().is_some_and(has_all)
    }

    /// Compiles the pipelines that are needed and no renderer has compiled yet; returns whether there were any.
    pub(super) fn ensure(
        &mut self,
        device: &Device,
        bindings: Bindings,
        needs: Needs<'_>,
    ) -> Result<bool> {
        let at = bindings as usize;
        let has_all = |pipelines: &Pipelines| has_all(pipelines, needs);
        if self.seen[at].as_deref().is_some_and(has_all) {
            return Ok(false);
        }
        let mut all = self.all.lock().unwrap_or_else(PoisonError::into_inner);
        let shared = all[at].get_or_insert_with(|| Arc::new(Pipelines::new(bindings)));
        let is_first_use = !has_all(shared);
        if is_first_use {
            // This replaces the shared pipelines by a copy, while other renderers record with the ones that they have.
            let pipelines = Arc::make_mut(shared);
            let mut keys = Vec::new();
            needs(&mut |key| keys.push(key));
            pipelines.ensure(device, keys)?;
        }
        self.seen[at] = Some(shared.clone());
        Ok(is_first_use)
    }

    /// The pipelines of a frame that is configured.
    pub(super) fn get(&self, bindings: Bindings) -> &Arc<Pipelines> {
        let pipelines = self.seen[bindings as usize].as_ref();
        pipelines.expect("ensure() compiles them")
    }
}

fn has_all(pipelines: &Pipelines, needs: Needs<'_>) -> bool {
    let mut all = true;
    needs(&mut |key| all &= pipelines.has(&key));
    all
}
