//! rara in a host's own engine, under the host's own validation: `tools/examples/host.rs` has instance, device, queue,
//! targets and two frames in flight; the pictures must be the headless ones, over what the host has painted.

use crate::common;
use crate::host::{FRAMES, Host, HostDesc};
use rara::ash::vk;
use rara::gpu::{Bindings, Device};
use rara::scene::{Kind, generate};
use rara::{
    Camera, Clip, ClipOp, Counts, Gaussians, Picture, Raster, Renderer, RendererDesc, SceneBuffers,
    Settings,
};

const BYTES: vk::Format = vk::Format::R8G8B8A8_UNORM;
const HALVES: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// The size of the camera's picture: no multiple of anything, so that nothing is right by chance.
const VIEW: vk::Extent2D = vk::Extent2D {
    width: 189,
    height: 131,
};

fn host(format: vk::Format, extent: vk::Extent2D, optional: bool) -> Host {
    let device = std::env::var("RARA_TEST_DEVICE").ok();
    let host = Host::new(&HostDesc {
        device: device.as_deref(),
        validation: true,
        optional,
        extent,
        format,
    });
    host.expect("a Vulkan device and the validation layer (tools/test installs both)")
}

fn adopt(host: &Host) -> Device {
    // SAFETY: the handles belong together; every test drops what it makes before it closes the host.
    unsafe { Device::adopt(host.lend()) }.expect("the host's device can draw splats")
}

fn in_flight(format: vk::Format, bindings: Bindings) -> RendererDesc {
    RendererDesc::new(format)
        .bindings(bindings)
        .timing(true)
        .frames_in_flight(FRAMES as u32)
}

fn scene() -> Gaussians {
    generate(Kind::General, 3_000, 5)
}

/// Frames that need more and more room, and less again: cameras, clips of zero to six planes, settings.
fn frames(scene: &Gaussians) -> Vec<(Camera, Clip, Settings)> {
    let planes = [0, 1, 6, 2, 0, 3];
    let cameras = common::views(scene, planes.len(), (VIEW.width, VIEW.height));
    let clip = |count| common::clip(scene, count, ClipOp::And);
    let frame = |(camera, count)| (camera, clip(count), Settings::default());
    cameras.into_iter().zip(planes).map(frame).collect()
}

/// Records one frame as a host does. The splats go to `at`.
fn record(host: &mut Host, renderer: &mut Renderer, scene: &SceneBuffers, at: vk::Offset2D) {
    let cmd = host.begin().expect("begins");
    // SAFETY: `cmd` is recording outside rendering, and every test waits before it drops the scene.
    unsafe { renderer.prepare(cmd, scene).expect("prepares") };
    host.begin_rendering(vk::Rect2D {
        offset: at,
        extent: VIEW,
    });
    // SAFETY: `cmd` is inside rendering to a target of the renderer's format, viewport and scissor are set.
    unsafe {
        renderer
            .draw(cmd, [at.x as f32, at.y as f32])
            .expect("draws")
    };
    host.submit().expect("submits");
}

/// The headless picture over the host's stripes, of which column `left` is the first.
fn expected(host: &Host, picture: &Picture, left: u32) -> Vec<[f32; 4]> {
    let over = |(i, pixel): (usize, &[f32; 4])| {
        let below = host.backdrop(left + i as u32 % picture.width);
        [0, 1, 2, 3].map(|c| (pixel[c] + (1.0 - pixel[3]) * below[c]).clamp(0.0, 1.0))
    };
    picture.pixels.iter().enumerate().map(over).collect()
}

/// Largest and mean difference in units of 1/255. Values of a float target beyond white count as white.
fn apart(a: &[[f32; 4]], b: &[[f32; 4]]) -> (f32, f32) {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    let differences = pairs.map(|(a, b)| 255.0 * (a.min(1.0) - b.min(1.0)).abs());
    let (worst, sum) = differences.fold((0.0_f32, 0.0), |(worst, sum), d| (worst.max(d), sum + d));
    (worst, sum / (4 * a.len()) as f32)
}

