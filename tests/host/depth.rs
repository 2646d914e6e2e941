//! Splats against a host's depth buffer: what lies behind an opaque mesh is hidden, on ordinary and reversed depth, in
//! every way of drawing, dynamic rendering and classic render passes, with one sample and several.

use crate::canvas::{Canvas, CanvasDesc, with_host};
use crate::common;
use rara::ash::vk;
use rara::gpu::{Bindings, Device, Target};
use rara::scene::{Kind, generate};
use rara::{
    Camera, Clip, ClipOp, DepthDesc, DepthMap, ExpectedDepthDesc, Gaussians, Mode, Picture, Raster,
    Renderer, RendererDesc, SceneBuffers, Settings, reference,
};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// The size of the camera's picture, and where it begins in the target: over its left and lower edges, at an odd column.
const VIEW: (u32, u32) = (189, 131);
const ORIGIN: (i32, i32) = (-7, 40);
const TARGET: (u32, u32) = (211, 160);

/// A scene with a clip through it, and amid it two meshes that face the camera.
struct World {
    scene: Gaussians,
    camera: Camera,
    clip: Clip,
    /// Their places in pixels of the picture, and their depths.
    meshes: [(vk::Rect2D, f64); 2],
}

impl World {
    fn new() -> Self {
        let scene = generate(Kind::General, 3_000, 5);
        let camera = common::views(&scene, 3, VIEW)[1];
        let clip = common::clip(&scene, 1, ClipOp::And);
        let mut depths: Vec<_> = (0..scene.len())
            .map(|i| depth(&scene, &camera, i))
            .collect();
        depths.sort_by(f64::total_cmp);
        let at = |share: f64| depths[(share * depths.len() as f64) as usize];
        let rect = |x, y, width, height| vk::Rect2D {
            offset: vk::Offset2D { x, y },
            extent: vk::Extent2D { width, height },
        };
        let meshes = [
            (rect(20, 11, 71, 67), at(0.4) + 1e-4),
            (rect(60, 50, 90, 41), at(0.6) + 1e-4),
        ];
        Self {
            scene,
            camera,
            clip,
            meshes,
        }
    }

    /// The picture as a headless renderer draws it: where there is a mesh, of the Gaussians before it alone.
    fn truth(&self) -> Picture {
        let mut headless = common::headless();
        let mut draw = |scene: &Gaussians| {
            headless.load(scene).expect("uploads");
            let settings = Settings::default();
            headless
                .render(&self.camera, &self.clip, &settings)
                .expect("renders");
            headless.picture().expect("reads back")
        };
        let mut picture = draw(&self.scene);
        for (rect, depth) in &self.meshes {
            let part = draw(&self.before(*depth));
            for y in 0..rect.extent.height {
                for x in 0..rect.extent.width {
                    let row = rect.offset.y as u32 + y;
                    let at = (row * VIEW.0 + rect.offset.x as u32 + x) as usize;
                    picture.pixels[at] = part.pixels[at];
                }
            }
        }
        let whole = draw(&self.scene);
        let hidden = whole.pixels.iter().zip(&picture.pixels);
        let changed = hidden.filter(|(a, b)| (a[0] - b[0]).abs() > 0.05).count();
        assert!(
            changed > 1_000,
            "the meshes hide something: {changed} pixels"
        );
        picture
    }

    /// The Gaussians that are nearer than a depth.
    fn before(&self, limit: f64) -> Gaussians {
        let s = &self.scene;
        let mut kept = Gaussians::default();
        kept.set_sh_degree(s.sh_degree());
        for i in (0..s.len()).filter(|&i| depth(s, &self.camera, i) < limit) {
            let (position, scale, rotation) = (s.positions()[i], s.scales()[i], s.rotations()[i]);
            kept.push(position, scale, rotation, s.opacities()[i], s.sh_of(i));
        }
        kept
    }
}

fn depth(scene: &Gaussians, camera: &Camera, index: usize) -> f64 {
    let relative = scene.positions()[index].as_dvec3() - camera.eye;
    (camera.rotation * relative).z
}

