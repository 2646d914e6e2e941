//! Records a configured frame into the host's command buffer: the stages, and the draws.

use ash::vk;

use super::frames::Ready;
use super::{Renderer, out_of_order};
use crate::error::Result;
use crate::gpu::{DepthImage, Drawer, Recorder};
use crate::passes::{self, Frame, Kept, SceneBuffers, Work, tiles};

impl Renderer {
    /// Records the stages up to the draw, outside any rendering scope.
    ///
    /// # Safety
    /// `cmd` is in the recording state, outside a rendering scope, on a queue family with compute and graphics, and
    /// will be submitted to the device's queue, or never. `scene` is the one given to [`configure`](Self::configure)
    /// and lives until the commands have executed. The host has waited for the frames that [`Renderer`] says.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) without a successful [`configure`](Self::configure) before it, with another
    /// scene, and where [`DepthDesc::readable`](crate::DepthDesc::readable) promises the host's depth. Nothing is recorded then.
    pub unsafe fn prepare(&mut self, cmd: vk::CommandBuffer, scene: &SceneBuffers) -> Result<()> {
        if self.desc.depth.is_some_and(|depth| depth.readable) {
            return out_of_order("prepare was promised the host's depth: prepare_behind takes it");
        }
        // SAFETY: the caller's promises are those asked for.
        unsafe { self.prepare_with(cmd, scene, None) }
    }

    /// As [`prepare`](Self::prepare), but with the depth that the host has drawn already, so that tiles leave out the splats
    /// behind it. The renderer's [`DepthDesc::readable`](crate::DepthDesc::readable) asks for it. The picture is the same
    /// as that of quads, which test each sample against the attachment itself. Tiles of such a frame are computed anew even
    /// where [`RendererDesc::reuse`](crate::RendererDesc::reuse) is set.
    ///
    /// The part of the image under the viewport is copied, at `COPY` by `TRANSFER_READ`. The host's barrier before makes its
    /// depths visible to the copy, and its barrier after waits for the copy before the image changes layout or contents.
    ///
    /// # Safety
    /// As for [`prepare`](Self::prepare); and `depth` is as its description says, visible to the copy, and lives until
    /// the commands have executed.
    ///
    /// # Errors
    /// As for [`prepare`](Self::prepare), and where [`DepthDesc::readable`](crate::DepthDesc::readable) is not set.
    pub unsafe fn prepare_behind(
        &mut self,
        cmd: vk::CommandBuffer,
        scene: &SceneBuffers,
        depth: &DepthImage,
    ) -> Result<()> {
        if !self.desc.depth.is_some_and(|depth| depth.readable) {
            return out_of_order("prepare_behind needs DepthDesc::readable");
        }
        // SAFETY: the caller's promises are those asked for.
        unsafe { self.prepare_with(cmd, scene, Some(depth)) }
    }

    /// # Safety
    /// As for [`prepare`](Self::prepare) or, with `depth`, [`prepare_behind`](Self::prepare_behind).
    unsafe fn prepare_with(
        &mut self,
        cmd: vk::CommandBuffer,
        scene: &SceneBuffers,
        depth: Option<&DepthImage>,
    ) -> Result<()> {
        let Some(mut ready) = self.configured.take() else {
            return out_of_order("prepare needs a successful configure() before it");
        };
        // SAFETY: the caller's promises are those asked for.
        let prepared = unsafe { self.prepare_ready(cmd, scene, depth, &mut ready) };
        self.configured = Some(ready);
        prepared
    }

