//! Tests that look inside a renderer.

mod faults;

use std::collections::BTreeMap;

use super::*;
use crate::passes::SceneBuffers;
use glam::DVec3;
use rara_gpu::{Drawer, ImageDesc, testing};
use rara_scene::camera::Camera;
use rara_scene::clip::{Clip, ClipOp, Plane};
use rara_scene::precision::ShFormat;
use rara_scene::settings::{Raster, Settings};
use rara_scene::{Bounds, Kind, generate};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Recording goes on while another renderer compiles into the pipelines that both share. Who compiles holds the lock, as
/// this test does, which would not end if recording waited for it. Configuring a frame that needs nothing new does not wait
/// either.
#[test]
fn recording_waits_for_no_compiler() {
    let device = testing::device();
    let scene = generate(Kind::General, 600, 1);
    let camera = Camera::frame(&Bounds::of(&scene), -DVec3::Y, 50.0, (24, 16)).expect("a view");
    let buffers = SceneBuffers::upload(&device, &scene, ShFormat::Packed).expect("uploads");
    let target = device.create_image(&ImageDesc {
        name: "target",
        width: camera.width,
        height: camera.height,
        format: FORMAT,
    });
    let target = target.expect("memory");
    let mut renderer = Renderer::new(&device, RendererDesc::new(FORMAT)).expect("a renderer");
    let other = renderer.sharing(RendererDesc::new(FORMAT)).expect("shares");
    let (clip, settings) = (Clip::default(), Settings::default());
    let configured = renderer.configure(&buffers, &camera, &clip, &settings);
    drop(configured.expect("configures"));

    let compiling = other.pipelines.all.lock().expect("nobody has panicked");
    let configured = renderer.configure(&buffers, &camera, &clip, &settings);
    let frame = configured.expect("configures");
    let submitted = device.submit_and_wait(|cmd| {
        // SAFETY: `cmd` is recording outside rendering, and all that is used outlives the wait. The scope is opened and
        // closed around the draw, on an attachment of the renderer's format.
        unsafe {
            let frame = renderer.prepare(cmd, &buffers, None, frame)?;
            target.begin_rendering(cmd, [0.0; 4]);
            Drawer::new(&device, cmd, None).viewport(target.extent().into());
            renderer.draw(cmd, [0.0; 2], &frame)?;
            target.end_rendering(cmd);
        }
        Ok(())
    });
    submitted.expect("submits");
    drop(compiling);
    drop((renderer, other, target, buffers));
    assert_eq!(device.close(), Vec::<String>::new());
}

/// The working buffers by name: where they are, and how large.
fn places(renderer: &Renderer) -> BTreeMap<String, (u64, u64)> {
    let of_cut = renderer.cut.memory.buffers();
    let all = renderer.memory.buffers().all().chain(of_cut.all());
    all.map(|buffer| (buffer.name().to_owned(), (buffer.address(), buffer.size())))
        .collect()
}

/// A first clip and a second plane make those buffers anew that have to be larger, and going back to fewer makes none.
#[test]
fn buffers_that_suffice_stay_when_others_grow() {
    let device = testing::device();
    let scene = generate(Kind::General, 3_000, 1);
    let camera = Camera::frame(&Bounds::of(&scene), -DVec3::Y, 50.0, (90, 60)).expect("a view");
    let buffers = SceneBuffers::upload(&device, &scene, ShFormat::Packed).expect("uploads");
    let planes = [DVec3::X, DVec3::Y].map(|normal| Plane::new(normal, 0.1).expect("a normal"));
    for frames_in_flight in [1, 2] {
        let desc = RendererDesc::new(FORMAT).frames_in_flight(frames_in_flight);
        let mut renderer = Renderer::new(&device, desc).expect("a renderer");
        let mut before = None;
        let first_clip = [
            "clip_list",
            "clip_masks",
            "clip_sides",
            "cut_records",
            "surfaces",
        ];
        for (count, raster, grown) in [
            (0, Raster::Tiles, &[][..]),
            (0, Raster::Tiles, &[]),
            (1, Raster::Tiles, &first_clip),
            (2, Raster::Tiles, &["cut_records", "surfaces"]),
            (1, Raster::Tiles, &[]),
            (0, Raster::Tiles, &[]),
            (0, Raster::Quad, &["quads"]),
            (2, Raster::Tiles, &[]),
        ] {
            let clip = Clip::of(planes[..count].iter().copied(), ClipOp::And);
            let settings = Settings::default().raster(raster);
            let configured = renderer.configure(&buffers, &camera, &clip, &settings);
            drop(configured.expect("configures"));
            let now = places(&renderer);
            if let Some(before) = before {
                let before: BTreeMap<String, (u64, u64)> = before;
                let new = now
                    .iter()
                    .filter(|(name, at)| before.get(*name) != Some(*at));
                let new: Vec<&str> = new.map(|(name, _)| name.as_str()).collect();
                assert_eq!(new, grown, "{count} planes, {raster:?}");
            }
            before = Some(now);
        }
    }
    drop(buffers);
    assert_eq!(device.close(), Vec::<String>::new());
}

/// The room of a first frame is made by the estimate, which has to be near the truth for scenes of which it sees a part.
#[test]
fn pairs_are_estimated_before_they_are_counted() {
    let device = testing::device();
    for (kind, count) in [
        (Kind::General, 1_500),
        (Kind::General, 20_000),
        (Kind::Layers, 20_000),
    ] {
        let scene = generate(kind, count, 3);
        let bounds = Bounds::of(&scene);
        let buffers = SceneBuffers::upload(&device, &scene, ShFormat::Packed).expect("uploads");
        let mut renderer = Renderer::new(&device, RendererDesc::new(FORMAT)).expect("a renderer");
        let far = Camera::frame(&bounds, -DVec3::Y, 50.0, (400, 300)).expect("a view");
        let near = bounds.centre() + DVec3::Z * 0.3 * bounds.radius();
        let near = Camera::look_at(near, bounds.centre(), -DVec3::Y, 70.0, (400, 300));
        let flat = Camera::frame_orthographic(&bounds, -DVec3::Y, (400, 300)).expect("a view");
        for camera in [far, near.expect("a view"), flat] {
            let settings = Settings::default().raster(Raster::Tiles);
            let configured = renderer.configure(&buffers, &camera, &Clip::default(), &settings);
            let frame = configured.expect("configures");
            let submitted = device.submit_and_wait(|cmd| {
                // SAFETY: `cmd` is recording outside rendering, and all that is used outlives the wait.
                unsafe { renderer.prepare(cmd, &buffers, None, frame) }
            });
            submitted.expect("submits");
            assert!(!renderer.fell_back());
            let counted = f64::from(renderer.pairs());
            let share = f64::from(buffers.estimated_pairs(&camera)) / counted;
            eprintln!("{kind:?}, {count}: {counted} pairs, {share:.2} of them estimated");
            assert!(
                (0.75..1.33).contains(&share),
                "{kind:?}, {count}: {share} of {counted}"
            );
        }
    }
    assert_eq!(device.close(), Vec::<String>::new());
}