/// A canvas with the world's meshes in its depth buffer.
fn canvas(world: &World, map: DepthMap, depth: vk::Format) -> CanvasDesc {
    let mut desc = CanvasDesc::new(TARGET, FLOATS);
    desc.depth = depth;
    desc.far = if map.is_reversed() { 0.0 } else { 1.0 };
    let in_target = |(rect, depth): (vk::Rect2D, f64)| {
        let mut rect = rect;
        rect.offset.x += ORIGIN.0;
        rect.offset.y += ORIGIN.1;
        (rect, map.at(depth) as f32)
    };
    desc.meshes = world.meshes.map(in_target).to_vec();
    desc
}

fn depth_desc(canvas: &CanvasDesc, map: DepthMap, readable: bool) -> DepthDesc {
    DepthDesc::new(canvas.depth, map).readable(readable)
}

/// Draws one frame of the world on a canvas; returns the part under the camera's picture, and how it was drawn.
fn draw(
    device: &Device,
    canvas: &Canvas,
    world: &World,
    desc: RendererDesc,
    raster: Raster,
) -> (Picture, &'static str) {
    let format = rara::ShFormat::Float;
    let scene = SceneBuffers::upload(device, &world.scene, format).expect("uploads");
    let mut renderer = Renderer::new(device, desc).expect("a renderer");
    let settings = Settings::default().raster(raster);
    let configured = renderer.configure(&scene, &world.camera, &world.clip, &settings);
    configured.expect("configures");
    let path = renderer.raster().path;
    let renderer = std::cell::RefCell::new(renderer);
    let before = |cmd| {
        let mut renderer = renderer.borrow_mut();
        // SAFETY: `cmd` is recording outside a scope, the canvas's depth is ready to be copied, and all is waited for.
        unsafe {
            if desc.depth.is_some_and(|depth| depth.readable) {
                renderer
                    .prepare_behind(cmd, &scene, &canvas.depth_image(ORIGIN.0, ORIGIN.1))
                    .expect("prepares");
            } else {
                renderer.prepare(cmd, &scene).expect("prepares");
            }
        }
    };
    let inside = |cmd| {
        canvas.viewport(cmd, ORIGIN.0, ORIGIN.1, VIEW);
        let origin = [ORIGIN.0 as f32, ORIGIN.1 as f32];
        // SAFETY: `cmd` is inside the canvas's scope, which the renderer was made for.
        unsafe { renderer.borrow_mut().draw(cmd, origin).expect("draws") };
    };
    let [pixels, _] = canvas.draw(before, inside);
    (part(&pixels), path)
}

/// The part of a target that lies under the camera's picture; transparent where the picture is beside the target.
fn part(pixels: &[[f32; 4]]) -> Picture {
    let mut picture = Picture::filled(VIEW.0, VIEW.1, [0.0; 4]);
    for (i, pixel) in picture.pixels.iter_mut().enumerate() {
        let (x, y) = (
            i as i32 % VIEW.0 as i32 + ORIGIN.0,
            i as i32 / VIEW.0 as i32 + ORIGIN.1,
        );
        if x >= 0 && y >= 0 && x < TARGET.0 as i32 && y < TARGET.1 as i32 {
            *pixel = pixels[(y * TARGET.0 as i32 + x) as usize];
        }
    }
    picture
}

/// Largest difference, of 255, inside the target, leaving out a share of the pixels.
fn apart(a: &Picture, b: &Picture, share: f64) -> f32 {
    let mut differences = Vec::new();
    for (i, (a, b)) in a.pixels.iter().zip(&b.pixels).enumerate() {
        let (x, y) = (
            i as i32 % VIEW.0 as i32 + ORIGIN.0,
            i as i32 / VIEW.0 as i32 + ORIGIN.1,
        );
        if x >= 0 && y < TARGET.1 as i32 {
            let pairs = a.iter().zip(b);
            let worst = pairs.map(|(a, b)| 255.0 * (a.min(1.0) - b.min(1.0)).abs());
            differences.push(worst.fold(0.0, f32::max));
        }
    }
    differences.sort_by(f32::total_cmp);
    differences[((1.0 - share) * (differences.len() - 1) as f64) as usize]
}

