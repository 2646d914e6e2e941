//! Temporal hosts get how far each pixel's splats have moved since the frame before, and the number of their layer.

use std::borrow::Cow;

use super::editing::{lent, plain};
use crate::canvas::{Canvas, CanvasDesc, Frame, with_host};
use crate::common;
use rara::ash::vk;
use rara::glam::{DMat3, DQuat, DVec3, Quat, Vec3};
use rara::gpu::{Bindings, Device};
use rara::scene::{Kind, generate};
use rara::{
    Bounds, Camera, Clip, ClipOp, DepthDesc, DepthMap, Gaussians, Layer, LayerEdit, LayerEditor,
    LayerState, Mode, MotionDesc, Placement, Projection, Raster, Renderer, RendererDesc, Scene,
    SceneBuffers, Settings, ShFormat, Shape,
};
use rara_reference::depth::{SplatPart, strongest};

const SIZE: (u32, u32) = (189, 131);
const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// What a host has in its target before.
const BEFORE: [f32; 4] = [7.0, 8.0, 9.0, 0.5];
const LEAST: f32 = 0.25;

/// What a frame shows: where camera, layers and clip are, and of which shape the second layer is.
#[derive(Clone, Copy)]
struct Moment {
    camera: Camera,
    placements: [Placement; 2],
    bend: f32,
    clip: DVec3,
}

/// Gaussians that have been bent, turned and stretched.
fn bent(gaussians: &Gaussians, amount: f32) -> Gaussians {
    let mut bent = gaussians.clone();
    for p in bent.positions_mut() {
        p.x += amount * p.y * p.y;
    }
    for q in bent.rotations_mut() {
        *q = (Quat::from_axis_angle(Vec3::new(0.0, 0.6, 0.8), amount) * *q).normalize();
    }
    for s in bent.scales_mut() {
        *s *= Vec3::new(1.0 + amount, 1.0 - amount, 1.0);
    }
    bent
}

/// Where a Gaussian has a place that another one has: as many deviations along each axis from the centre.
fn carried([from, to]: [&Gaussians; 2], index: usize, place: DVec3) -> DVec3 {
    let [was, is] = [from, to].map(|gaussians| {
        let turn = DMat3::from_quat(gaussians.rotations()[index].as_dquat().normalize());
        let axes = turn * DMat3::from_diagonal(gaussians.scales()[index].as_dvec3());
        (gaussians.positions()[index].as_dvec3(), axes)
    });
    is.0 + is.1 * (was.1.inverse() * (place - was.0))
}

struct World {
    halves: [Gaussians; 2],
    clip: Clip,
    settings: Settings,
}

impl World {
    fn new(mode: Mode) -> Self {
        let whole = generate(Kind::General, 3_000, 5);
        let clip = common::clip(&whole, 1, ClipOp::And);
        let half = |odd| common::picked(&whole, (0..whole.len()).filter(|i| i % 2 == odd));
        Self {
            halves: [half(0), half(1)],
            clip,
            settings: Settings::default().mode(mode),
        }
    }