/// Asserts that a target shows what it should, as well as its format can. Every blend rounds to the format, and dozens of
/// splats lie over each other. In 32 bits that shows nowhere, except where the last bit of a splat's centre in the target
/// decides whether its alpha is below 1/255. Halves are right to 1/8 of 1/255, and lavapipe truncates to them. 8-bit
/// blends are off by 1/2 each, on lavapipe by 1, and each of them cuts off what is beyond white.
fn assert_shows(what: &str, format: vk::Format, pixels: &[[f32; 4]], expected: &[[f32; 4]]) {
    let (worst, mean) = apart(pixels, expected);
    let (most, average) = match format {
        FLOATS => (1.0, 1e-3),
        HALVES => (6.0, 0.1),
        _ => (20.0, 0.3),
    };
    assert!(
        worst <= most && mean <= average,
        "{what}: {worst:.3}/255 at most, {mean:.4}/255 on average"
    );
}

#[test]
fn frames_in_flight_show_the_headless_pictures_over_what_the_host_has_painted() {
    let scene = scene();
    let frames = frames(&scene);
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let truth: Vec<(Picture, Counts)> = frames
        .iter()
        .map(|(camera, clip, settings)| {
            let stats = headless.render(camera, clip, settings).expect("renders");
            (headless.picture().expect("reads back"), stats.counts)
        })
        .collect();

    for (format, bindings) in [
        (FLOATS, Bindings::Bound),
        (FLOATS, Bindings::Address),
        (HALVES, Bindings::Bound),
        (BYTES, Bindings::Bound),
    ] {
        let mut host = host(format, VIEW, true);
        let device = adopt(&host);
        let buffers =
            SceneBuffers::upload(&device, &scene, rara::ShFormat::default()).expect("uploads");
        let desc = in_flight(format, bindings);
        let mut renderer = Renderer::new(&device, desc).expect("a renderer");

        let check = |host: &Host, pixels: &[[f32; 4]], frame: usize| {
            let expected = expected(host, &truth[frame].0, 0);
            let what = format!("{format:?}, {bindings:?}, frame {frame}");
            assert_shows(&what, format, pixels, &expected);
        };
        for (index, (camera, clip, settings)) in frames.iter().enumerate() {
            if let Some(pixels) = host.wait().expect("waits") {
                check(&host, &pixels, index - FRAMES);
                assert_eq!(renderer.counts(), truth[index - FRAMES].1);
                let times = renderer.pass_times();
                let named = |name| times.iter().any(|time| time.name == name);
                assert!(times.is_empty() || named("classify") && named("splat"));
            } else {
                assert_eq!(renderer.counts(), Counts::default());
            }
            let configured = renderer.configure(&buffers, camera, clip, settings);
            configured.expect("configures");
            record(&mut host, &mut renderer, &buffers, vk::Offset2D::default());
        }
        let pixels = host.wait().expect("waits").expect("a frame so long ago");
        check(&host, &pixels, frames.len() - FRAMES);
        let pixels = host.wait_for_all().expect("waits");
        check(&host, &pixels, frames.len() - 1);

        drop((renderer, buffers));
        assert_eq!(device.device_bytes(), 0, "everything allocated was freed");
        drop(device);
        assert_eq!(host.close(), Vec::<String>::new());
    }
}

/// A clip that moves, stands still and moves back before a camera that stands still, then another camera.
fn sweep(scene: &Gaussians) -> Vec<(Camera, Clip, Settings)> {
    let cameras = common::views(scene, 3, (VIEW.width, VIEW.height));
    let (low, high) = rara::scene::extent_along(scene, glam::DVec3::X);
    let steps = [
        (0, 0.2),
        (0, 0.4),
        (0, 0.6),
        (0, 0.6),
        (0, 0.3),
        (0, 0.7),
        (1, 0.7),
        (1, 0.5),
    ];
    let frame = |(camera, share): (usize, f64)| {
        let plane = rara::Plane::new(glam::DVec3::X, -(low + share * (high - low)));
        let clip = Clip::of([plane.expect("a finite normal")], ClipOp::And);
        (cameras[camera], clip, Settings::default())
    };
    steps.map(frame).to_vec()
}