fn rasters(device: &Device) -> Vec<Raster> {
    let mut rasters = vec![Raster::Quad, Raster::Tiles];
    if device.support().mesh_shader {
        rasters.push(Raster::Mesh);
    }
    rasters
}

fn maps() -> [DepthMap; 3] {
    [
        DepthMap::ordinary(0.5, 50.0),
        DepthMap::reversed(0.5, 50.0),
        DepthMap::reversed(0.1, f64::INFINITY),
    ]
    .map(|map| map.expect("0 < near < far"))
}

#[test]
fn meshes_hide_the_splats_behind_them_on_ordinary_and_reversed_depth() {
    let world = World::new();
    let truth = world.truth();
    with_host(true, |host, device| {
        for map in maps() {
            let desc = canvas(&world, map, vk::Format::D32_SFLOAT);
            let depth = depth_desc(&desc, map, true);
            let canvas = Canvas::new(&host.lend(), device, desc);
            for (raster, bindings) in rasters(device)
                .into_iter()
                .flat_map(|raster| [(raster, Bindings::Bound), (raster, Bindings::Address)])
            {
                let desc = RendererDesc::new(FLOATS)
                    .depth(Some(depth))
                    .bindings(bindings);
                let (picture, path) = draw(device, &canvas, &world, desc, raster);
                let asked = match raster {
                    Raster::Tiles => "tiles",
                    Raster::Mesh => "mesh",
                    _ => "quad",
                };
                assert_eq!(path, asked);
                let worst = apart(&picture, &truth, 0.0);
                assert!(
                    worst < 1.0,
                    "{map:?}, {raster:?}, {bindings:?}: {worst}/255"
                );
            }
        }
    });
}

/// Depths that a buffer rounds: a splat may lie on a mesh's own step, and then counts as before it in every way of
/// drawing.
#[test]
fn depths_in_few_bits_hide_the_same_splats_in_every_way_of_drawing() {
    let world = World::new();
    with_host(true, |host, device| {
        for format in [
            vk::Format::D16_UNORM,
            vk::Format::X8_D24_UNORM_PACK32,
            vk::Format::D24_UNORM_S8_UINT,
            vk::Format::D32_SFLOAT_S8_UINT,
        ] {
            let needed = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT
                | vk::FormatFeatureFlags::TRANSFER_SRC;
            if !device.format_features(format).contains(needed) {
                continue;
            }
            for map in [maps()[0], maps()[2]] {
                let desc = canvas(&world, map, format);
                let depth = depth_desc(&desc, map, true);
                let canvas = Canvas::new(&host.lend(), device, desc);
                let desc = RendererDesc::new(FLOATS)
                    .depth(Some(depth))
                    .bindings(Bindings::Bound);
                let (quads, _) = draw(device, &canvas, &world, desc, Raster::Quad);
                let (tiles, path) = draw(device, &canvas, &world, desc, Raster::Tiles);
                assert_eq!(path, "tiles");
                let worst = apart(&quads, &tiles, 0.0);
                eprintln!("{format:?}, {map:?}: {worst}/255");
                assert!(worst < 1.0, "{format:?}, {map:?}: {worst}/255");
            }
        }
    });
}

