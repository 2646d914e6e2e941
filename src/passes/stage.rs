//! A stage of the frame.

use crate::passes::eye_plan::EyePlan;
use crate::passes::owner::Owner;
use crate::passes::recording::Recording;
use crate::passes::storage::Storage;
use rara_gpu::Attachments;
use rara_scene::settings::Show;

/// A step of the frame that is computed before the draw, for the owner of a plan.
#[derive(Debug)]
pub(crate) struct Stage<P: Owner> {
    /// The name of its file, debug label, timer and statistics.
    pub(crate) name: &'static str,
    /// True for a plan that needs it.
    pub(crate) needed: fn(&P) -> bool,
    /// True for a plan that, without it, reports that it was skipped.
    pub(crate) missed: fn(&P) -> bool,
    /// The buffers that it writes and that no earlier stage has.
    pub(crate) memory: &'static [&'static [&'static Storage<P>]],
    /// Records it for a plan that needs it.
    pub(crate) record: fn(&mut Recording<'_, '_, P>),
}

impl Stage<EyePlan> {
    /// A stage of every frame that finds which Gaussians are in view.
    pub(crate) const fn when_finding_view(
        name: &'static str,
        memory: &'static [&'static [&'static Storage<EyePlan>]],
        record: fn(&mut Recording<'_, '_, EyePlan>),
    ) -> Self {
        Self {
            name,
            needed: |plan| plan.finds_view(),
            missed: |_| true,
            memory,
            record,
        }
    }
}

/// The attachments that a frame draws into.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Targets {
    pub(crate) colour: Attachments,
    /// Those of expected depths, where they are drawn.
    pub(crate) expected_depth: Option<Attachments>,
    /// Those of motion, where it is drawn.
    pub(crate) motion: Option<Attachments>,
    /// True when the host's colours are linear light.
    pub(crate) linear: bool,
    /// True when those of the splats are.
    pub(crate) draws_linear: bool,
}

impl Targets {
    /// True when what splats make is not what the host has, so that their picture is converted once it is whole.
    pub(crate) fn convert(&self, show: Show) -> bool {
        self.linear != (self.draws_linear && show == Show::Colour)
    }
}
