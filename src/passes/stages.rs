//! The stages' pipelines, each created when a frame first needs it.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::error::Result;
use crate::gpu::Attachments;
use crate::passes::blocks::{BlockList, Blocks};
use crate::passes::classify::Classify;
use crate::passes::clip::Clip;
use crate::passes::compact::Compact;
use crate::passes::context::Context;
use crate::passes::cutoff::Cutoff;
use crate::passes::depth::{Depth, SplatDepth, SplatDepthKey};
use crate::passes::plan::Plan;
use crate::passes::project::{Project, ProjectKey};
use crate::passes::sort::Sort;
use crate::passes::splat::{Splat, SplatKey};
use crate::passes::sweep::{Reclip, Recut};
use crate::passes::tiles::{Bin, Composite, Composites, Tiles, TilesKey};
use crate::passes::work::Work;
use crate::settings::Raster;
use crate::types;

/// All stages for one way of binding. Variants that no frame has asked for do not exist. A copy has the same pipelines.
#[derive(Debug, Clone)]
pub(crate) struct Stages {
    pub(crate) clip: Option<Clip>,
    pub(crate) block_list: BlockList,
    blocks: [Option<Blocks>; 2],
    classify: [Option<Classify>; 2],
    pub(crate) compact: Compact,
    pub(crate) cutoff: Option<Cutoff>,
    project: HashMap<ProjectKey, Project>,
    pub(crate) sort: Sort,
    splat: HashMap<SplatKey, Splat>,
    pub(crate) bin: Option<Bin>,
    tiles: HashMap<TilesKey, Tiles>,
    pub(crate) reclip: Option<Reclip>,
    recut: [Option<Recut>; 2],
    pub(crate) composite: Composites,
    pub(crate) depth: Option<Depth>,
    splat_depth: HashMap<SplatDepthKey, SplatDepth>,
}

impl Stages {
    pub(crate) fn new(context: &Context<'_>) -> Result<Self> {
        Ok(Self {
            clip: None,
            block_list: BlockList::new(context)?,
            blocks: [None, None],
            classify: [None, None],
            compact: Compact::new(context)?,
            cutoff: None,
            project: HashMap::new(),
            sort: Sort::new(context)?,
            splat: HashMap::new(),
            bin: None,
            tiles: HashMap::new(),
            reclip: None,
            recut: [None, None],
            composite: HashMap::new(),
            depth: None,
            splat_depth: HashMap::new(),
        })
    }

    /// Whether all that a plan needs is there.
    pub(crate) fn has(&self, context: &Context<'_>, plan: &Plan) -> bool {
        let is_sweep = matches!(plan.work, Work::Sweep { .. });
        let is_tiled = plan.raster == Raster::Tiles;
        let attachments = context.attachments;
        let view = if is_sweep { &plan.unclipped() } else { plan };
        let clip = usize::from(view.mode != types::MODE_NONE);
        (clip == 0 || self.clip.is_some())
            && self.blocks[clip].is_some()
            && self.classify[clip].is_some()
            && self.project.contains_key(&ProjectKey::new(view))
            && (!is_sweep || self.reclip.is_some() && self.recut[usize::from(is_tiled)].is_some())
            && (!plan.cutoff || self.cutoff.is_some())
            && (!is_tiled
                || self.bin.is_some()
                    && self.tiles.contains_key(&TilesKey::new(plan))
                    && self.composite.contains_key(&attachments))
            && self.splat.contains_key(&SplatKey::new(plan, attachments))
            && context.expected_depth.is_none_or(|attachments| {
                let key = SplatDepthKey::new(plan, attachments);
                self.depth.is_some() && self.splat_depth.contains_key(&key)
            })
    }