/// A depth image that is not under the picture hides nothing, and nothing beside its copy is read.
#[test]
fn a_depth_image_beside_the_picture_hides_nothing() {
    let world = World::new();
    let mut headless = common::headless();
    headless.load(&world.scene).expect("uploads");
    let settings = Settings::default().raster(Raster::Tiles);
    let drawn = headless.render(&world.camera, &world.clip, &settings);
    drawn.expect("renders");
    let truth = headless.picture().expect("reads back");
    with_host(true, |host, device| {
        for map in maps() {
            let desc = canvas(&world, map, vk::Format::D32_SFLOAT);
            let depth = depth_desc(&desc, map, true);
            let canvas = Canvas::new(&host.lend(), device, desc);
            let format = rara::ShFormat::Float;
            let scene = SceneBuffers::upload(device, &world.scene, format).expect("uploads");
            let desc = RendererDesc::new(FLOATS)
                .depth(Some(depth))
                .bindings(Bindings::Bound);
            let mut renderer = Renderer::new(device, desc).expect("a renderer");
            let configured = renderer.configure(&scene, &world.camera, &world.clip, &settings);
            configured.expect("configures");
            let renderer = std::cell::RefCell::new(renderer);
            let mut beside = canvas.depth_image(ORIGIN.0, ORIGIN.1);
            beside.origin.x += 5_000;
            let before = |cmd| {
                let mut renderer = renderer.borrow_mut();
                // SAFETY: `cmd` is recording outside a scope, the canvas's depth is ready to be copied, and all is
                // waited for.
                unsafe { renderer.prepare_behind(cmd, &scene, &beside) }.expect("prepares");
            };
            let inside = |cmd| {
                canvas.viewport(cmd, ORIGIN.0, ORIGIN.1, VIEW);
                let origin = [ORIGIN.0 as f32, ORIGIN.1 as f32];
                // SAFETY: `cmd` is inside the canvas's scope, which the renderer was made for.
                unsafe { renderer.borrow_mut().draw(cmd, origin).expect("draws") };
            };
            let [pixels, _] = canvas.draw(before, inside);
            let worst = apart(&part(&pixels), &truth, 0.0);
            assert!(worst < 1.0, "{map:?}: {worst}/255");
        }
    });
}

#[test]
fn tiles_that_cannot_see_the_hosts_depth_are_quads() {
    let world = World::new();
    let truth = world.truth();
    let map = maps()[1];
    with_host(false, |host, device| {
        let desc = canvas(&world, map, vk::Format::D32_SFLOAT);
        let depth = depth_desc(&desc, map, false);
        let canvas = Canvas::new(&host.lend(), device, desc);
        let desc = RendererDesc::new(FLOATS).depth(Some(depth));
        for raster in [Raster::Tiles, Raster::Auto] {
            let (picture, path) = draw(device, &canvas, &world, desc, raster);
            assert_eq!(path, "quad", "{raster:?}");
            let worst = apart(&picture, &truth, 0.0);
            assert!(worst < 1.0, "{raster:?}: {worst}/255");
        }
    });
}

#[test]
fn a_classic_render_pass_shows_the_same_picture() {
    let world = World::new();
    let map = maps()[1];
    with_host(true, |host, device| {
        let with_depth = [vk::Format::D32_SFLOAT, vk::Format::UNDEFINED];
        for (format, raster) in with_depth.into_iter().flat_map(|format| {
            rasters(device)
                .into_iter()
                .map(move |raster| (format, raster))
        }) {
            let [dynamic, classic] = [false, true].map(|render_pass| {
                let mut desc = canvas(&world, map, format);
                desc.render_pass = render_pass;
                let tested = format != vk::Format::UNDEFINED;
                let depth = tested.then(|| depth_desc(&desc, map, true));
                let canvas = Canvas::new(&host.lend(), device, desc);
                let target = if render_pass {
                    // SAFETY: the canvas has the pass until its end.
                    unsafe { Target::render_pass(canvas.render_pass(), 0) }
                } else {
                    Target::DYNAMIC
                };
                let desc = RendererDesc::new(FLOATS)
                    .depth(depth)
                    .target(target)
                    .bindings(Bindings::Bound);
                draw(device, &canvas, &world, desc, raster).0
            });
            assert!(dynamic.pixels.iter().any(|pixel| pixel[3] > 0.5));
            assert!(dynamic == classic, "{format:?}, {raster:?}: the same bytes");
        }
    });
}

