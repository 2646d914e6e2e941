//! Records a configured frame into the host's command buffer: the stages, and the draws.

use std::sync::Arc;

use ash::vk;

use super::frame::{FrameCut, FrameState};
use super::{ConfiguredFrame, MotionDesc, PreparedFrame, Renderer, out_of_order};
use crate::passes::{
    self, CutResources, EyeResources, HostDepth, Part, PreviousFrame, SceneBuffers, Work,
    composite, motion, tiles,
};
use rara_base::error::Result;
use rara_gpu::{DepthImage, Drawer, Draws, Recorder};

impl Renderer {
    /// Records a frame's stages up to the draw, outside any rendering scope. `depth` is what the host has drawn already, for a
    /// renderer whose [`DepthDesc::readable`](crate::DepthDesc::readable) asks for it: tiles leave out the splats behind it.
    /// The picture is the same as that of quads, which test each sample against the attachment itself. Tiles of such a frame
    /// are computed anew even where [`RendererDesc::reuse`](crate::RendererDesc::reuse) is set.
    ///
    /// The part of the depth image under the viewport is copied, at `COPY` by `TRANSFER_READ`, or with
    /// [`DepthDesc::sampled`](crate::DepthDesc::sampled) sampled, at `COMPUTE_SHADER` by `SHADER_SAMPLED_READ`. The host's barrier
    /// before makes its depths visible to that, and its barrier after waits for it before the image changes layout or contents.
    ///
    /// # Safety
    /// `cmd` is in the recording state, outside a rendering scope, and will be submitted to the device's queue, or to one of
    /// [`RendererDesc::compute_family`](crate::RendererDesc::compute_family) where that is set, or never. `scene` is the one given to [`configure`](Self::configure)
    /// and lives until the commands have executed. `depth` is as its description says, visible to what reads it, and lives as
    /// long. The host has waited for the frames that [`Renderer`] says.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) for another renderer's frame, with another scene than its own, without the
    /// depth that [`DepthDesc::readable`](crate::DepthDesc::readable) promises or with one that it does not, and for a frame
    /// that takes over from another frame than the last prepared one. Nothing is recorded then.
    pub unsafe fn prepare(
        &mut self,
        cmd: vk::CommandBuffer,
        scene: &SceneBuffers,
        depth: Option<&DepthImage>,
        frame: ConfiguredFrame,
    ) -> Result<PreparedFrame> {
        let is_next =
            frame.prepared == self.frames.prepared() && Arc::ptr_eq(&frame.pending, &self.pending);
        let state = frame.state;
        let readable = self.desc.depth.is_some_and(|depth| depth.readable);
        if state.renderer != self.id {
            return out_of_order("prepare was given another renderer's frame");
        }
        if state.decision.scene != scene.id {
            return out_of_order("prepare was given another scene than Renderer::configure");
        }
        match depth {
            None if readable => {
                return out_of_order("prepare was promised the host's depth, which is missing");
            }
            Some(_) if !readable => {
                return out_of_order("prepare takes a depth only with DepthDesc::readable");
            }
            _ => {}
        }
        let is_view = depth.is_some_and(|depth| depth.view != vk::ImageView::null());
        if is_view
            != self
                .desc
                .depth
                .is_some_and(|depth| depth.readable && depth.sampled)
        {
            return out_of_order(
                "prepare takes a view of the host's depth (DepthImage::view) where DepthDesc::sampled promises one, and nowhere else",
            );
        }
        let owns_cut = match &state.cut {
            FrameCut::Own(_) => true,
            FrameCut::Seen(cut) if cut.is_recorded() => false,
            FrameCut::Seen(_) => {
                return out_of_order(
                    "prepare was given a frame of a cut that is not as it was configured with: call Cut::prepare between \
                     Cut::configure and this, and configure the frame after Cut::configure",
                );
            }
        };
        if state.decision.takes_over(owns_cut) && !is_next {
            return out_of_order(
                "prepare was given a frame that takes over from another than the one before: prepare frames in the order in \
                 which they were configured, and configure again after Renderer::forget",
            );
        }
        let draws = self.draws();
        let slot = self.frames.begin(&state.decision);
        slot.cut = (!owns_cut).then(|| state.cut.buffers().clone());
        let plan = &state.decision.plan;
        if plan.gaussians() > 0 {
            // SAFETY: the caller promises that `cmd` is recording, outside a rendering scope.
            let mut recorder =
                unsafe { Recorder::begin(&self.device, cmd, draws, slot.timer.as_mut()) };
            let depth = depth.zip(plan.occluders).map(|(depth, occluders)| {
                let under = depth.under(occluders.size);
                if !occluders.sampled {
                    let to = tiles::occluders(&state.buffers);
                    // SAFETY: the caller promises the image, its layout and that its depths are visible.
                    unsafe { recorder.copy_depth(depth, to, &under) };
                }
                HostDepth {
                    under,
                    sampled: (depth.view, depth.layout),
                }
            });
            let resources = EyeResources {
                cut: CutResources {
                    pipelines: &state.pipelines,
                    scene,
                    buffers: state.cut.buffers(),
                },
                buffers: &state.buffers,
                depth,
                sights: [state.decision.sight.as_ref(), self.seen.as_ref()],
            };
            recorder.under(self.name.as_deref(), |recorder| {
                passes::record(plan, recorder, resources, owns_cut, &slot.counts);
            });
            self.keep(scene, &state);
        }
        if let (Some(_), Some(earlier)) = (&state.decision.sight, &scene.earlier) {
            earlier.show();
        }
        self.seen.clone_from(&state.decision.sight);
        Ok(PreparedFrame {
            number: self.frames.prepared(),
            state,
        })
    }