    /// Creates what a plan needs and is not there yet.
    pub(crate) fn ensure(&mut self, context: &Context<'_>, plan: &Plan) -> Result<()> {
        if let Work::Sweep { .. } = plan.work {
            self.ensure_view(context, &plan.unclipped())?;
            if self.reclip.is_none() {
                self.reclip = Some(Reclip::new(context)?);
            }
            let tiles = plan.raster == Raster::Tiles;
            let recut = &mut self.recut[usize::from(tiles)];
            if recut.is_none() {
                *recut = Some(Recut::new(context, tiles)?);
            }
        } else {
            self.ensure_view(context, plan)?;
        }
        if plan.cutoff && self.cutoff.is_none() {
            self.cutoff = Some(Cutoff::new(context)?);
        }
        if plan.raster == Raster::Tiles {
            self.ensure_tiles(context, plan)?;
        }
        let key = SplatKey::new(plan, context.attachments);
        if let Entry::Vacant(missing) = self.splat.entry(key) {
            missing.insert(Splat::new(context, key)?);
        }
        if let Some(attachments) = context.expected_depth {
            if self.depth.is_none() {
                self.depth = Some(Depth::new(context)?);
            }
            let key = SplatDepthKey::new(plan, attachments);
            if let Entry::Vacant(missing) = self.splat_depth.entry(key) {
                missing.insert(SplatDepth::new(context, key)?);
            }
        }
        Ok(())
    }

    /// What finds the survivors and puts them on the screen.
    fn ensure_view(&mut self, context: &Context<'_>, plan: &Plan) -> Result<()> {
        let clip = plan.mode != types::MODE_NONE;
        if clip && self.clip.is_none() {
            self.clip = Some(Clip::new(context)?);
        }
        let blocks = &mut self.blocks[usize::from(clip)];
        if blocks.is_none() {
            *blocks = Some(Blocks::new(context, clip)?);
        }
        let classify = &mut self.classify[usize::from(clip)];
        if classify.is_none() {
            *classify = Some(Classify::new(context, clip)?);
        }
        if let Entry::Vacant(missing) = self.project.entry(ProjectKey::new(plan)) {
            missing.insert(Project::new(context, ProjectKey::new(plan))?);
        }
        Ok(())
    }

    fn ensure_tiles(&mut self, context: &Context<'_>, plan: &Plan) -> Result<()> {
        if self.bin.is_none() {
            self.bin = Some(Bin::new(context)?);
        }
        let key = TilesKey::new(plan);
        if let Entry::Vacant(missing) = self.tiles.entry(key) {
            missing.insert(Tiles::new(context, key)?);
        }
        if let Entry::Vacant(missing) = self.composite.entry(context.attachments) {
            missing.insert(Composite::new(context)?);
        }
        Ok(())
    }

    /// The blocks' stage for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn blocks(&self, plan: &Plan) -> &Blocks {
        self.blocks[usize::from(plan.mode != types::MODE_NONE)]
            .as_ref()
            .expect("ensure() creates it")
    }

    /// The classification for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn classify(&self, plan: &Plan) -> &Classify {
        self.classify[usize::from(plan.mode != types::MODE_NONE)]
            .as_ref()
            .expect("ensure() creates it")
    }

    /// The projection for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn project(&self, plan: &Plan) -> &Project {
        &self.project[&ProjectKey::new(plan)]
    }

    /// What a sweep changes of the splats, once [`ensure`](Self::ensure) has seen the plan.
    pub(crate) fn recut(&self, plan: &Plan) -> Option<&Recut> {
        self.recut[usize::from(plan.raster == Raster::Tiles)].as_ref()
    }

    /// The rasteriser for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn splat(&self, plan: &Plan, attachments: Attachments) -> &Splat {
        &self.splat[&SplatKey::new(plan, attachments)]
    }

    /// The draw of depths for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn splat_depth(&self, plan: &Plan, attachments: Attachments) -> &SplatDepth {
        &self.splat_depth[&SplatDepthKey::new(plan, attachments)]
    }

    /// The tile rasteriser for a plan, once [`ensure`](Self::ensure) has seen it.
    pub(crate) fn tiles(&self, plan: &Plan) -> &Tiles {
        &self.tiles[&TilesKey::new(plan)]
    }
}