/// With several samples only a splat's outline, where its alpha is 1/255, differs.
#[test]
fn targets_of_several_samples_resolve_to_the_same_picture() {
    let world = World::new();
    let truth = world.truth();
    let map = maps()[1];
    let samples = vk::SampleCountFlags::TYPE_4;
    with_host(true, |host, device| {
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT;
        if !device.sample_counts(FLOATS, usage).contains(samples) {
            eprintln!("SKIPPED: no {FLOATS:?} of four samples on this device");
            return;
        }
        let mut desc = canvas(&world, map, vk::Format::D32_SFLOAT);
        desc.samples = samples;
        let depth = depth_desc(&desc, map, false);
        let canvas = Canvas::new(&host.lend(), device, desc);
        let desc = RendererDesc::new(FLOATS)
            .depth(Some(depth))
            .samples(samples)
            .bindings(Bindings::Bound);
        for raster in rasters(device) {
            let (picture, _) = draw(device, &canvas, &world, desc, raster);
            let (worst, most) = (apart(&picture, &truth, 0.0), apart(&picture, &truth, 0.01));
            eprintln!("{raster:?}: {worst}/255, {most}/255 for 99 %");
            assert!(
                worst < 8.0 && most < 1.0,
                "{raster:?}: {worst}/255, {most}/255 for 99 %"
            );
        }
    });
}

#[test]
fn what_a_device_cannot_draw_into_is_refused_with_a_reason() {
    with_host(true, |_, device| {
        let refused = |desc: RendererDesc| {
            let error = Renderer::new(device, desc).expect_err("refused");
            error.to_string()
        };
        let samples = vk::SampleCountFlags::TYPE_64;
        let usual = RendererDesc::new(vk::Format::R8G8B8A8_UNORM);
        let text = refused(usual.samples(samples));
        assert!(
            text.contains("TYPE_64") && text.contains("one sample"),
            "{text}"
        );
        let samples = vk::SampleCountFlags::TYPE_1 | vk::SampleCountFlags::TYPE_4;
        let text = refused(usual.samples(samples));
        assert!(text.contains("samples"), "{text}");
        let depth = DepthDesc::new(vk::Format::R8G8B8A8_UNORM, maps()[0]);
        let text = refused(usual.depth(Some(depth)));
        assert!(text.contains("no depth"), "{text}");
    });
}

#[test]
fn a_promised_depth_that_is_not_given_is_refused() {
    let headless = common::headless();
    let device = headless.device();
    let depth = DepthDesc::new(vk::Format::D32_SFLOAT, maps()[0]).readable(true);
    let desc = RendererDesc::new(FLOATS).depth(Some(depth));
    let world = World::new();
    let format = rara::ShFormat::Float;
    let scene = SceneBuffers::upload(device, &world.scene, format).expect("uploads");
    let mut renderer = Renderer::new(device, desc).expect("a renderer");
    // SAFETY: refused before anything is recorded.
    let refused = unsafe { renderer.prepare(vk::CommandBuffer::null(), &scene) };
    let text = refused.unwrap_err().to_string();
    assert!(text.contains("prepare_behind takes it"), "{text}");
}

/// A frame of expected depths on a canvas of two channels is the reference's, in every way of drawing the colours.
#[test]
fn expected_depths_are_the_references() {
    let world = World::new();
    let format = vk::Format::R32G32_SFLOAT;
    for (mode, planes, op) in [
        (Mode::None, 0, ClipOp::And),
        (Mode::Exact, 1, ClipOp::And),
        (Mode::Exact, 2, ClipOp::Or),
        (Mode::Rara, 1, ClipOp::And),
        (Mode::Hard, 1, ClipOp::And),
    ] {
        let clip = common::clip(&world.scene, planes, op);
        let settings = Settings::default().mode(mode);
        let truth =
            reference::depth::expected::<f64>(&world.scene, &world.camera, &clip, &settings);
        with_host(true, |host, device| {
            let canvas = Canvas::new(&host.lend(), device, CanvasDesc::new(VIEW, format));
            let scene = SceneBuffers::upload(device, &world.scene, rara::ShFormat::Float);
            let scene = scene.expect("uploads");
            for (raster, bindings) in [
                (Raster::Tiles, Bindings::Bound),
                (Raster::Quad, Bindings::Address),
            ] {
                let desc = RendererDesc::new(FLOATS)
                    .expected_depth(Some(ExpectedDepthDesc::new(format)))
                    .bindings(bindings);
                let mut renderer = Renderer::new(device, desc).expect("a renderer");
                let settings = settings.raster(raster);
                let configured = renderer.configure(&scene, &world.camera, &clip, &settings);
                configured.expect("configures");
                let renderer = std::cell::RefCell::new(renderer);
                // SAFETY: recording outside a scope, and all is waited for.
                let before = |cmd| unsafe {
                    renderer
                        .borrow_mut()
                        .prepare(cmd, &scene)
                        .expect("prepares")
                };
                let inside = |cmd| {
                    canvas.viewport(cmd, 0, 0, VIEW);
                    // SAFETY: inside the canvas's scope, of the format given.
                    unsafe {
                        renderer
                            .borrow_mut()
                            .draw_depth(cmd, [0.0; 2])
                            .expect("draws")
                    };
                };
                let [pixels, _] = canvas.draw(before, inside);
                let mut errors: Vec<_> = pixels
                    .iter()
                    .zip(&truth)
                    .filter(|(_, truth)| truth[1] > 0.02)
                    .map(|(ours, truth)| {
                        let depth = f64::from(ours[0]) / f64::from(ours[1]);
                        ((depth - truth[0] / truth[1]) / depth).abs()
                    })
                    .collect();
                errors.sort_by(f64::total_cmp);
                assert!(errors.len() > 2_000, "{} pixels", errors.len());
                let most = errors[errors.len() * 998 / 1000];
                let worst = errors[errors.len() - 1];
                let what = format!(
                    "{mode:?}, {planes} planes {op:?}, {raster:?}: {worst:.1e}, {most:.1e} for 99.8 %"
                );
                eprintln!("{what}");
                assert!(most < 2e-4 && worst < 0.02, "{what}");
            }
        });
    }
}

