//! What stages are recorded with: the buffers of the owners that they reach, by name, and the pipelines.

use ash::vk;

use crate::passes::buffers::Buffers;
use crate::passes::cut_plan::CutPlan;
use crate::passes::eye_plan::EyePlan;
use crate::passes::motion::Sight;
use crate::passes::pipelines::Pipelines;
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::storage::Storage;
use rara_gpu::{Buffer, DepthUnder};

/// What stages are recorded with.
pub(crate) trait Resources<Name> {
    fn buffer(&self, name: Name) -> &Buffer;

    fn pipelines(&self) -> &Pipelines;

    /// The host's depth, for tiles that it hides.
    fn depth(&self) -> Option<&HostDepth> {
        None
    }
}

/// A host's depth as a frame reads it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HostDepth {
    pub(crate) under: DepthUnder,
    /// The view and its layout where the depth is sampled; the view is null where it is copied.
    pub(crate) sampled: (vk::ImageView, vk::ImageLayout),
}

/// A buffer of a scene.
#[derive(Debug)]
pub(crate) struct OfScene(pub(super) fn(&SceneBuffers) -> &Buffer);

/// A buffer that the stages of a cut reach.
#[derive(Debug, Clone, Copy)]
pub(crate) enum CutName {
    Scene(&'static OfScene),
    Own(&'static Storage<CutPlan>),
}

/// A buffer that the stages of an eye reach.
#[derive(Debug, Clone, Copy)]
pub(crate) enum EyeName {
    Cut(CutName),
    Own(&'static Storage<EyePlan>),
}

impl From<&'static OfScene> for CutName {
    fn from(of_scene: &'static OfScene) -> Self {
        Self::Scene(of_scene)
    }
}

impl From<&'static Storage<CutPlan>> for CutName {
    fn from(storage: &'static Storage<CutPlan>) -> Self {
        Self::Own(storage)
    }
}

impl From<&'static OfScene> for EyeName {
    fn from(of_scene: &'static OfScene) -> Self {
        Self::Cut(of_scene.into())
    }
}

impl From<&'static Storage<CutPlan>> for EyeName {
    fn from(storage: &'static Storage<CutPlan>) -> Self {
        Self::Cut(storage.into())
    }
}

impl From<&'static Storage<EyePlan>> for EyeName {
    fn from(storage: &'static Storage<EyePlan>) -> Self {
        Self::Own(storage)
    }
}

/// What the stages of a cut are recorded with.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CutResources<'a> {
    pub(crate) pipelines: &'a Pipelines,
    pub(crate) scene: &'a SceneBuffers,
    pub(crate) buffers: &'a Buffers<CutPlan>,
}

/// What the stages of an eye are recorded with.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EyeResources<'a> {
    pub(crate) cut: CutResources<'a>,
    pub(crate) buffers: &'a Buffers<EyePlan>,
    /// The host's depth, for tiles that it hides.
    pub(crate) depth: Option<HostDepth>,
    /// Where the layers have the camera and where they had it in the frame before, for motion.
    pub(crate) sights: [Option<&'a Sight>; 2],
}

impl Resources<CutName> for CutResources<'_> {
    fn buffer(&self, name: CutName) -> &Buffer {
        match name {
            CutName::Scene(OfScene(buffer)) => buffer(self.scene),
            CutName::Own(storage) => self.buffers.get(storage),
        }
    }

    fn pipelines(&self) -> &Pipelines {
        self.pipelines
    }
}

impl Resources<EyeName> for EyeResources<'_> {
    fn buffer(&self, name: EyeName) -> &Buffer {
        match name {
            EyeName::Cut(name) => self.cut.buffer(name),
            EyeName::Own(storage) => self.buffers.get(storage),
        }
    }

    fn pipelines(&self) -> &Pipelines {
        self.cut.pipelines
    }

    fn depth(&self) -> Option<&HostDepth> {
        self.depth.as_ref()
    }
}
