//! Two eyes: in one scope, and one after the other.

use super::*;
use rara::gpu::{DepthImage, Device, Target};
use rara::{ConfiguredFrame, DepthDesc, DepthMap, PreparedFrame};

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

/// The layers of a host's images are its eyes, and one scope draws both, in dynamic rendering and in a classic render pass.
#[test]
fn each_eye_draws_into_its_view_of_one_scope() {
    let gaussians = generate(Kind::General, 3_000, 5);
    let cameras = eyes(&gaussians);
    let clip = common::clip(&gaussians, 1, ClipOp::And);
    let map = DepthMap::ordinary(0.1, 100.0).expect("a map");
    with_host(true, |host, device| {
        let scene = SceneBuffers::upload(device, &gaussians, ShFormat::Float).expect("uploads");
        let canvas = |layers, render_pass| {
            let desc = CanvasDesc {
                layers,
                render_pass,
                clear: [0.1, 0.2, 0.3, 1.0],
                depth: vk::Format::D32_SFLOAT,
                ..CanvasDesc::new(SIZE, FLOATS)
            };
            Canvas::new(&host.lend(), device, desc)
        };
        let depth = DepthDesc::new(vk::Format::D32_SFLOAT, map)
            .readable(true)
            .write_alpha(Some(0.5));
        let draw = |canvas: &Canvas, eyes: &[(Target, Camera)]| {
            let eyes = eyes.iter().map(|(target, camera)| {
                let desc = desc().target(*target).depth(Some(depth));
                let mut renderer = Renderer::new(device, desc).expect("a renderer");
                let frame = renderer.configure(&scene, camera, &clip, &Settings::default());
                (renderer, Some(frame.expect("configures")), None)
            });
            let eyes = RefCell::new(eyes.collect::<Vec<_>>());
            let before = |cmd| {
                for (layer, eye) in (0..).zip(eyes.borrow_mut().iter_mut()) {
                    let (renderer, frame, prepared) = eye;
                    let behind = DepthImage {
                        layer,
                        ..canvas.depth_image(0, 0)
                    };
                    let frame = frame.take().expect("once");
                    // SAFETY: recording outside a scope, the depth is ready to be copied, and all is waited for.
                    let made = unsafe { renderer.prepare(cmd, &scene, Some(&behind), frame) };
                    *prepared = Some(made.expect("prepares"));
                }
            };
            let inside = |cmd| {
                canvas.viewport(cmd, 0, 0, SIZE);
                for (renderer, _, prepared) in eyes.borrow_mut().iter_mut() {
                    let prepared = prepared.as_ref().expect("it was prepared");
                    // SAFETY: inside the scope that the renderer was made for.
                    unsafe { renderer.draw(cmd, [0.0; 2], prepared) }.expect("draws");
                }
            };
            let [pixels, _] = canvas.draw(before, inside);
            (pixels, canvas.depths())
        };
        let alone = canvas(1, false);
        let [left, right] = cameras.map(|camera| draw(&alone, &[(Target::DYNAMIC, camera)]));
        assert!(left != right);
        let expected = ([left.0, right.0].concat(), [left.1, right.1].concat());
        for render_pass in [false, true] {
            let layered = canvas(2, render_pass);
            let target = match render_pass {
                false => Target::DYNAMIC,
                // SAFETY: the pass is the canvas's, which outlives the renderers.
                true => unsafe { Target::render_pass(layered.render_pass(), 0) },
            };
            let eyes = [0, 1].map(|eye| (target.in_view(0b11, eye), cameras[eye as usize]));
            let drawn = draw(&layered, &eyes);
            assert!(drawn == expected, "render pass: {render_pass}");
        }
        // Quads would be drawn into every view.
        let renderer = Renderer::new(device, desc().target(Target::DYNAMIC.in_view(0b11, 0)));
        let mut renderer = renderer.expect("a renderer");
        let refused = renderer.configure(&scene, &cameras[0], &clip, &raster(Raster::Quad));
        let refused = refused.expect_err("of quads").to_string();
        assert!(refused.contains("view of a view mask"), "{refused}");
        let hidden = DepthDesc::new(vk::Format::D32_SFLOAT, map);
        for (view, depth, part) in [(2, None, "view mask lacks"), (1, Some(hidden), "readable")] {
            let desc = desc()
                .target(Target::DYNAMIC.in_view(0b11, view))
                .depth(depth);
            let refused = Renderer::new(device, desc)
                .expect_err("no such view")
                .to_string();
            assert!(refused.contains(part), "{refused}");
        }
    });
}

/// An eye of a cut: what it draws with, into which target, and what it sees.
struct OfCut {
    desc: RendererDesc,
    canvas: Canvas,
    eye: RefCell<(Renderer, Option<PreparedFrame>)>,
    camera: Camera,
    settings: Settings,
}

