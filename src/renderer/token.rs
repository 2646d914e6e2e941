//! Frames that are configured ahead: a host configures the next one while it records this one.

use std::sync::Arc;

use ash::vk;

use super::frames::Ready;
use super::outcome::Submission;
use super::record::check_origin;
use super::request::FrameRequest;
use super::{Renderer, out_of_order};
use crate::camera::Camera;
use crate::clip::Clip;
use crate::error::Result;
use crate::gpu::DepthImage;
use crate::passes::SceneBuffers;
use crate::settings::Settings;

/// A frame that [`Renderer::configure_ahead`] has configured, to be prepared and drawn whatever is configured after it. It
/// keeps the memory that it is recorded with. One that is never prepared is dropped.
#[derive(Debug)]
pub struct FrameToken {
    ready: Ready,
    /// Of the renderer; shared as long as the frame is not prepared.
    pending: Option<Arc<()>>,
    renderer: u64,
}

impl Renderer {
    /// As [`configure`](Self::configure), for a host that configures a frame while it records another: the frame goes with
    /// the token, and what [`configure`](Self::configure) has configured stays. Frames are prepared in the order in which they
    /// are configured. The host may configure frame `n` before it has waited for frame `n - frames_in_flight`, and waits for that
    /// before it prepares frame `n`. A frame that is
    /// configured while another one waits to be prepared takes nothing over from it, whatever
    /// [`RendererDesc::reuse`](super::RendererDesc::reuse) says. What reports on the configured frame, as
    /// [`skipped`](Self::skipped), is about [`configure`](Self::configure)'s.
    ///
    /// # Errors
    /// As for [`configure`](Self::configure).
    pub fn configure_ahead(
        &mut self,
        scene: &SceneBuffers,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<FrameToken> {
        let ready = self.ready(&FrameRequest {
            submission: Submission::Ahead,
            ..FrameRequest::in_flight(scene, camera, clip, settings)
        })?;
        Ok(FrameToken {
            ready,
            pending: Some(self.pending.clone()),
            renderer: self.id,
        })
    }

    /// Records the stages of a token's frame, as [`prepare`](Self::prepare) or, with the host's depth,
    /// [`prepare_behind`](Self::prepare_behind) do for that of [`configure`](Self::configure).
    ///
    /// # Safety
    /// As for those; `scene` is the one given to [`configure_ahead`](Self::configure_ahead).
    ///
    /// # Errors
    /// As for those, and [`Error::Invalid`](crate::Error::Invalid) for another renderer's token, one that is prepared, and
    /// one that takes over from another frame than the last prepared one. Nothing is recorded then.
    pub unsafe fn prepare_token(
        &mut self,
        cmd: vk::CommandBuffer,
        scene: &SceneBuffers,
        depth: Option<&DepthImage>,
        token: &mut FrameToken,
    ) -> Result<()> {
        if token.renderer != self.id {
            return out_of_order("prepare_token was given another renderer's token");
        }
        if token.pending.is_none() {
            return out_of_order("prepare_token was given a frame that is prepared already");
        }
        if self.desc.depth.is_some_and(|depth| depth.readable) != depth.is_some() {
            return out_of_order(
                "prepare_token takes a depth with DepthDesc::readable, and only then",
            );
        }
        // SAFETY: the caller's promises are those asked for.
        unsafe { self.prepare_ready(cmd, scene, depth, &mut token.ready) }?;
        token.pending = None;
        Ok(())
    }

    /// Records a token's splats, as [`draw`](Self::draw) does for the frame of [`configure`](Self::configure), before another
    /// frame is prepared.
    ///
    /// # Safety
    /// As for [`draw`](Self::draw).
    ///
    /// # Errors
    /// As for [`draw`](Self::draw), and where the token's frame is not the last prepared one.
    pub unsafe fn draw_token(
        &mut self,
        cmd: vk::CommandBuffer,
        origin: [f32; 2],
        token: &FrameToken,
    ) -> Result<()> {
        check_origin("draw_token", origin)?;
        self.check_token("draw_token", token)?;
        // SAFETY: the caller's promises are those asked for, and the frame is prepared.
        unsafe { self.draw_ready(cmd, origin, &token.ready) };
        Ok(())
    }

    /// Records a token's expected depths, as [`draw_depth`](Self::draw_depth) does for the frame of
    /// [`configure`](Self::configure), before another frame is prepared.
    ///
    /// # Safety
    /// As for [`draw_depth`](Self::draw_depth).
    ///
    /// # Errors
    /// As for [`draw_depth`](Self::draw_depth), and where the token's frame is not the last prepared one.
    pub unsafe fn draw_token_depth(
        &mut self,
        cmd: vk::CommandBuffer,
        origin: [f32; 2],
        token: &FrameToken,
    ) -> Result<()> {
        check_origin("draw_token_depth", origin)?;
        if self.desc.expected_depth.is_none() {
            return out_of_order("draw_token_depth needs RendererDesc::expected_depth");
        }
        self.check_token("draw_token_depth", token)?;
        // SAFETY: the caller's promises are those asked for, and the frame is prepared.
        unsafe { self.draw_depth_ready(cmd, origin, &token.ready) };
        Ok(())
    }

    fn check_token(&self, call: &str, token: &FrameToken) -> Result<()> {
        if token.renderer != self.id || !self.is_prepared(&token.ready) {
            return out_of_order(&format!(
                "{call} needs the token of the frame that this renderer has prepared last"
            ));
        }
        Ok(())
    }
}
