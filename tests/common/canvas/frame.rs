//! A renderer's frame on a canvas.

use std::cell::{OnceCell, RefCell};

use rara::ash::vk;
use rara::gpu::DepthImage;
use rara::{ConfiguredFrame, PreparedFrame, Renderer, SceneBuffers};

use super::Canvas;

/// One of a renderer's draws.
pub type Call =
    unsafe fn(&mut Renderer, vk::CommandBuffer, [f32; 2], &PreparedFrame) -> rara::Result<()>;

/// A camera's picture on a canvas.
pub struct Frame {
    /// The picture's size.
    pub size: (u32, u32),
    /// The pixel of the canvas at which the picture begins.
    pub origin: (i32, i32),
    /// The depth that the renderer reads, if it reads one.
    pub behind: Option<DepthImage>,
    /// What is drawn: colours by [`Renderer::draw`], or something else.
    pub call: Call,
}

impl Frame {
    /// A picture of colours in the canvas's upper left corner, by a renderer that reads no depth.
    pub fn new(size: (u32, u32)) -> Self {
        Self {
            size,
            origin: (0, 0),
            behind: None,
            call: Renderer::draw,
        }
    }
}

impl Canvas {
    /// Draws a frame that the renderer has configured, and waits; returns the picture of the first colour attachment.
    pub fn draw_frame(
        &self,
        renderer: &mut Renderer,
        scene: &SceneBuffers,
        configured: rara::Result<ConfiguredFrame>,
        frame: &Frame,
    ) -> Vec<[f32; 4]> {
        let renderer = RefCell::new(renderer);
        let mut configured = Some(configured.expect("configures"));
        let prepared = OnceCell::new();
        let before = |cmd| {
            let mut renderer = renderer.borrow_mut();
            let (depth, configured) = (frame.behind.as_ref(), configured.take().expect("once"));
            let prepare = || {
                // SAFETY: `cmd` is recording outside a scope, a depth is ready to be read, and all is waited for.
                let made = unsafe { renderer.prepare(cmd, scene, depth, configured) };
                prepared.get_or_init(|| made.expect("prepares"));
            };
            match depth {
                Some(depth) if depth.view != vk::ImageView::null() => self.sampling(cmd, prepare),
                _ => prepare(),
            }
        };
        let inside = |cmd| {
            let (x, y) = frame.origin;
            self.viewport(cmd, x, y, frame.size);
            let mut renderer = renderer.borrow_mut();
            let origin = [x as f32, y as f32];
            let prepared = prepared.get().expect("it was prepared");
            // SAFETY: `cmd` is inside the canvas's scope, which the renderer was made for.
            let drawn = unsafe { (frame.call)(&mut renderer, cmd, origin, prepared) };
            drawn.expect("draws");
        };
        let [pixels, _] = self.draw(before, inside);
        pixels
    }
}