#[test]
fn a_host_whose_frames_take_over_from_each_other_gets_the_same_pictures() {
    let scene = scene();
    let frames = sweep(&scene);
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let truth: Vec<Picture> = frames
        .iter()
        .map(|(camera, clip, settings)| {
            headless.forget();
            headless.render(camera, clip, settings).expect("renders");
            headless.picture().expect("reads back")
        })
        .collect();
    let mut rasters = vec![Raster::Tiles, Raster::Quad];
    if headless.device().support().mesh_shader {
        rasters.push(Raster::Mesh);
    } else {
        eprintln!("SKIPPED: this device has no mesh shaders");
    }
    let bindings = common::bindings(headless.device());
    let ways = rasters
        .iter()
        .flat_map(|raster| bindings.iter().map(|bindings| (*raster, *bindings)));
    for (raster, bindings) in ways {
        let mut host = host(FLOATS, VIEW, true);
        let device = adopt(&host);
        let buffers =
            SceneBuffers::upload(&device, &scene, rara::ShFormat::Float).expect("uploads");
        let desc = in_flight(FLOATS, bindings).reuse(true);
        let mut renderer = Renderer::new(&device, desc).expect("a renderer");
        let check = |host: &Host, pixels: &[[f32; 4]], frame: usize| {
            let what = format!("{raster:?}, {bindings:?}, frame {frame}");
            assert_shows(&what, FLOATS, pixels, &expected(host, &truth[frame], 0));
        };
        let mut reused = 0;
        for (index, (camera, clip, settings)) in frames.iter().enumerate() {
            if let Some(pixels) = host.wait().expect("waits") {
                check(&host, &pixels, index - FRAMES);
            }
            let settings = settings.raster(raster);
            let configured = renderer.configure(&buffers, camera, clip, &settings);
            configured.expect("configures");
            reused += usize::from(renderer.skipped().contains(&"project"));
            record(&mut host, &mut renderer, &buffers, vk::Offset2D::default());
        }
        let pixels = host.wait().expect("waits").expect("a frame so long ago");
        check(&host, &pixels, frames.len() - FRAMES);
        let pixels = host.wait_for_all().expect("waits");
        check(&host, &pixels, frames.len() - 1);
        assert_eq!(reused, 4, "the third frame to the sixth");
        drop((renderer, buffers, device));
        assert_eq!(host.close(), Vec::<String>::new());
    }
}