    /// Two moments of a camera and layers that move.
    fn moments(&self, projection: Projection) -> [Moment; 2] {
        let seen = common::views(&self.halves[0], 3, SIZE)[1];
        let seen = match projection {
            Projection::Perspective => seen,
            Projection::Orthographic => common::flattened(&seen, &self.halves[0]),
        };
        let turned = seen.rotation * DMat3::from_axis_angle(DVec3::Y, 0.02);
        let now = seen
            .eye(seen.eye + DVec3::new(0.05, -0.02, 0.03))
            .rotation(turned)
            .cx(seen.cx + 0.25)
            .fx(seen.fx * 1.01);
        let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.03);
        let at = |turn, scale| Placement::new(DVec3::new(0.1, 0.05, 0.0), turn, scale);
        let [had, has] = [(DQuat::IDENTITY, 1.1), (turn, 1.15)]
            .map(|(turn, scale)| at(turn, scale).expect("a scale"));
        [
            Moment {
                camera: seen,
                placements: [Placement::IDENTITY, had],
                bend: 0.0,
                clip: DVec3::ZERO,
            },
            Moment {
                camera: now,
                placements: [Placement::IDENTITY, has],
                bend: 0.0,
                clip: DVec3::ZERO,
            },
        ]
    }

    /// The clip at a moment.
    fn clip(&self, moment: &Moment) -> Clip {
        let back = Placement::new(-moment.clip, DQuat::IDENTITY, 1.0);
        self.clip.in_scene(&back.expect("a scale"))
    }

    /// The Gaussians of the layers at a moment.
    fn shapes(&self, moment: &Moment) -> [Cow<'_, Gaussians>; 2] {
        let [first, second] = self.halves.each_ref();
        let second = match moment.bend {
            0.0 => Cow::Borrowed(second),
            amount => Cow::Owned(bent(second, amount)),
        };
        [Cow::Borrowed(first), second]
    }

    fn scene(&self, moment: &Moment) -> Scene<'_> {
        let shapes = self.shapes(moment).into_iter();
        let layers = shapes.zip(moment.placements).enumerate();
        let layers = layers.map(|(number, (half, placement))| {
            let layer = match half {
                Cow::Borrowed(half) => Layer::new(number.to_string(), half),
                Cow::Owned(half) => Layer::owned(number.to_string(), half),
            };
            layer.with(LayerState::default().placement(placement))
        });
        layers.collect()
    }

    /// What is to be found: where it was before, less where it is, for each pixel, and whether it was kept.
    fn truth(&self, [before, now]: &[Moment; 2]) -> Vec<([f64; 2], bool, SplatPart)> {
        let (camera, scene) = (&now.camera, self.scene(now));
        let seen = strongest::<f64>(scene, camera, &self.clip(now), &self.settings);
        let [had, have] = [before, now].map(|moment| self.shapes(moment));
        let ways = seen.into_iter().enumerate().map(|(at, seen)| {
            let at = at as u32;
            let pixel = [at % SIZE.0, at / SIZE.0].map(|side| f64::from(side) + 0.5);
            let world = point(camera, pixel, seen.depth);
            let own = now.placements[seen.layer].to_scene(world);
            let shapes = [&*have[seen.layer], &*had[seen.layer]];
            let own = carried(shapes, seen.gaussian, own);
            let was = before.placements[seen.layer].to_world(own);
            let [x, y] = seen_at(&before.camera, was);
            let [kept, keeps] = match self.settings.mode {
                // By its centre.
                Mode::Hard => [(before, &had), (now, &have)].map(|(moment, shapes)| {
                    let centre = shapes[seen.layer].positions()[seen.gaussian].as_dvec3();
                    let placed = moment.placements[seen.layer].to_world(centre);
                    self.clip(moment).keeps(placed)
                }),
                Mode::None => [true; 2],
                _ => [(before, was), (now, world)].map(|(at, place)| self.clip(at).keeps(place)),
            };
            ([x - pixel[0], y - pixel[1]], kept || !keeps, seen)
        });
        ways.collect()
    }
}

/// True where no pixel has moved.
fn is_at_rest(pixels: &[[f32; 4]]) -> bool {
    let mut of_splats = pixels.iter().filter(|p| **p != BEFORE);
    of_splats.all(|p| p[..2] == [0.0; 2])
}

