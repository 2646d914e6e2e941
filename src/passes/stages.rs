//! The stages' pipelines, each created when a frame first needs it.

use crate::error::Result;
use crate::passes::classify::Classify;
use crate::passes::compact::Compact;
use crate::passes::context::Context;
use crate::passes::cutoff::Cutoff;
use crate::passes::plan::Plan;
use crate::passes::project::Project;
use crate::passes::sort::Sort;
use crate::passes::splat::Splat;
use crate::types;

/// All stages for one way of binding. Variants that no frame has asked for do not exist.
#[derive(Debug)]
pub(crate) struct Stages {
    classify: [Option<Classify>; 2],
    pub(crate) compact: Compact,
    pub(crate) cutoff: Option<Cutoff>,
    pub(crate) project: Project,
    pub(crate) sort: Sort,
    splat: [[Option<Splat>; types::MODE_COUNT as usize]; 2],
}

impl Stages {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            classify: [None, None],
            compact: Compact::new(context)?,
            cutoff: None,
            project: Project::new(context)?,
            sort: Sort::new(context)?,
            splat: Default::default(),
        })
    }

    /// Creates what a plan needs and is not there yet.
    pub(crate) fn ensure(&mut self, context: &Context<'_>, plan: &Plan, mesh: bool) -> Result<()> {
        let clip = plan.mode != types::MODE_NONE;
        let classify = &mut self.classify[usize::from(clip)];
        if classify.is_none() {
            *classify = Some(Classify::new(context, clip)?);
        }
        if plan.cutoff && self.cutoff.is_none() {
            self.cutoff = Some(Cutoff::new(context)?);
        }
        let splat = &mut self.splat[usize::from(mesh)][splat_variant(plan)];
        if splat.is_none() {
            *splat = Some(Splat::new(context, mesh, splat_variant(plan) as u32)?);
        }
        Ok(())
    }

    /// The classification for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn classify(&self, plan: &Plan) -> &Classify {
        self.classify[usize::from(plan.mode != types::MODE_NONE)]
            .as_ref()
            .expect("ensure() creates it")
    }

    /// The rasteriser for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn splat(&self, plan: &Plan, mesh: bool) -> &Splat {
        self.splat[usize::from(mesh)][splat_variant(plan)]
            .as_ref()
            .expect("ensure() creates it")
    }
}

/// The fragment stage's `CLIP_MODE`: after a hard clip nothing is left for it to do.
fn splat_variant(plan: &Plan) -> usize {
    if plan.cutoff {
        plan.mode as usize
    } else {
        types::MODE_NONE as usize
    }
}
