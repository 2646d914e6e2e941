//! The renderer's memory while frames are in flight: it grows, is freed, and a frame may have too little of it.

use std::sync::Arc;

use super::*;

#[test]
fn the_hosts_device_is_kept_alive_as_long_as_anything_is_made_from_it() {
    let host = open_host(BYTES, VIEW, true);
    let kept = Arc::new(());
    let alive = || Arc::strong_count(&kept) > 1;
    // SAFETY: the handles belong together, and the host outlives what is made of the device.
    let device = unsafe { Device::adopt(host.lend().keep_alive(Some(kept.clone()))) };
    let device = device.expect("the host's device draws splats");
    let scene = SceneBuffers::upload(&device, &scene(), ShFormat::default()).expect("uploads");
    let renderer = Renderer::new(&device, in_flight(BYTES, Bindings::Address)).expect("a renderer");
    assert_eq!(device.close(), Vec::<String>::new());
    assert!(alive());
    drop(renderer);
    assert!(alive(), "the scene is left");
    drop(scene);
    assert!(!alive());
    assert_eq!(host.close(), Vec::<String>::new());
}

#[test]
fn memory_that_a_frame_outgrows_is_freed_when_no_frame_can_use_it() {
    let scene = scene();
    let frames = frames(&scene);
    let desc = in_flight(BYTES, Bindings::Address);
    let host = open_host(BYTES, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    let mut used = Vec::new();
    // Splats that six planes cut need more room than those of the first frame, which one cuts.
    for index in [1, 2, 2, 2] {
        engine.wait();
        engine.configure(&frames[index]);
        used.push(engine.device.device_bytes());
        engine.record(vk::Offset2D::default());
    }
    assert!(
        used[1] > used[2],
        "the first frame was done before the third: {used:?}"
    );
    assert_eq!(used[2], used[3], "{used:?}");
    engine.wait_for_all();
    engine.close();
}

/// Makes Gaussians so large that each covers the picture, and so faint that no pixel is saturated before the last.
fn enlarge(scene: &mut Gaussians, which: impl Iterator<Item = usize>) {
    let size = rara::scene::Bounds::of(&*scene).radius() as f32;
    for index in which {
        scene.scales_mut()[index] = glam::Vec3::splat(size);
        scene.opacities_mut()[index] = 0.02;
    }
}

/// A first frame has the room for more pairs of tile and splat than scenes usually have, and neither the frames like it nor
/// one with fewer pairs allocate anything.
#[test]
fn a_first_frame_of_tiles_has_room_and_those_after_it_keep_it() {
    let mut scene = generate(Kind::General, 1_000, 5);
    enlarge(&mut scene, 0..1_000);
    let (camera, clip, settings) = frames(&scene).swap_remove(1);
    let truth = rara_reference::render::<f64>(&scene, &camera, &clip, &settings).picture;
    let desc = in_flight(FLOATS, Bindings::Mixed);
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    let expected = expected(&engine.host, &truth, 0);
    let shown = (camera, clip, settings.raster(Raster::Tiles));
    let mut used = Vec::new();
    for frame in 0..2 * FRAMES {
        if let Some(pixels) = engine.wait() {
            assert!(
                !engine.renderer.fell_back(),
                "frame {frame} reports one with room"
            );
            assert_eq!(engine.renderer.raster().path, "tiles");
            assert_shows(&format!("frame {frame}"), FLOATS, &pixels, &expected);
        }
        engine.configure(&shown);
        used.push(engine.device.device_bytes());
        engine.record(vk::Offset2D::default());
    }
    engine.wait_for_all();
    assert!(!engine.renderer.fell_back());
    assert!(used.iter().all(|bytes| *bytes == used[0]), "{used:?}");
    engine.close();
}

/// A first frame has no room for all of its pairs of tile and splat, as the estimate, which looks at every third of these
/// Gaussians, takes none of the large ones for what they are: its lists are coarse, with the same picture, and the next
/// frame after the host has waited for it has the room.
#[test]
fn a_frame_without_room_for_its_tiles_has_coarse_lists() {
    let mut scene = generate(Kind::General, 2_100, 5);
    scene.scales_mut().fill(glam::Vec3::splat(1e-3));
    scene.opacities_mut().fill(0.01);
    enlarge(&mut scene, (0..2_100).filter(|index| index % 3 != 0));
    let (camera, clip, settings) = frames(&scene).swap_remove(1);
    let truth = rara_reference::render::<f64>(&scene, &camera, &clip, &settings).picture;
    let desc = in_flight(FLOATS, Bindings::Mixed);
    let host = open_host(FLOATS, VIEW, true);
    let mut engine = Engine::new(host, &scene, ShFormat::default(), desc);
    let expected = expected(&engine.host, &truth, 0);
    let shown = (camera, clip, settings.raster(Raster::Tiles));
    for frame in 0..2 * FRAMES {
        if let Some(pixels) = engine.wait() {
            assert!(
                engine.renderer.fell_back(),
                "frame {frame} reports one that had no room"
            );
            assert_shows(&format!("frame {frame}"), FLOATS, &pixels, &expected);
        }
        engine.configure(&shown);
        engine.record(vk::Offset2D::default());
    }
    let pixels = engine.wait_for_all();
    assert_shows("the last frame", FLOATS, &pixels, &expected);
    assert!(!engine.renderer.fell_back());
    engine.close();
}