/// The point that a camera sees in a pixel at a depth.
fn point(camera: &Camera, [x, y]: [f64; 2], depth: f64) -> DVec3 {
    let away = match camera.projection {
        Projection::Perspective => depth,
        Projection::Orthographic => 1.0,
    };
    let [x, y] = [(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy];
    camera.eye + camera.rotation.transpose() * DVec3::new(x * away, y * away, depth)
}

/// The pixel in which a camera sees a point.
fn seen_at(camera: &Camera, point: DVec3) -> [f64; 2] {
    let own = camera.rotation * (point - camera.eye);
    let away = match camera.projection {
        Projection::Perspective => own.z,
        Projection::Orthographic => 1.0,
    };
    [
        camera.fx * own.x / away + camera.cx,
        camera.fy * own.y / away + camera.cy,
    ]
}

fn desc(bindings: Bindings) -> RendererDesc {
    let motion = MotionDesc::new(FORMAT).least_alpha(LEAST);
    RendererDesc::new(FORMAT)
        .bindings(bindings)
        .motion(Some(motion))
}

/// Draws the motion of moments that follow each other; returns that of each.
fn draw(
    device: &Device,
    canvas: &Canvas,
    world: &World,
    renderer: &mut Renderer,
    moments: &[Moment],
) -> Vec<Vec<[f32; 4]>> {
    let scene = SceneBuffers::upload(device, world.scene(&moments[0]), ShFormat::Float);
    let mut scene = scene.expect("uploads");
    let frame = Frame {
        call: Renderer::draw_motion,
        ..Frame::new(SIZE)
    };
    let mut bend = moments[0].bend;
    let drawn = moments.iter().map(|moment| {
        if moment.bend != bend {
            let [_, shape] = world.shapes(moment);
            edit(device, renderer, &mut scene, (1, &shape), true);
            bend = moment.bend;
        }
        for (number, placement) in moment.placements.into_iter().enumerate() {
            let state = LayerState::default().placement(placement);
            scene.set_layer_state(number, state).expect("a layer");
        }
        let configured =
            renderer.configure(&scene, &moment.camera, &world.clip(moment), &world.settings);
        canvas.draw_frame(renderer, &scene, configured, &frame)
    });
    drawn.collect()
}

/// Edits the Gaussians of a layer of a scene, which move there or not.
fn edit(
    device: &Device,
    renderer: &Renderer,
    scene: &mut SceneBuffers,
    (layer, shape): (usize, &Gaussians),
    moves: bool,
) {
    let count = shape.len() as u32;
    let mut editor = LayerEditor::new(renderer, scene, count).expect("an editor");
    let source = lent(device, &plain(shape));
    let edit = LayerEdit::of(0..count).positions(true).rotations(true);
    let edit = edit.scales(true).bounds(Some(Bounds::of(shape)));
    let edited = device.submit_and_wait(|cmd| {
        let all = [vk::BufferCopy::default().size(source.size())];
        // SAFETY: `cmd` is recording outside a scope, and all lives until it has executed.
        unsafe {
            let raw = device.raw();
            raw.cmd_copy_buffer(cmd, source.handle(), editor.buffer(), &all);
            editor.record(cmd, scene, layer, &edit.moves(moves))
        }
    });
    edited.expect("edits");
}

#[test]
fn cameras_layers_and_edits_move_pixels_as_the_reference_says() {
    with_host(true, |host, device| {
        let mut clear = CanvasDesc::new(SIZE, FORMAT);
        clear.clear = BEFORE;
        let canvas = Canvas::new(&host.lend(), device, clear);
        let first = Renderer::new(device, desc(Bindings::Mixed)).expect("a renderer");
        let ball = Shape::sphere(DVec3::new(0.2, 0.1, 0.0), 0.7).expect("a radius");
        let block = Shape::cuboid(DVec3::ZERO, DVec3::splat(1.1), DQuat::IDENTITY);
        let halved = [block.expect("sides"), ball.complement()];
        let shapes = Clip::of_shapes(&halved, ClipOp::And);
        for (mode, projection, bindings, bend, shift, clip) in [
            (
                Mode::Exact,
                Projection::Perspective,
                Bindings::Mixed,
                0.1,
                0.2,
                None,
            ),
            (
                Mode::None,
                Projection::Orthographic,
                Bindings::Address,
                0.1,
                0.2,
                None,
            ),
            (
                Mode::Rara,
                Projection::Perspective,
                Bindings::Bound,
                0.0,
                0.0,
                None,
            ),
            (
                Mode::Hard,
                Projection::Perspective,
                Bindings::Mixed,
                0.1,
                0.2,
                None,
            ),
            (
                Mode::Exact,
                Projection::Orthographic,
                Bindings::Mixed,
                0.1,
                0.2,
                Some(shapes),
            ),
        ] {
            let mut world = World::new(mode);
            let mut moments = world.moments(projection);
            moments[1].bend = bend;
            moments[1].clip = shift * DVec3::new(-0.9, 0.3, 0.2);
            if let Some(clip) = clip {
                world.clip = clip;
            }
            let mut renderer = first.sharing(desc(bindings)).expect("a renderer");
            let [before, now] = moments;
            let drawn = draw(device, &canvas, &world, &mut renderer, &[before, now, now]);
            let at_rest = [0, 2].map(|at| is_at_rest(&drawn[at]));
            assert_eq!(at_rest, [true; 2], "{mode:?}, {projection:?}");
            let (mut errors, mut ways, mut layers) = (Vec::new(), 0.0_f64, [0; 2]);
            let mut uncovered = [0; 2];
            for (ours, (way, kept, seen)) in drawn[1].iter().zip(world.truth(&moments)) {
                let is_near = (seen.coverage - f64::from(LEAST)).abs() < 1e-4;
                if is_near {
                    continue;
                }
                if seen.coverage < f64::from(LEAST) {
                    assert_eq!(*ours, BEFORE, "what is thin keeps what the host has drawn");
                    continue;
                }
                let [x, y, layer, alpha] = ours.map(f64::from);
                uncovered[0] += usize::from(alpha == 0.0);
                uncovered[1] += usize::from((alpha == 1.0) != kept);
                let is_other = layer != seen.layer as f64;
                let error = (x - way[0]).hypot(y - way[1]);
                errors.push(if is_other { f64::INFINITY } else { error });
                ways = ways.max(way[0].hypot(way[1]));
                layers[seen.layer] += 1;
            }
            errors.sort_by(f64::total_cmp);
            let most = errors[errors.len() * 99 / 100];
            let what = format!(
                "{mode:?}, {projection:?}: {most:.1e} px for 99 % of {} pixels, which move up to {ways:.1} px; layers {layers:?}, uncovered and wrongly so {uncovered:?}",
                errors.len()
            );
            eprintln!("{what}");
            let [own, wrong] = uncovered;
            let expected = match (mode, shift) {
                (Mode::None, _) => 0..=0,
                (_, 0.0) => 0..=100, // what the layer carries through the plane
                _ => 300..=errors.len() - 300,
            };
            assert!(expected.contains(&own), "{what}");
            assert!(wrong * 1000 < errors.len(), "{what}");
            assert!(most < 1e-4 && errors.len() > 2_000, "{what}");
            assert!(
                ways > 2.0 && layers.iter().all(|&count| count > 500),
                "{what}"
            );
        }
    });
}

/// What an edit moves is seen by all frames until the next one: its way begins where the frame before has shown it.
#[test]
fn edits_between_two_frames_are_one_way() {
    with_host(true, |host, device| {
        let canvas = Canvas::new(&host.lend(), device, CanvasDesc::new(SIZE, FORMAT));
        let first = Renderer::new(device, desc(Bindings::Mixed)).expect("a renderer");
        let world = World::new(Mode::Exact);
        let [moment, _] = world.moments(Projection::Perspective);
        let frame = Frame {
            call: Renderer::draw_motion,
            ..Frame::new(SIZE)
        };
        let shape = |amount| bent(&world.halves[1], amount);
        // Draws a frame, edits and replaces, and draws one by each of so many renderers.
        let moved = |eyes: usize, change: &dyn Fn(&Renderer, &mut SceneBuffers)| {
            let scene = SceneBuffers::upload(device, world.scene(&moment), ShFormat::Float);
            let mut scene = scene.expect("uploads");
            let sharing = || first.sharing(desc(Bindings::Mixed)).expect("a renderer");
            let mut renderers: Vec<_> = (0..eyes).map(|_| sharing()).collect();
            let draw = |renderer: &mut Renderer, scene: &SceneBuffers| {
                let configured =
                    renderer.configure(scene, &moment.camera, &world.clip, &world.settings);
                canvas.draw_frame(renderer, scene, configured, &frame)
            };
            for renderer in &mut renderers {
                draw(renderer, &scene);
            }
            change(&renderers[0], &mut scene);
            let mut each =
                |scene: &_| -> Vec<_> { renderers.iter_mut().map(|r| draw(r, scene)).collect() };
            let [now, later] = [each(&scene), each(&scene)];
            assert!(is_at_rest(&later[0]), "nothing has moved since");
            assert!(now.iter().all(|seen| *seen == now[0]), "eyes see the same");
            now[0].clone()
        };
        let is_of = |layer: f32, pixels: &[[f32; 4]]| {
            let moved = pixels
                .iter()
                .filter(|p| p[2] == layer && p[..2] != [0.0; 2]);
            moved.count()
        };
        let once = moved(1, &|renderer, scene| {
            edit(device, renderer, scene, (1, &shape(0.1)), true);
        });
        assert!(is_of(1.0, &once) > 500 && is_of(0.0, &once) == 0);
        let twice = moved(2, &|renderer, scene| {
            edit(device, renderer, scene, (1, &shape(-0.2)), true);
            edit(device, renderer, scene, (1, &shape(0.1)), true);
        });
        assert!(once == twice, "two edits are one way");
        let others = moved(1, &|renderer, scene| {
            edit(device, renderer, scene, (1, &shape(0.1)), false);
        });
        assert!(is_at_rest(&others), "others took their place");
        let replaced = moved(1, &|renderer, scene| {
            edit(device, renderer, scene, (1, &shape(-0.2)), true);
            edit(
                device,
                renderer,
                scene,
                (0, &bent(&world.halves[0], 0.1)),
                true,
            );
            let replaced = scene.replace_layer(1, &shape(0.1));
            replaced.expect("replaces");
        });
        assert!(is_of(0.0, &replaced) > 500 && is_of(1.0, &replaced) == 0);
    });
}

/// A frame that takes over what the one before has computed, all of it or the view, has the same motion as one that does not.
#[test]
fn reused_frames_have_the_same_motion_and_colours_are_as_without() {
    with_host(true, |host, device| {
        let canvas = Canvas::new(&host.lend(), device, CanvasDesc::new(SIZE, FORMAT));
        let first = Renderer::new(device, desc(Bindings::Mixed)).expect("a renderer");
        let mut world = World::new(Mode::Exact);
        let [before, now] = world.moments(Projection::Perspective);
        let moments = [before, now, now];
        let scene = SceneBuffers::upload(device, world.scene(&now), ShFormat::Float);
        let scene = scene.expect("uploads");
        let [fresh, reused] = [false, true].map(|reuse| {
            let desc = desc(Bindings::Mixed).reuse(reuse);
            let mut renderer = first.sharing(desc).expect("a renderer");
            let drawn = draw(device, &canvas, &world, &mut renderer, &moments);
            let (camera, clip) = (&now.camera, common::moved(world.clip.clone(), 0.02));
            let frame = Frame {
                call: Renderer::draw_motion,
                ..Frame::new(SIZE)
            };
            let mut of = |clip: &Clip| {
                let configured = renderer.configure(&scene, camera, clip, &world.settings);
                canvas.draw_frame(&mut renderer, &scene, configured, &frame)
            };
            (drawn, [of(&world.clip), of(&clip), of(&clip)])
        });
        assert!(fresh == reused);
        assert!(fresh.1[0] != fresh.1[1], "the clip has moved");
        let [with, without] = [true, false].map(|draws| {
            let own = desc(Bindings::Mixed);
            let desc = own.motion(own.motion.filter(|_| draws));
            let mut renderer = first.sharing(desc).expect("a renderer");
            let configured = renderer.configure(&scene, &now.camera, &world.clip, &world.settings);
            canvas.draw_frame(&mut renderer, &scene, configured, &Frame::new(SIZE))
        });
        assert!(with == without);
        world.settings = world.settings.raster(Raster::Quad);
        let mut renderer = first.sharing(desc(Bindings::Mixed)).expect("a renderer");
        let refused = renderer.configure(&scene, &now.camera, &world.clip, &world.settings);
        let refused = refused.expect_err("quads find no motion").to_string();
        assert!(refused.contains("RendererDesc::motion"), "{refused}");
        let map = DepthMap::reversed(0.5, 50.0).expect("0 < near < far");
        let unread = DepthDesc::new(vk::Format::D32_SFLOAT, map);
        let own = MotionDesc::new(FORMAT);
        for (desc, says) in [
            (desc(Bindings::Mixed).depth(Some(unread)), "readable"),
            (
                RendererDesc::new(FORMAT).motion(Some(own.least_alpha(1.5))),
                "from 0 to 1",
            ),
            (
                RendererDesc::new(FORMAT).motion(Some(MotionDesc::new(vk::Format::R32_SFLOAT))),
                "two floats",
            ),
        ] {
            let refused = Renderer::new(device, desc).expect_err(says).to_string();
            assert!(refused.contains(says), "{refused}");
        }
    });
}