#[test]
fn eyes_of_one_cut_have_sizes_targets_and_formats_of_their_own() {
    let gaussians = generate(Kind::General, 3_000, 5);
    let [left, right] = eyes(&gaussians);
    let right = right.width(64).height(81).cx(32.0).cy(40.5);
    let unorm = vk::Format::R8G8B8A8_UNORM;
    with_host(true, |host, device| {
        let mut scene = SceneBuffers::upload(device, &gaussians, ShFormat::Float).expect("uploads");
        let descs = [desc(), RendererDesc::new(unorm).bindings(Bindings::Address)];
        let first = Renderer::new(device, descs[0]).expect("a renderer");
        let second = first.sharing(descs[1]).expect("another");
        let mut cut = Cut::new(&first);
        let of_cut = |renderer, desc, camera: Camera, format, way| OfCut {
            desc,
            canvas: Canvas::new(
                &host.lend(),
                device,
                CanvasDesc::new((camera.width, camera.height), format),
            ),
            eye: RefCell::new((renderer, None)),
            camera,
            settings: raster(way),
        };
        let both = [
            of_cut(first, descs[0], left, FLOATS, Raster::Tiles),
            of_cut(second, descs[1], right, unorm, Raster::Quad),
        ];
        for (planes, hides) in [(1, false), (2, false), (2, true), (0, true)] {
            let clip = common::clip(&gaussians, planes, ClipOp::And);
            let state = LayerState::default().visible(!hides);
            scene.set_layer_state(0, state).expect("a state");
            let usual = Settings::default();
            cut.configure(&scene, &clip, &usual).expect("a cut");
            let cut = RefCell::new(&mut cut);
            let prepare = |of: &OfCut, cmd| {
                let (renderer, prepared) = &mut *of.eye.borrow_mut();
                let mut cut = cut.borrow_mut();
                // SAFETY: recording outside a scope, and all is waited for.
                unsafe { cut.prepare(cmd) }.expect("records once");
                let frame = renderer.configure(&scene, &of.camera, &**cut, &of.settings);
                let frame = frame.expect("configures");
                assert!(frame.skipped().contains(&"clip"), "the cut has found it");
                // SAFETY: the same.
                let frame = unsafe { renderer.prepare(cmd, &scene, None, frame) };
                *prepared = Some(frame.expect("prepares"));
            };
            let draw = |of: &OfCut, cmd| {
                let (renderer, prepared) = &mut *of.eye.borrow_mut();
                of.canvas
                    .viewport(cmd, 0, 0, (of.camera.width, of.camera.height));
                let prepared = prepared.as_ref().expect("it was prepared");
                // SAFETY: inside the scope of the canvas that the renderer was made for.
                unsafe { renderer.draw(cmd, [0.0; 2], prepared) }.expect("draws");
            };
            let [one, two] = &both;
            let drawn = Canvas::draw_together(&mut [
                (
                    &one.canvas,
                    &mut [(&mut |cmd| prepare(one, cmd), &mut |cmd| draw(one, cmd))],
                ),
                (
                    &two.canvas,
                    &mut [(&mut |cmd| prepare(two, cmd), &mut |cmd| draw(two, cmd))],
                ),
            ]);
            for (of, [pixels, _]) in both.iter().zip(drawn) {
                // The same by a renderer that is given the clip.
                let mut eye = of.eye.borrow_mut();
                let renderer = eye.0.sharing(of.desc).expect("another");
                eye.1 = None;
                let alone = RefCell::new((renderer, None));
                let [expected, _] = of.canvas.draw(
                    |cmd| {
                        let (renderer, prepared) = &mut *alone.borrow_mut();
                        let frame = renderer.configure(&scene, &of.camera, &clip, &of.settings);
                        // SAFETY: as above.
                        let frame = unsafe {
                            renderer.prepare(cmd, &scene, None, frame.expect("configures"))
                        };
                        *prepared = Some(frame.expect("prepares"));
                    },
                    |cmd| {
                        let (renderer, prepared) = &mut *alone.borrow_mut();
                        of.canvas
                            .viewport(cmd, 0, 0, (of.camera.width, of.camera.height));
                        // SAFETY: as above.
                        unsafe { renderer.draw(cmd, [0.0; 2], prepared.as_ref().expect("it")) }
                            .expect("draws");
                    },
                );
                assert!(
                    pixels == expected,
                    "{planes} planes, hidden {hides}, {:?}",
                    of.camera
                );
                let shows = expected.iter().any(|pixel| pixel[3] > 0.5);
                assert_eq!(shows, !hides);
            }
        }
    });
}