#[test]
fn a_viewport_anywhere_in_the_target_leaves_the_rest_alone() {
    let scene = scene();
    let (camera, clip, settings) = frames(&scene).swap_remove(1);
    let target = vk::Extent2D {
        width: 320,
        height: 200,
    };
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    headless.render(&camera, &clip, &settings).expect("renders");
    let truth = headless.picture().expect("reads back");
    for (format, optional) in [(FLOATS, true), (HALVES, true), (BYTES, false)] {
        let mut host = host(format, target, optional);
        let device = adopt(&host);
        let buffers =
            SceneBuffers::upload(&device, &scene, rara::ShFormat::default()).expect("uploads");
        let desc = in_flight(format, Bindings::Bound);
        let mut renderer = Renderer::new(&device, desc).expect("a renderer");
        let mut raster = vec![Raster::Quad, Raster::Tiles];
        if device.support().mesh_shader {
            raster.push(Raster::Mesh);
        }
        for raster in raster {
            // In a corner, in the middle, and over the target's edge.
            for (x, y) in [(0, 0), (77, 43), (250, 150)] {
                host.wait().expect("waits");
                let settings = settings.raster(raster);
                let configured = renderer.configure(&buffers, &camera, &clip, &settings);
                configured.expect("configures");
                record(&mut host, &mut renderer, &buffers, vk::Offset2D { x, y });
                let pixels = host.wait_for_all().expect("waits");

                let inside = expected(&host, &truth, x as u32);
                let (x, y) = (x as u32, y as u32);
                let mut ours = Vec::new();
                let mut theirs = Vec::new();
                for (i, pixel) in pixels.iter().enumerate() {
                    let (column, row) = (i as u32 % target.width, i as u32 / target.width);
                    let (left, up) = (column.wrapping_sub(x), row.wrapping_sub(y));
                    if left < VIEW.width && up < VIEW.height {
                        ours.push(*pixel);
                        theirs.push(inside[(up * VIEW.width + left) as usize]);
                    } else {
                        let backdrop = host.backdrop(column);
                        let worst = apart(&[*pixel], &[backdrop]).0;
                        // As exact as truncated halves are, see `assert_shows`.
                        assert!(worst < 0.125, "{column},{row} is the host's: {pixel:?}");
                    }
                }
                let what = format!("{format:?}, {raster:?} at {x},{y}");
                assert_shows(&what, format, &ours, &theirs);
            }
        }
        drop((renderer, buffers, device));
        assert_eq!(host.close(), Vec::<String>::new());
    }
}

#[test]
fn memory_that_a_frame_outgrows_is_freed_when_no_frame_can_use_it() {
    let scene = scene();
    let frames = frames(&scene);
    let mut host = host(BYTES, VIEW, true);
    let device = adopt(&host);
    let buffers =
        SceneBuffers::upload(&device, &scene, rara::ShFormat::default()).expect("uploads");
    let desc = in_flight(BYTES, Bindings::Address);
    let mut renderer = Renderer::new(&device, desc).expect("a renderer");
    let mut used = Vec::new();
    // The first frame needs no room for cut splats, all after it do.
    for index in [0, 1, 1, 1] {
        let (camera, clip, settings) = &frames[index];
        host.wait().expect("waits");
        let configured = renderer.configure(&buffers, camera, clip, settings);
        configured.expect("configures");
        used.push(device.device_bytes());
        record(&mut host, &mut renderer, &buffers, vk::Offset2D::default());
    }
    assert!(
        used[1] > used[2],
        "the first frame was done before the third: {used:?}"
    );
    assert_eq!(used[2], used[3], "{used:?}");
    host.wait_for_all().expect("waits");
    drop((renderer, buffers, device));
    assert_eq!(host.close(), Vec::<String>::new());
}

#[test]
fn an_empty_scene_records_nothing() {
    let scene = Gaussians::default();
    let (camera, clip, settings) = frames(&self::scene()).swap_remove(1);
    let mut host = host(BYTES, VIEW, true);
    let device = adopt(&host);
    let buffers =
        SceneBuffers::upload(&device, &scene, rara::ShFormat::default()).expect("uploads");
    let mut renderer =
        Renderer::new(&device, in_flight(BYTES, Bindings::Address)).expect("a renderer");
    for _ in 0..3 {
        host.wait().expect("waits");
        let configured = renderer.configure(&buffers, &camera, &clip, &settings);
        configured.expect("configures");
        record(&mut host, &mut renderer, &buffers, vk::Offset2D::default());
    }
    let pixels = host.wait_for_all().expect("waits");
    let nothing = Picture::filled(VIEW.width, VIEW.height, [0.0; 4]);
    assert_eq!(pixels, expected(&host, &nothing, 0));
    assert_eq!(renderer.counts(), Counts::default());
    assert!(renderer.pass_times().is_empty());
    drop((renderer, buffers, device));
    assert_eq!(host.close(), Vec::<String>::new());
}