/// What is left of a big cut splat lies farther away than its centre, and a host's mesh hides depths like colours.
#[test]
fn expected_depths_are_behind_the_cut_and_before_the_mesh() {
    let world = World::new();
    let map = maps()[2];
    let format = vk::Format::R32G32_SFLOAT;
    with_host(true, |host, device| {
        let mut desc = canvas(&world, map, vk::Format::D32_SFLOAT);
        desc.color = format;
        let depth = depth_desc(&desc, map, false);
        let canvas = Canvas::new(&host.lend(), device, desc);
        let scene = SceneBuffers::upload(device, &world.scene, rara::ShFormat::Float);
        let scene = scene.expect("uploads");
        let desc = RendererDesc::new(FLOATS)
            .depth(Some(depth))
            .expected_depth(Some(ExpectedDepthDesc::new(format)))
            .bindings(Bindings::Bound);
        let mut renderer = Renderer::new(device, desc).expect("a renderer");
        let clip = Clip::default();
        let configured = renderer.configure(&scene, &world.camera, &clip, &Settings::default());
        configured.expect("configures");
        let renderer = std::cell::RefCell::new(renderer);
        // SAFETY: recording outside a scope, and all is waited for.
        let before = |cmd| unsafe {
            renderer
                .borrow_mut()
                .prepare(cmd, &scene)
                .expect("prepares")
        };
        let inside = |cmd| {
            canvas.viewport(cmd, ORIGIN.0, ORIGIN.1, VIEW);
            let origin = [ORIGIN.0 as f32, ORIGIN.1 as f32];
            // SAFETY: inside the canvas's scope, of the format given.
            unsafe {
                renderer
                    .borrow_mut()
                    .draw_depth(cmd, origin)
                    .expect("draws")
            };
        };
        let [pixels, _] = canvas.draw(before, inside);
        let depths = part(&pixels);
        let (rect, mesh) = world.meshes[1];
        let middle = (rect.offset.y + 20) as u32 * VIEW.0 + rect.offset.x as u32 + 60;
        let whole = reference::depth::expected::<f64>(
            &world.before(mesh),
            &world.camera,
            &clip,
            &Settings::default(),
        );
        for at in (middle..middle + 20).map(|at| at as usize) {
            let ([sum, alpha, ..], truth) = (depths.pixels[at], whole[at]);
            assert!(
                (f64::from(sum) - truth[0]).abs() < 2e-3 * truth[0],
                "{sum} {truth:?}"
            );
            assert!(
                (f64::from(alpha) - truth[1]).abs() < 2e-3,
                "{alpha} {truth:?}"
            );
        }
    });
}
