//! Expected depths are the reference's, alone and against a host's depth buffer.

use super::*;
use crate::canvas::with_host;
use rara::glam::{DQuat, DVec3};
use rara::gpu::Bindings;
use rara::{ExpectedDepthDesc, FrameLimits, Mode, Placement};

const FORMAT: vk::Format = vk::Format::R32G32_SFLOAT;

/// Draws a frame of expected depths on a canvas of their format; returns the whole canvas.
fn draw(
    on: On<'_>,
    canvas: &Canvas,
    world: &World,
    desc: RendererDesc,
    look: (&Clip, &Settings),
    frame: Frame,
) -> Vec<[f32; 4]> {
    let placed = (&world.camera, Placement::IDENTITY);
    draw_placed(on, canvas, (world, placed), desc, look, frame)
}

/// The same of a scene that the host has placed, seen by a camera of its own.
fn draw_placed(
    (device, first): On<'_>,
    canvas: &Canvas,
    (world, (camera, placement)): (&World, (&Camera, Placement)),
    desc: RendererDesc,
    (clip, settings): (&Clip, &Settings),
    frame: Frame,
) -> Vec<[f32; 4]> {
    let scene = SceneBuffers::upload(device, &world.scene, rara::ShFormat::Float);
    let scene = scene.expect("uploads");
    let desc = desc.expected_depth(Some(ExpectedDepthDesc::new(FORMAT)));
    let mut renderer = first.sharing(desc).expect("a renderer");
    renderer.set_placement(placement);
    let configured = renderer.configure(&scene, camera, clip, settings);
    let frame = Frame {
        call: Renderer::draw_depth,
        ..frame
    };
    canvas.draw_frame(&mut renderer, &scene, configured, &frame)
}

/// A frame of expected depths on a canvas of two channels is the reference's, in every way of drawing the colours.
#[test]
fn expected_depths_are_the_references() {
    let world = World::new();
    with_host(true, |host, device| {
        let first = first(device);
        let canvas = Canvas::new(&host.lend(), device, CanvasDesc::new(VIEW, FORMAT));
        for (mode, planes, op) in [
            (Mode::None, 0, ClipOp::And),
            (Mode::Exact, 1, ClipOp::And),
            (Mode::Exact, 2, ClipOp::Or),
            (Mode::Rara, 1, ClipOp::And),
            (Mode::Hard, 1, ClipOp::And),
        ] {
            let clip = common::clip(&world.scene, planes, op);
            let settings = Settings::default().mode(mode);
            let truth = rara_reference::depth::expected::<f64>(
                &world.scene,
                &world.camera,
                &clip,
                &settings,
            );
            for (raster, bindings) in [
                (Raster::Tiles, Bindings::Bound),
                (Raster::Quad, Bindings::Address),
            ] {
                let desc = RendererDesc::new(FLOATS).bindings(bindings);
                let look = (&clip, &settings.raster(raster));
                let on = (device, &first);
                let pixels = draw(on, &canvas, &world, desc, look, Frame::new(VIEW));
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
        }
    });
}

/// A host that has placed the scene gets depths in its own units.
#[test]
fn expected_depths_are_in_the_hosts_units() {
    let world = World::new();
    let larger = Placement::new(DVec3::ZERO, DQuat::IDENTITY, 2.0).expect("a scale");
    let farther = world.camera.eye(2.0 * world.camera.eye);
    let clip = Clip::default();
    with_host(true, |host, device| {
        let first = first(device);
        let canvas = Canvas::new(&host.lend(), device, CanvasDesc::new(VIEW, FORMAT));
        let [own, hosts] =
            [(&world.camera, Placement::IDENTITY), (&farther, larger)].map(|placed| {
                let (desc, look) = (RendererDesc::new(FLOATS), (&clip, &Settings::default()));
                let frame = Frame::new(VIEW);
                draw_placed(
                    (device, &first),
                    &canvas,
                    (&world, placed),
                    desc,
                    look,
                    frame,
                )
            });
        assert!(own.iter().filter(|pixel| pixel[1] > 0.02).count() > 2_000);
        for (own, hosts) in own.iter().zip(&hosts) {
            let [sum, alpha]: [(f32, f32); 2] =
                [0, 1].map(|channel| (own[channel], hosts[channel]));
            assert!((alpha.0 - alpha.1).abs() < 1e-3, "{own:?} {hosts:?}");
            assert!(
                (2.0 * sum.0 - sum.1).abs() < 1e-3 * (1.0 + sum.1),
                "{own:?} {hosts:?}"
            );
        }
    });
}

/// The rest of a big cut splat lies farther away than its centre, and a host's mesh hides depths like colours.
#[test]
fn expected_depths_are_behind_the_cut_and_before_the_mesh() {
    let world = World::new();
    let map = maps()[2];
    with_host(true, |host, device| {
        let mut desc = canvas(&world, map, vk::Format::D32_SFLOAT);
        desc.color = FORMAT;
        let depth = depth_desc(&desc, map, false);
        let canvas = Canvas::new(&host.lend(), device, desc);
        let desc = RendererDesc::new(FLOATS)
            .depth(Some(depth))
            .bindings(Bindings::Bound);
        let clip = Clip::default();
        let look = (&clip, &Settings::default());
        let pixels = draw(
            (device, &first(device)),
            &canvas,
            &world,
            desc,
            look,
            frame(None),
        );
        let depths = part(&pixels);
        let (rect, mesh) = world.meshes[1];
        let middle = (rect.offset.y + 20) as u32 * VIEW.0 + rect.offset.x as u32 + 60;
        let whole = rara_reference::depth::expected::<f64>(
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

/// Tiles find the same depths in coarse lists, where those of their own have no room.
#[test]
fn depths_of_tiles_without_room_are_the_same() {
    let world = World::new();
    let scene = rara::ShFormat::Float;
    with_host(true, |host, device| {
        let first = first(device);
        let canvas = Canvas::new(&host.lend(), device, CanvasDesc::new(VIEW, FORMAT));
        let there = SceneBuffers::upload(device, &world.scene, scene).expect("uploads");
        let desc = RendererDesc::new(FLOATS).expected_depth(Some(ExpectedDepthDesc::new(FORMAT)));
        let settings = world.settings.raster(Raster::Tiles);
        let [coarse, whole] = [Some(16), None].map(|pairs| {
            let limits = FrameLimits::new(VIEW, world.scene.len() as u32)
                .planes(1)
                .settings(vec![settings])
                .pairs(pairs);
            let mut renderer = first.sharing(desc).expect("a renderer");
            renderer.reserve(&limits).expect("there is memory");
            let configured = renderer.configure(&there, &world.camera, &world.clip, &settings);
            let frame = Frame {
                call: Renderer::draw_depth,
                ..Frame::new(VIEW)
            };
            let pixels = canvas.draw_frame(&mut renderer, &there, configured, &frame);
            assert_eq!(renderer.fell_back(), pairs.is_some());
            pixels
        });
        assert!(whole.iter().filter(|pixel| pixel[1] > 0.02).count() > 2_000);
        for (coarse, whole) in coarse.iter().zip(&whole) {
            let apart = [0, 1].map(|channel| (coarse[channel] - whole[channel]).abs());
            assert!(apart[0] < 1e-5 && apart[1] < 1e-6, "{coarse:?} {whole:?}");
        }
    });
}