/// A host that configures on one thread and records on another has the next frame's cut configured before this one's is recorded.
#[test]
fn frames_that_are_configured_ahead_show_their_own_cuts() {
    with_eyes(1, |eyes| {
        let mut renderer = Renderer::new(eyes.device, desc().frames_in_flight(2)).expect("one");
        let mut cut = Cut::new(&renderer);
        let [camera, _] = &eyes.cameras;
        let settings = raster(Raster::Tiles);
        let clips = [eyes.clip.clone(), Clip::default(), eyes.clip.clone()];
        // One more than are prepared: a frame that is dropped holds nothing up.
        let frames = [0, 1, 2, 1].map(|at| {
            let configured = cut.configure(&eyes.scene, &clips[at], &settings);
            configured.expect("a cut");
            let frame = renderer.configure(&eyes.scene, camera, &cut, &settings);
            frame.expect("configures")
        });
        let [one, two, three, four] = frames;
        drop(three);
        let pictures = [one, two, four].map(|frame| {
            let both = RefCell::new((&mut renderer, &mut cut, Some(frame), None));
            let [pixels, _] = eyes.canvas.draw(
                |cmd| {
                    let (renderer, cut, frame, prepared) = &mut *both.borrow_mut();
                    let frame = frame.take().expect("once");
                    // SAFETY: recording outside a scope, and all is waited for.
                    let made = unsafe {
                        cut.prepare(cmd).expect("records");
                        renderer.prepare(cmd, &eyes.scene, None, frame)
                    };
                    *prepared = Some(made.expect("prepares"));
                },
                |cmd| {
                    let (renderer, _, _, prepared) = &mut *both.borrow_mut();
                    eyes.canvas.viewport(cmd, 0, 0, SIZE);
                    let prepared = prepared.as_ref().expect("it was prepared");
                    // SAFETY: inside the scope of the canvas that the renderer was made for.
                    unsafe { renderer.draw(cmd, [0.0; 2], prepared) }.expect("draws");
                },
            );
            part(&pixels, 0)
        });
        let [clipped, whole, again] = &pictures;
        let worst = apart(clipped, &eyes.truth[0].pixels, 0.0);
        assert!(worst < 1.0, "{worst}/255");
        assert!(whole == again && whole != clipped);
    });
}

#[test]
fn frames_of_a_cut_that_is_not_theirs_are_refused() {
    let gaussians = generate(Kind::General, 300, 5);
    let [camera, _] = eyes(&gaussians);
    with_host(true, |_, device| {
        let scene = SceneBuffers::upload(device, &gaussians, ShFormat::Float).expect("uploads");
        let mut renderer = Renderer::new(device, desc()).expect("a renderer");
        let mut cut = Cut::new(&renderer);
        let usual = Settings::default();
        let mut said = Vec::new();
        let mut say = |refused: rara::Error| said.push(refused.to_string());
        say(renderer
            .configure(&scene, &camera, &cut, &usual)
            .expect_err("nothing is cut"));
        let recorded = device.submit_and_wait(|cmd| {
            // SAFETY: recording outside a scope, and all is waited for.
            say(unsafe { cut.prepare(cmd) }.expect_err("nothing is cut"));
            let [one, two] = [1, 2].map(|planes| common::clip(&gaussians, planes, ClipOp::And));
            cut.configure(&scene, &one, &usual)?;
            let frame = renderer.configure(&scene, &camera, &cut, &usual)?;
            // SAFETY: the same.
            say(unsafe { renderer.prepare(cmd, &scene, None, frame) }.expect_err("not recorded"));
            // SAFETY: the same.
            unsafe { cut.prepare(cmd)? };
            let frame = renderer.configure(&scene, &camera, &cut, &usual)?;
            cut.configure(&scene, &two, &usual)?;
            // SAFETY: the same.
            unsafe { cut.prepare(cmd)? };
            let moved = renderer.configure(&scene, &camera, &cut, &usual)?;
            // SAFETY: the same.
            say(unsafe { renderer.prepare(cmd, &scene, None, moved) }.expect_err("not its turn"));
            // SAFETY: the same.
            unsafe { renderer.prepare(cmd, &scene, None, frame) }?;
            let sectioned = camera.clip_near(Some(1.0));
            say(renderer
                .configure(&scene, &sectioned, &cut, &usual)
                .expect_err("another cut"));
            Ok(())
        });
        recorded.expect("submits");
        let parts = [
            "not configured",
            "configured",
            "Cut::prepare",
            "Cut::prepare",
            "near or far plane",
        ];
        assert_eq!(said.len(), parts.len());
        for (said, part) in said.iter().zip(parts) {
            assert!(said.contains(part), "{said}");
        }
    });
}
