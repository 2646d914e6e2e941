//! The stages' pipelines, each created when a frame first needs it.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::error::Result;
use crate::passes::classify::Classify;
use crate::passes::compact::Compact;
use crate::passes::context::Context;
use crate::passes::cutoff::Cutoff;
use crate::passes::plan::Plan;
use crate::passes::project::Project;
use crate::passes::sort::Sort;
use crate::passes::splat::{Splat, SplatKey};
use crate::types;

/// All stages for one way of binding. Variants that no frame has asked for do not exist.
#[derive(Debug)]
pub(crate) struct Stages {
    classify: [Option<Classify>; 2],
    pub(crate) compact: Compact,
    pub(crate) cutoff: Option<Cutoff>,
    project: [Option<Project>; 2],
    pub(crate) sort: Sort,
    splat: HashMap<SplatKey, Splat>,
}

impl Stages {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            classify: [None, None],
            compact: Compact::new(context)?,
            cutoff: None,
            project: [None, None],
            sort: Sort::new(context)?,
            splat: HashMap::new(),
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
        let project = &mut self.project[usize::from(plan.cutoff)];
        if project.is_none() {
            *project = Some(Project::new(context, plan.cutoff)?);
        }
        if let Entry::Vacant(missing) = self.splat.entry(SplatKey::new(plan, mesh)) {
            missing.insert(Splat::new(context, SplatKey::new(plan, mesh))?);
        }
        Ok(())
    }

    /// The classification for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn classify(&self, plan: &Plan) -> &Classify {
        self.classify[usize::from(plan.mode != types::MODE_NONE)]
            .as_ref()
            .expect("ensure() creates it")
    }

    /// The projection for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn project(&self, plan: &Plan) -> &Project {
        self.project[usize::from(plan.cutoff)]
            .as_ref()
            .expect("ensure() creates it")
    }

    /// The rasteriser for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn splat(&self, plan: &Plan, mesh: bool) -> &Splat {
        &self.splat[&SplatKey::new(plan, mesh)]
    }
}