    /// # Safety
    /// As for [`prepare_with`](Self::prepare_with).
    pub(super) unsafe fn prepare_ready(
        &mut self,
        cmd: vk::CommandBuffer,
        scene: &SceneBuffers,
        depth: Option<&DepthImage>,
        ready: &mut Ready,
    ) -> Result<()> {
        if ready.frame.scene != scene.id {
            return out_of_order("prepare was given another scene than configure()");
        }
        if ready.takes_over() && !ready.frame.prepared && ready.basis != self.basis() {
            return out_of_order(
                "prepare was given a frame that takes over from another than the one before: prepare frames in the order in \
                 which they were configured, and configure again after forget()",
            );
        }
        let Ready {
            frame: configured,
            buffers,
            pipelines,
            number,
            ..
        } = ready;
        configured.prepared = true;
        *number = self.frames.prepared() + 1;
        let slot = self.frames.begin(configured);
        let plan = &configured.plan;
        if plan.gaussians() == 0 {
            return Ok(());
        }
        // SAFETY: the caller promises that `cmd` is recording, outside a rendering scope.
        let mut recorder = unsafe { Recorder::begin(&self.device, cmd, slot.timer.as_mut()) };
        let occluders = depth.zip(plan.occluders).zip(buffers.tiles.as_ref()).map(
            |((depth, occluders), tiles)| {
                // SAFETY: the caller promises the image, its layout and that its depths are visible.
                unsafe { recorder.copy_depth(depth, &tiles.occluders, occluders.size) }
            },
        );
        let copied = occluders.unwrap_or_default();
        let frame = Frame {
            plan,
            pipelines,
            scene,
            buffers,
            copied,
        };
        passes::record(&frame, &mut recorder, &slot.counts);
        let is_replaced = self.memory.keep_replaced(buffers, self.frames.prepared());
        if plan.work != Work::Draw {
            let before = self.kept.take();
            // Later frames find nothing in buffers that have been replaced.
            let keeps = self.desc.reuse && plan.occluders.is_none() && !is_replaced;
            self.kept = keeps.then(|| Kept::after(before, scene.id, plan));
        }
        Ok(())
    }

    /// Records the splats, or the picture that the tiles have made of them, inside the host's rendering scope, blended
    /// `over` what is there: premultiplied colours, the same for all samples of a pixel. `origin` is the upper left corner
    /// of the camera's picture in the attachment, whole px, where row 0 of the attachment is the upper one. This sets the
    /// viewport to that picture: the host's own, which may have a negative height, has no say in it. The host's scissor has.
    /// This may be recorded more than once for a prepared frame.
    ///
    /// # Safety
    /// `cmd` is inside a rendering scope with the attachments of the [`RendererDesc`](crate::RendererDesc) and no others,
    /// one layer and no view mask; a scissor is set by `vkCmdSetScissor`; [`prepare`](Self::prepare) was recorded for the
    /// same frame before it.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) without a prepared frame, and for an `origin` that is not finite; nothing is
    /// recorded then.
    pub unsafe fn draw(&mut self, cmd: vk::CommandBuffer, origin: [f32; 2]) -> Result<()> {
        check_origin("draw", origin)?;
        let ready = self.take_prepared("draw")?;
        // SAFETY: the caller's promises are those asked for, and the frame is prepared.
        unsafe { self.draw_ready(cmd, origin, &ready) };
        self.configured = Some(ready);
        Ok(())
    }

    /// Takes the frame that is configured and prepared, which is to be put back.
    fn take_prepared(&mut self, call: &str) -> Result<Ready> {
        match self.configured.take() {
            Some(ready) if self.is_prepared(&ready) => Ok(ready),
            other => {
                self.configured = other;
                out_of_order(&format!(
                    "{call} needs a successful configure() and prepare() before it"
                ))
            }
        }
    }