#[test]
fn what_there_cannot_be_is_refused_with_a_reason() {
    let host = host(BYTES, VIEW, true);
    let device = adopt(&host);
    let depth = |format, stencil, readable| {
        let map = rara::DepthMap::ordinary(0.1, 10.0).expect("a map");
        Some(
            rara::DepthDesc::new(format, map)
                .stencil(stencil)
                .readable(readable),
        )
    };
    let desc = RendererDesc::new(BYTES);
    let name = &device.info().name;
    for (desc, says) in [
        (
            RendererDesc::new(vk::Format::R8G8B8A8_UINT),
            ["R8G8B8A8_UINT", name.as_str()],
        ),
        (
            desc.frames_in_flight(0),
            ["frames_in_flight is 0", "from 1 to 16"],
        ),
        (
            desc.frames_in_flight(u32::MAX),
            ["frames_in_flight is 4294967295", "from 1 to 16"],
        ),
        (
            desc.depth(depth(vk::Format::S8_UINT, false, false)),
            ["S8_UINT", "no depth"],
        ),
        (
            desc.depth(depth(vk::Format::D32_SFLOAT, true, false)),
            ["D32_SFLOAT", "DepthDesc::stencil"],
        ),
        (
            desc.depth(depth(vk::Format::D32_SFLOAT, false, true))
                .samples(vk::SampleCountFlags::TYPE_4),
            ["DepthDesc::readable", "samples"],
        ),
        (
            desc.expected_depth(Some(rara::ExpectedDepthDesc::new(vk::Format::R32_SFLOAT))),
            ["R32_SFLOAT", "two floats"],
        ),
    ] {
        let text = Renderer::new(&device, desc).unwrap_err().to_string();
        assert!(says.iter().all(|part| text.contains(part)), "{text}");
    }
    drop(device);
    assert_eq!(host.close(), Vec::<String>::new());
}

/// Calls that are refused before anything is recorded, so that no command buffer is needed.
#[test]
fn calls_in_an_order_that_makes_no_sense_are_refused() {
    let headless = common::headless();
    let device = headless.device();
    let null = vk::CommandBuffer::null();
    let refused = |result: rara::Result<()>, why: &str| match result {
        Err(rara::Error::Invalid(text)) => assert!(text.contains(why), "{text}"),
        other => panic!("{other:?}, and not that {why}"),
    };
    let (camera, clip, settings) = frames(&scene()).swap_remove(1);
    let upload =
        |scene| SceneBuffers::upload(device, &scene, rara::ShFormat::default()).expect("uploads");
    // A scene as large as the other, but not the same.
    let (one, other) = (upload(scene()), upload(generate(Kind::General, 3_000, 6)));
    let mut renderer = Renderer::new(device, RendererDesc::new(BYTES)).expect("a renderer");
    // SAFETY: all of them are refused before anything is recorded.
    unsafe {
        let why = "draw needs a successful configure() and prepare() before it";
        refused(renderer.draw(null, [0.0; 2]), why);
        refused(renderer.draw_depth(null, [0.0; 2]), "expected_depth");
        let why = "prepare needs a successful configure() before it";
        refused(renderer.prepare(null, &one), why);
        let configured = renderer.configure(&one, &camera, &clip, &settings);
        configured.expect("configures");
        let why = "another scene than configure()";
        refused(renderer.prepare(null, &other), why);
        let why = "draw needs a successful configure() and prepare() before it";
        refused(renderer.draw(null, [0.0; 2]), why);
    }
    let map = rara::DepthMap::ordinary(0.1, 10.0).expect("a map");
    refused(renderer.set_depth_map(map), "depth attachment");
    // A scene on a device of its own.
    let elsewhere = common::headless();
    let scene = SceneBuffers::upload(elsewhere.device(), &scene(), rara::ShFormat::default());
    let configured = renderer.configure(&scene.expect("uploads"), &camera, &clip, &settings);
    refused(configured, "another device");
}

