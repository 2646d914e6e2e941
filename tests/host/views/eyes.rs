//! Two eyes: in one scope, and one after the other.

use super::*;
use rara::gpu::Device;
use rara::{ConfiguredFrame, PreparedFrame};

/// Two eyes before a scene.
fn eyes(scene: &Gaussians) -> [Camera; 2] {
    let middle = common::views(scene, 3, SIZE)[1];
    let aside = middle.rotation.transpose() * DVec3::X * 0.1;
    [-1.0, 1.0].map(|side| middle.eye(middle.eye + side * aside))
}

/// The part of a wide target that belongs to the view at column `left`.
fn part(pixels: &[[f32; 4]], left: u32) -> Vec<[f32; 4]> {
    let rows = pixels.chunks_exact(2 * SIZE.0 as usize);
    let part = |row: &[[f32; 4]]| row[left as usize..][..SIZE.0 as usize].to_vec();
    rows.flat_map(part).collect()
}

/// How many compiled pipelines a renderer knows.
fn pipelines(renderer: &Renderer) -> usize {
    format!("{renderer:?}").matches("Pipeline {").count()
}

/// Two eyes before a scene, whose pictures lie side by side on a canvas.
struct Eyes<'a> {
    device: &'a Device,
    canvas: Canvas,
    scene: SceneBuffers,
    cameras: [Camera; 2],
    clip: Clip,
    truth: [Picture; 2],
}

/// The columns at which the eyes' pictures begin.
const LEFTS: [u32; 2] = [0, SIZE.0];

/// Runs a test with two eyes and a clip of so many planes.
fn with_eyes(planes: usize, test: impl FnOnce(&Eyes)) {
    let scene = generate(Kind::General, 3_000, 5);
    let cameras = eyes(&scene);
    let clip = common::clip(&scene, planes, ClipOp::And);
    let truth = cameras.map(|eye| headless(&scene, &eye, &clip));
    with_host(true, |host, device| {
        let wide = CanvasDesc::new((2 * SIZE.0, SIZE.1), FLOATS);
        test(&Eyes {
            device,
            canvas: Canvas::new(&host.lend(), device, wide),
            scene: SceneBuffers::upload(device, &scene, ShFormat::Float).expect("uploads"),
            cameras,
            clip,
            truth,
        });
    });
}

/// A renderer, and the frame that it draws next.
struct EyeFrame {
    renderer: Renderer,
    configured: Option<ConfiguredFrame>,
    prepared: Option<PreparedFrame>,
}

type Eye = RefCell<EyeFrame>;

impl EyeFrame {
    fn new(renderer: Renderer) -> Eye {
        RefCell::new(Self {
            renderer,
            configured: None,
            prepared: None,
        })
    }

    fn configure(&mut self, eyes: &Eyes<'_>, camera: &Camera, way: Raster) {
        let configured = self
            .renderer
            .configure(&eyes.scene, camera, &eyes.clip, &raster(way));
        self.configured = Some(configured.expect("configures"));
    }

    fn prepare(&mut self, eyes: &Eyes<'_>, cmd: vk::CommandBuffer) {
        let frame = self.configured.take().expect("it was configured");
        // SAFETY: recording outside a scope, and all is waited for.
        let prepared = unsafe { self.renderer.prepare(cmd, &eyes.scene, None, frame) };
        self.prepared = Some(prepared.expect("prepares"));
    }
}

impl Eyes<'_> {
    /// Draws an eye's picture, inside the canvas's scope and after it was prepared.
    fn draw(&self, cmd: vk::CommandBuffer, eye: &Eye, left: u32) {
        self.canvas.viewport(cmd, left as i32, 0, SIZE);
        let mut eye = eye.borrow_mut();
        let prepared = eye.prepared.take().expect("it was prepared");
        // SAFETY: every test calls this in the canvas's scope, which the renderer was made for.
        let drawn = unsafe { eye.renderer.draw(cmd, [left as f32, 0.0], &prepared) };
        drawn.expect("draws");
    }

    /// Asserts that the canvas shows the headless pictures.
    fn assert_shown(&self, way: Raster, pixels: &[[f32; 4]]) {
        for (truth, left) in self.truth.iter().zip(LEFTS) {
            let worst = apart(&part(pixels, left), &truth.pixels, 0.0);
            assert!(worst < 1.0, "{way:?}, from {left}: {worst}/255");
        }
    }
}

#[test]
fn two_eyes_share_a_scope_and_compile_nothing_twice() {
    with_eyes(1, |eyes| {
        for way in [Raster::Tiles, Raster::Quad] {
            let first = Renderer::new(eyes.device, desc()).expect("a renderer");
            let second = first.sharing(desc()).expect("another");
            let renderers = [first, second].map(EyeFrame::new);
            let mut compiled = Vec::new();
            for (renderer, eye) in renderers.iter().zip(&eyes.cameras) {
                let mut renderer = renderer.borrow_mut();
                renderer.configure(eyes, eye, way);
                compiled.push(pipelines(&renderer.renderer));
            }
            assert!(compiled[0] > 5, "{compiled:?}");
            assert_eq!(compiled[0], compiled[1], "the second found them all");
            let before = |cmd| {
                for renderer in &renderers {
                    renderer.borrow_mut().prepare(eyes, cmd);
                }
            };
            let inside = |cmd| {
                for (renderer, left) in renderers.iter().zip(LEFTS) {
                    eyes.draw(cmd, renderer, left);
                }
            };
            let [pixels, _] = eyes.canvas.draw(before, inside);
            eyes.assert_shown(way, &pixels);
        }
    });
}

#[test]
fn one_renderer_draws_views_one_after_the_other_in_one_command_buffer() {
    with_eyes(2, |eyes| {
        for (way, bindings) in [
            (Raster::Tiles, Bindings::Mixed),
            (Raster::Quad, Bindings::Mixed),
            (Raster::Tiles, Bindings::Address),
        ] {
            let two = desc().frames_in_flight(2).bindings(bindings);
            let renderer = EyeFrame::new(Renderer::new(eyes.device, two).expect("a renderer"));
            let prepare = |cmd, eye: usize| {
                let mut renderer = renderer.borrow_mut();
                renderer.configure(eyes, &eyes.cameras[eye], way);
                renderer.prepare(eyes, cmd);
            };
            let draw = |cmd, left| eyes.draw(cmd, &renderer, left);
            let [pixels, _] = eyes.canvas.draw_scopes(&mut [
                (&mut |cmd| prepare(cmd, 0), &mut |cmd| draw(cmd, LEFTS[0])),
                (&mut |cmd| prepare(cmd, 1), &mut |cmd| draw(cmd, LEFTS[1])),
            ]);
            eyes.assert_shown(way, &pixels);
        }
    });
}