    /// # Safety
    /// As for [`draw`](Self::draw); the frame is prepared.
    pub(super) unsafe fn draw_ready(
        &mut self,
        cmd: vk::CommandBuffer,
        origin: [f32; 2],
        ready: &Ready,
    ) {
        let (configured, buffers) = (&ready.frame, &*ready.buffers);
        let plan = &configured.plan;
        if plan.gaussians() == 0 || !plan.is_drawn {
            return;
        }
        let (map, targets) = (configured.depth_map, configured.targets);
        let pipelines = &ready.pipelines;
        let tiled = buffers.tiles.as_ref().filter(|_| plan.is_tiled());
        let newest = self.frames.newest_mut();
        let timer = newest.and_then(|frame| frame.timer.as_mut());
        // SAFETY: the caller promises that `cmd` is recording inside a fitting rendering scope.
        let mut drawer = unsafe { Drawer::new(&self.device, cmd, timer) };
        drawer.pass("splat", |drawer| {
            drawer.picture(origin, plan.size());
            let frame = (plan, buffers);
            passes::splat::record(drawer, pipelines, frame, targets.colour, origin, map);
            if let Some(t) = tiled {
                tiles::record_composite(drawer, pipelines, (plan, buffers, t), targets, origin);
            }
        });
    }

    /// Records the splats' depths inside a rendering scope of their own, with the attachments of
    /// [`RendererDesc::expected_depth`](crate::RendererDesc::expected_depth) and, if there is one, the same depth
    /// attachment, blended `over` what is there. Red is the sum of the depths, each times what its splat adds to the pixel's alpha, and
    /// green is that alpha. Where the host has cleared both to 0, red / green is the pixel's expected depth along the view
    /// axis, world units; further scenes over it keep that meaning. A splat's depth in a pixel is the mean of what the clip leaves of the Gaussian on
    /// the pixel's line of sight, to first order of perspective; of several planes the strictest that keeps the far side
    /// counts, and the strictest that keeps the near one. The depths are drawn as quads, however the colours are. `origin`
    /// is as in [`draw`](Self::draw).
    ///
    /// # Safety
    /// As for [`draw`](Self::draw), in such a scope.
    ///
    /// # Errors
    /// As for [`draw`](Self::draw), and without [`RendererDesc::expected_depth`](crate::RendererDesc::expected_depth).
    pub unsafe fn draw_depth(&mut self, cmd: vk::CommandBuffer, origin: [f32; 2]) -> Result<()> {
        check_origin("draw_depth", origin)?;
        if self.desc.expected_depth.is_none() {
            return out_of_order("draw_depth needs RendererDesc::expected_depth");
        }
        let ready = self.take_prepared("draw_depth")?;
        // SAFETY: the caller's promises are those asked for, and the frame is prepared.
        unsafe { self.draw_depth_ready(cmd, origin, &ready) };
        self.configured = Some(ready);
        Ok(())
    }

    /// # Safety
    /// As for [`draw_depth`](Self::draw_depth); the frame is prepared.
    pub(super) unsafe fn draw_depth_ready(
        &mut self,
        cmd: vk::CommandBuffer,
        origin: [f32; 2],
        ready: &Ready,
    ) {
        let (configured, buffers) = (&ready.frame, &*ready.buffers);
        let plan = &configured.plan;
        if plan.gaussians() == 0 {
            return;
        }
        let targets = configured.targets;
        let (Some(attachments), Some(depths)) = (targets.expected_depth, &buffers.depth) else {
            return;
        };
        let pipelines = &ready.pipelines;
        let newest = self.frames.newest_mut();
        let timer = newest.and_then(|frame| frame.timer.as_mut());
        // SAFETY: the caller promises that `cmd` is recording inside a fitting rendering scope.
        let mut drawer = unsafe { Drawer::new(&self.device, cmd, timer) };
        drawer.pass("splat_depth", |drawer| {
            drawer.picture(origin, plan.size());
            let frame = (plan, buffers, depths);
            let map = (configured.depth_map, configured.unit);
            passes::depth::record_draw(drawer, pipelines, frame, attachments, origin, map);
        });
    }
}

/// Refuses a corner that is nowhere, which would draw nothing without a word.
pub(super) fn check_origin(call: &str, origin: [f32; 2]) -> Result<()> {
    if origin.iter().all(|number| number.is_finite()) {
        return Ok(());
    }
    let [x, y] = origin;
    out_of_order(&format!(
        "{call} was given the origin {x}, {y}: give the upper left corner of the camera's picture in the attachment, px"
    ))
}