/// What is set between a frame's preparation and its draw takes effect in the next frame.
#[test]
fn settings_of_the_next_frame_leave_the_prepared_one_alone() {
    let scene = scene();
    let (camera, clip, settings) = frames(&scene).swap_remove(1);
    let mut host = host(FLOATS, VIEW, true);
    let device = adopt(&host);
    let buffers =
        SceneBuffers::upload(&device, &scene, rara::ShFormat::default()).expect("uploads");
    let mut renderer =
        Renderer::new(&device, in_flight(FLOATS, Bindings::Bound)).expect("a renderer");
    let moved = rara::Placement::new(glam::DVec3::X, glam::DQuat::IDENTITY, 2.0).expect("finite");
    let mut pictures = Vec::new();
    for frame in 0..2 {
        host.wait().expect("waits");
        let configured = renderer.configure(&buffers, &camera, &clip, &settings);
        configured.expect("configures");
        let cmd = host.begin().expect("begins");
        // SAFETY: `cmd` is recording outside rendering, and the frame is waited for below.
        unsafe { renderer.prepare(cmd, &buffers).expect("prepares") };
        if frame == 1 {
            renderer.set_placement(moved);
            renderer.set_color_format(BYTES);
        }
        host.begin_rendering(VIEW.into());
        // There are more draws than the timer has room for; the picture of the last is blended over the others.
        for _ in 0..20 {
            // SAFETY: `cmd` is inside rendering to a target of the renderer's format, viewport and scissor are set.
            unsafe { renderer.draw(cmd, [0.0; 2]).expect("draws") };
        }
        host.submit().expect("submits");
        pictures.push(host.wait_for_all().expect("waits"));
        let times = renderer.pass_times();
        assert!(times.is_empty() || times.iter().any(|time| time.name == "splat"));
    }
    assert!(pictures[0] == pictures[1]);
    drop((renderer, buffers, device));
    assert_eq!(host.close(), Vec::<String>::new());
}

/// A first frame has no room for all of its pairs of tile and splat: it is drawn as quads, with the same picture, and the
/// next frame after the host has waited for it has the room.
#[test]
fn a_frame_without_room_for_its_tiles_is_drawn_as_quads() {
    let mut scene = generate(Kind::General, 1_000, 5);
    let size = rara::scene::Bounds::of(&scene).radius() as f32;
    for scale in scene.scales_mut() {
        *scale = glam::Vec3::splat(size);
    }
    for opacity in scene.opacities_mut() {
        *opacity = 0.02; // so that no pixel is saturated before the last
    }
    let (camera, clip, settings) = frames(&scene).swap_remove(1);
    let truth = rara::reference::render::<f64>(&scene, &camera, &clip, &settings).picture;
    let mut host = host(FLOATS, VIEW, true);
    let device = adopt(&host);
    let buffers =
        SceneBuffers::upload(&device, &scene, rara::ShFormat::default()).expect("uploads");
    let mut renderer =
        Renderer::new(&device, in_flight(FLOATS, Bindings::Bound)).expect("a renderer");
    let expected = expected(&host, &truth, 0);
    for frame in 0..2 * FRAMES {
        if let Some(pixels) = host.wait().expect("waits") {
            assert!(
                renderer.fell_back(),
                "frame {frame} reports one that had no room"
            );
            assert_shows(&format!("frame {frame}"), FLOATS, &pixels, &expected);
        }
        let settings = settings.raster(Raster::Tiles);
        let configured = renderer.configure(&buffers, &camera, &clip, &settings);
        configured.expect("configures");
        record(&mut host, &mut renderer, &buffers, vk::Offset2D::default());
    }
    let pixels = host.wait_for_all().expect("waits");
    assert_shows("the last frame", FLOATS, &pixels, &expected);
    assert!(!renderer.fell_back());
    drop((renderer, buffers, device));
    assert_eq!(host.close(), Vec::<String>::new());
}