    /// The draws that the next frame's barriers are between.
    pub(super) fn draws(&self) -> Draws {
        match self.desc.draws() {
            // Nobody else draws from its memory.
            Draws::Around if !self.frames.may_be_drawing() => Draws::After,
            draws => draws,
        }
    }

    /// Keeps what a frame has left in its buffers for the next one.
    fn keep(&mut self, scene: &SceneBuffers, state: &FrameState) {
        let plan = &state.decision.plan;
        let prepared = self.frames.prepared();
        let is_replaced = self.memory.keep_replaced(&state.buffers, prepared);
        if plan.work != Work::Draw {
            // Later frames find nothing in buffers that have been replaced.
            let keeps = self.desc.reuse && plan.occluders.is_none() && !is_replaced;
            self.previous = keeps.then(|| PreviousFrame::after(scene.id, plan));
        }
        if let FrameCut::Own(buffers) = &state.cut {
            self.cut.keep(scene.id, &plan.cut, (buffers, prepared));
            // The shortlists of a reclipped frame have replaced those of the sides.
            if !self.desc.reuse || (plan.reclips() && plan.cut.is_shortlisted()) {
                self.cut.found = None;
            }
        }
    }

    /// Records the splats, or the picture that the tiles have made of them, inside the host's rendering scope, blended
    /// `over` what is there: premultiplied colours, the same for all samples of a pixel. Where
    /// [`DepthDesc::write_alpha`](crate::DepthDesc::write_alpha) is set, their depths follow. `origin` is the upper left corner
    /// of the camera's picture in the attachment, whole px, where row 0 of the attachment is the upper one. This sets the
    /// viewport to that picture: the host's own, which may have a negative height, has no say in it. The host's scissor has.
    /// This may be recorded more than once for a frame.
    ///
    /// # Safety
    /// `cmd` is inside a rendering scope with the attachments of the [`RendererDesc`](crate::RendererDesc) and no others,
    /// one layer and no view mask but that of [`Target::in_view`](crate::gpu::Target::in_view); a scissor is set by
    /// `vkCmdSetScissor`; the commands of [`prepare`](Self::prepare) come before it.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) for another frame than the one that this renderer has prepared last, and for
    /// an `origin` that is not finite; nothing is recorded then.
    pub unsafe fn draw(
        &mut self,
        cmd: vk::CommandBuffer,
        origin: [f32; 2],
        frame: &PreparedFrame,
    ) -> Result<()> {
        let state = self.checked("draw", origin, frame)?;
        let (decision, buffers) = (&state.decision, &*state.buffers);
        let plan = &decision.plan;
        if plan.gaussians() == 0 || !plan.is_drawn {
            return Ok(());
        }
        let (map, targets) = (decision.depth_map, decision.targets);
        let pipelines = &state.pipelines;
        let pass = |drawer: &mut Drawer<'_>| {
            if !plan.is_tiled() {
                let frame = (plan, buffers);
                return passes::splat::record(
                    drawer,
                    pipelines,
                    frame,
                    targets.colour,
                    origin,
                    map,
                );
            }
            let mut composite = |part| {
                let draw = (composite::draw(plan, targets, part), buffers);
                composite::record(drawer, pipelines, draw, origin, (map, 1.0));
            };
            composite(Part::Colours);
            if plan.way.writes_depth {
                composite(Part::WrittenDepth);
            }
        };
        // SAFETY: the caller promises that `cmd` is recording inside a fitting rendering scope.
        unsafe { self.pass(cmd, "splat", (origin, plan.size()), pass) };
        Ok(())
    }

    /// Records the splats' depths inside a rendering scope of their own, with the attachments of
    /// [`RendererDesc::expected_depth`](crate::RendererDesc::expected_depth) and, if there is one, the same depth
    /// attachment, blended `over` what is there. Red is the sum of the depths, each times what its splat adds to the pixel's alpha, and
    /// green is that alpha. Where the host has cleared both to 0, red / green is the pixel's expected depth along the view
    /// axis, world units; further scenes over it keep that meaning. A splat's depth in a pixel is the mean of what the clip leaves of the Gaussian on
    /// the pixel's line of sight, to first order of perspective; of several planes the strictest that keeps the far side
    /// counts, and the strictest that keeps the near one. Tiles find the depths with the colours; splats that are drawn as quads are
    /// drawn once more. `origin` is as in [`draw`](Self::draw).
    ///
    /// # Safety
    /// As for [`draw`](Self::draw), in such a scope.
    ///
    /// # Errors
    /// As for [`draw`](Self::draw), and without [`RendererDesc::expected_depth`](crate::RendererDesc::expected_depth).
    pub unsafe fn draw_depth(
        &mut self,
        cmd: vk::CommandBuffer,
        origin: [f32; 2],
        frame: &PreparedFrame,
    ) -> Result<()> {
        let state = self.checked("draw_depth", origin, frame)?;
        if self.desc.expected_depth.is_none() {
            return out_of_order("draw_depth needs RendererDesc::expected_depth");
        }
        let (decision, buffers) = (&state.decision, &*state.buffers);
        let plan = &decision.plan;
        let attachments = decision.targets.expected_depth;
        let Some(attachments) = attachments.filter(|_| plan.gaussians() > 0) else {
            return Ok(());
        };
        let pipelines = &state.pipelines;
        let pass = |drawer: &mut Drawer<'_>| {
            let map = (decision.depth_map, decision.unit);
            if plan.is_tiled() {
                let part = Part::ExpectedDepth(attachments);
                let depths = (composite::draw(plan, decision.targets, part), buffers);
                composite::record(drawer, pipelines, depths, origin, map);
            } else {
                let frame = (plan, buffers);
                passes::depth::record_draw(drawer, pipelines, frame, attachments, origin, map);
            }
        };
        // SAFETY: the caller promises that `cmd` is recording inside a fitting rendering scope.
        unsafe { self.pass(cmd, "splat_depth", (origin, plan.size()), pass) };
        Ok(())
    }

    /// Records the splats' motion inside a rendering scope of its own, with the attachment of
    /// [`RendererDesc::motion`](crate::RendererDesc::motion) and, if there is one, the same depth attachment. Red and green are
    /// where what a pixel shows was in the frame that this renderer has prepared before, less where it is, px to the right and
    /// down in the camera's picture; blue is the number of its layer, and alpha is 1 if that frame could show it, else 0. A pixel
    /// shows the splat that adds most to its alpha, where that is on the pixel's line of sight, as
    /// [`draw_depth`](Self::draw_depth) says. The camera, the renderer's placement, those of the layers and edits of their
    /// Gaussians ([`LayerEdit::moves`](crate::LayerEdit::moves)) move it. A shift of the principal point, as for temporal
    /// antialiasing, counts as motion: a host that wants it without adds the difference of the two shifts.
    ///
    /// A clip that moves over Gaussians that stand still moves nothing: they are where they were. But where it keeps a place that
    /// it cut away before, alpha is 0, since there is nothing in the frame before that a host could blend with. In mode
    /// [`Mode::Hard`](crate::Mode::Hard) the centre of a Gaussian is that place. Clips that have more than 512 surfaces in the
    /// two frames together leave alpha at 1.
    ///
    /// Motion and alpha are 0 where there is no frame before, since [`forget`](Self::forget) too, where that showed a scene of
    /// another number of layers or in another projection, and where something was behind the eye; alpha also where the layer was
    /// hidden. Pixels whose alpha is below
    /// [`MotionDesc::least_alpha`](crate::MotionDesc::least_alpha) keep what the host has drawn. `origin` is as in
    /// [`draw`](Self::draw).
    ///
    /// # Safety
    /// As for [`draw`](Self::draw), in such a scope.
    ///
    /// # Errors
    /// As for [`draw`](Self::draw), and without [`RendererDesc::motion`](crate::RendererDesc::motion).
    pub unsafe fn draw_motion(
        &mut self,
        cmd: vk::CommandBuffer,
        origin: [f32; 2],
        frame: &PreparedFrame,
    ) -> Result<()> {
        let state = self.checked("draw_motion", origin, frame)?;
        let Some(MotionDesc { least_alpha, .. }) = self.desc.motion else {
            return out_of_order("draw_motion needs RendererDesc::motion");
        };
        let (decision, buffers) = (&state.decision, &*state.buffers);
        let plan = &decision.plan;
        let attachments = decision.targets.motion;
        let drawn = |_: &_| plan.gaussians() > 0 && plan.way.draws_motion;
        let (Some(attachments), Some(shapes)) = (attachments.filter(drawn), &state.shapes) else {
            return Ok(());
        };
        let pass = |drawer: &mut Drawer<'_>| {
            let frame = (plan, buffers, shapes);
            motion::record(
                drawer,
                &state.pipelines,
                frame,
                attachments,
                (origin, least_alpha),
            );
        };
        // SAFETY: the caller promises that `cmd` is recording inside a fitting rendering scope.
        unsafe { self.pass(cmd, "splat_motion", (origin, plan.size()), pass) };
        Ok(())
    }

    /// Records a pass of draws into the picture of a camera, which has its upper left corner and its size in the attachment, px.
    ///
    /// # Safety
    /// `cmd` is recording inside a rendering scope with the attachments of the pipelines.
    unsafe fn pass(
        &mut self,
        cmd: vk::CommandBuffer,
        name: &'static str,
        (origin, size): ([f32; 2], [f32; 2]),
        record: impl FnOnce(&mut Drawer<'_>),
    ) {
        let timer = self.frames.newest_mut().and_then(|frame| {
            frame.is_drawn = true;
            frame.timer.as_mut()
        });
        // SAFETY: the caller's promise.
        let mut drawer = unsafe { Drawer::new(&self.device, cmd, timer) };
        drawer.under(self.name.as_deref(), |drawer| {
            drawer.pass(name, |drawer| {
                drawer.picture(origin, size);
                record(drawer);
            });
        });
    }

    /// What a frame is drawn with, if it is the last prepared one and `origin` a place.
    fn checked<'a>(
        &self,
        call: &str,
        origin: [f32; 2],
        frame: &'a PreparedFrame,
    ) -> Result<&'a FrameState> {
        let [x, y] = origin;
        if !(x.is_finite() && y.is_finite()) {
            return out_of_order(&format!(
                "{call} was given the origin {x}, {y}: give the upper left corner of the camera's picture in the attachment, px"
            ));
        }
        let is_newest = frame.number == self.frames.prepared();
        if frame.state.renderer != self.id || !is_newest {
            return out_of_order(&format!(
                "{call} needs the frame that this renderer has prepared last"
            ));
        }
        Ok(&frame.state)
    }
}
