//! The stages' pipelines, each created when a frame first needs it.

use ash::vk;

use crate::error::Result;
use crate::passes::classify::Classify;
use crate::passes::compact::Compact;
use crate::passes::context::Context;
use crate::passes::cutoff::Cutoff;
use crate::passes::plan::Plan;
use crate::passes::project::Project;
use crate::passes::sort::Sort;
use crate::passes::splat::{Splat, SplatVariant};
use crate::precision::ShFormat;
use crate::types;

/// All stages for one way of binding. Variants that no frame has asked for do not exist.
#[derive(Debug)]
pub(crate) struct Stages {
    classify: [Option<Classify>; 2],
    pub(crate) compact: Compact,
    pub(crate) cutoff: Option<Cutoff>,
    pub(crate) sort: Sort,
    project: Vec<(ShFormat, Project)>,
    splat: Vec<(SplatVariant, Splat)>,
}

impl Stages {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            classify: [None, None],
            compact: Compact::new(context)?,
            cutoff: None,
            project: Vec::new(),
            sort: Sort::new(context)?,
            splat: Vec::new(),
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
        let sh = plan.sh_format;
        if self.project.iter().all(|(have, _)| *have != sh) {
            self.project.push((sh, Project::new(context, sh)?));
        }
        let variant = splat_variant(plan, mesh, context.color_format);
        if self.splat.iter().all(|(have, _)| *have != variant) {
            self.splat.push((variant, Splat::new(context, variant)?));
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
    pub(crate) fn splat(&self, plan: &Plan, mesh: bool, format: vk::Format) -> &Splat {
        let variant = splat_variant(plan, mesh, format);
        find(&self.splat, variant)
    }

    /// The projection for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn project(&self, plan: &Plan) -> &Project {
        find(&self.project, plan.sh_format)
    }
}

fn find<K: PartialEq, V>(pairs: &[(K, V)], key: K) -> &V {
    let pair = pairs.iter().find(|(have, _)| *have == key);
    pair.map(|(_, value)| value).expect("ensure() creates it")
}

/// After a hard clip nothing is left for the fragment stage to do, and only the exact mode has a use for Phi.
fn splat_variant(plan: &Plan, mesh: bool, format: vk::Format) -> SplatVariant {
    let mode = if plan.cutoff {
        plan.mode
    } else {
        types::MODE_NONE
    };
    let phi = if mode == types::MODE_EXACT {
        plan.phi
    } else {
        types::PHI_QUINTIC
    };
    SplatVariant {
        mesh,
        mode,
        phi,
        format,
    }
}
