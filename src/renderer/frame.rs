//! The frames that a host holds between the calls that draw them.

use std::sync::Arc;

use super::cut::SeenCut;
use super::frames::Decision;
use crate::passes::{Buffers, CutPlan, EyePlan, Pipelines, Shapes, TilePicture, tiles};
use crate::stats::RasterChoice;

/// A frame that [`Renderer::configure`](super::Renderer::configure) has configured and
/// [`Renderer::prepare`](super::Renderer::prepare) takes. It keeps the memory that it is recorded with, whatever is
/// configured after it. One that is never prepared is dropped.
#[derive(Debug)]
pub struct ConfiguredFrame {
    pub(super) state: FrameState,
    /// How many frames were prepared when it was configured: it takes over results of then.
    pub(super) prepared: u64,
    /// Shared by the renderer, until it forgets those results, and all of its frames that are configured and not prepared.
    pub(super) pending: Arc<()>,
    /// Shared by a host's cut as it was configured for the frame.
    pub(super) _awaits: Option<Arc<()>>,
}

/// A frame that [`Renderer::prepare`](super::Renderer::prepare) has recorded and
/// [`Renderer::draw`](super::Renderer::draw) draws. It keeps the memory that it is drawn with: drop it after its last draw.
#[derive(Debug)]
pub struct PreparedFrame {
    pub(super) state: FrameState,
    /// The frames that had been prepared with it.
    pub(super) number: u64,
}

/// What a frame is recorded with.
#[derive(Debug)]
pub(super) struct FrameState {
    pub(super) decision: Decision,
    /// The buffers of the renderer's own cut, or a host's cut.
    pub(super) cut: FrameCut,
    pub(super) buffers: Arc<Buffers<EyePlan>>,
    pub(super) pipelines: Arc<Pipelines>,
    /// The scene's Gaussians, where motion is drawn.
    pub(super) shapes: Option<Shapes>,
    /// The number of its renderer.
    pub(super) renderer: u64,
}

/// The cut that a frame shows.
#[derive(Debug)]
pub(super) enum FrameCut {
    Own(Arc<Buffers<CutPlan>>),
    Seen(SeenCut),
}

impl FrameCut {
    pub(super) fn buffers(&self) -> &Arc<Buffers<CutPlan>> {
        match self {
            Self::Own(buffers) => buffers,
            Self::Seen(cut) => &cut.buffers,
        }
    }
}

impl ConfiguredFrame {
    /// The stages that the frame does not need.
    pub fn skipped(&self) -> Vec<&'static str> {
        self.state.decision.skipped()
    }

    /// How splats become pixels in the frame if its tiles have room, and why in that way.
    pub fn raster(&self) -> RasterChoice {
        self.state.decision.raster(false)
    }

    /// True when its pixels are those of the frame that was prepared last, so that a host whose own picture is unchanged may
    /// leave it out.
    pub fn changes_nothing(&self) -> bool {
        self.state.decision.changes_nothing()
    }

    /// The tiles' picture, if it is the frame's; `None` where that is drawn.
    pub(crate) fn picture(&self) -> Option<TilePicture> {
        let FrameState {
            decision, buffers, ..
        } = &self.state;
        (!decision.plan.is_drawn).then(|| tiles::picture(buffers))
    }
}
