//! Frames and layers that are cut by regions of any shapes.

use super::*;
use crate::clips::clip_of;
use rara::clip::Expression;
use rara::scene::Bounds;
use rara::{Clip, Layer};
use rara_c::clip::*;
use rara_c::layer::*;
use rara_c::layer_info::*;

#[test]
fn regions_are_the_same_bytes() {
    with_both(600, |scene, lent, device, ours| {
        let bitten = c"all(not(sphere:0.2,0,0,0.5), any(plane:0,0,1,0, cylinder:-1,0,0,1,0,0,.3))";
        let mut seen: Vec<Pixels> = Vec::new();
        let uploaded = ours.uploaded();
        for made in [
            World::new(scene, Raster::Tiles),
            World::flat(scene, Raster::Quad),
        ] {
            for region in [None, Some(bitten), Some(c"!box:0,0,0,.4,.4,.4")] {
                let world = World {
                    region,
                    layers: scene.into(),
                    ..made
                };
                let canvas = world.canvas(lent, device);
                let truth = world.drawn(device, &canvas);
                // SAFETY: the handles are alive.
                let drawn = unsafe { world.drawn_in_c(ours.device, &canvas, |_| uploaded) };
                assert!(drawn == truth, "{region:?}");
                assert!(seen.iter().all(|before| *before != drawn), "{region:?}");
                seen.push(drawn);
            }
        }
        // SAFETY: all frames were waited for.
        unsafe { rara_scene_buffers_destroy(uploaded) };
    });
}

/// The camera's planes cut what the frame's clip keeps, of layers with a clip of their own too.
#[test]
fn planes_of_the_camera_are_the_same_bytes() {
    with_both(600, |scene, lent, device, ours| {
        let mut seen: Vec<Pixels> = Vec::new();
        let uploaded = ours.uploaded();
        let whole = clip_of(&[]);
        let middle = Bounds::of(scene).centre();
        let bitten = Some(c"!sphere:0.2,0,0,0.5");
        let [tiles, quads] = [Raster::Tiles, Raster::Quad].map(|way| World::new(scene, way));
        let flat = World::flat(scene, Raster::Tiles);
        for (made, [is_near, is_far], region, own) in [
            (&tiles, [true, false], None, false),
            (&tiles, [false, true], None, true),
            (&quads, [true, true], bitten, false),
            (&flat, [true, true], bitten, false),
        ] {
            let depth = (made.camera.rotation * (middle - made.camera.eye)).z;
            let near = is_near.then_some(depth - 0.3);
            let far = is_far.then_some(depth + 0.2);
            let layer = Layer::new("scene", scene);
            let world = World {
                camera: made.camera.clip_near(near).clip_far(far),
                region,
                layers: Scene::from_iter([match own {
                    true => layer.clipped(Clip::default()),
                    false => layer,
                }]),
                ..World::new(scene, made.raster)
            };
            let canvas = world.canvas(lent, device);
            let truth = world.drawn(device, &canvas);
            let own = if own { whole } else { null_mut() };
            // SAFETY: the handles are alive, and nobody else uses the scene.
            let drawn = unsafe {
                assert_ok(rara_scene_buffers_set_layer_clip(uploaded, 0, own));
                world.drawn_in_c(ours.device, &canvas, |_| uploaded)
            };
            let what = format!("{near:?} {far:?} {region:?} {:?}", made.raster);
            assert!(drawn == truth, "{what}");
            let filled = drawn.iter().filter(|pixel| pixel[1] > 0.05).count();
            assert!(filled > 500, "{what}: {filled} pixels");
            assert!(seen.iter().all(|before| *before != drawn), "{what}");
            seen.push(drawn);
        }
        // SAFETY: all frames were waited for.
        unsafe {
            rara_clip_destroy(whole);
            rara_scene_buffers_destroy(uploaded);
        }
    });
}

#[test]
fn layers_have_regions_of_their_own() {
    with_both(500, |scene, lent, device, ours| {
        let text = "cone:0,0,-1,0,0,1,0.8";
        let expression: Expression = text.parse().expect("a region");
        let world = |clip: Option<Clip>| {
            let inner = Layer::new("inner", scene);
            World {
                layers: Scene::from_iter([
                    Layer::new("outer", scene),
                    match clip {
                        Some(clip) => inner.clipped(clip),
                        None => inner,
                    },
                ]),
                ..World::new(scene, Raster::Tiles)
            }
        };
        let (own, shared) = (world(Some(expression.clip())), world(None));
        let canvas = own.canvas(lent, device);
        let (mut uploaded, mut region, mut index) = (null_mut(), null_mut(), 0);
        // SAFETY: the handles are alive, and the pointers may be overwritten.
        unsafe {
            let layers = [c"outer", c"inner"].map(|name| {
                let mut layer: RaraLayer = std::mem::zeroed();
                let size = size_of_val(&layer);
                let filled = rara_layer_default(&mut layer, size, name.as_ptr(), ours.gaussians);
                assert_ok(filled);
                layer
            });
            assert_ok(rara_scene_buffers_upload(
                ours.device,
                layers.as_ptr(),
                layers.len(),
                RARA_SH_FORMAT_PACKED,
                &mut uploaded,
            ));
            let name = c"inner".as_ptr();
            assert_ok(rara_scene_buffers_layer_by_name(uploaded, name, &mut index));
            assert_eq!(index, 1);
            let json =
                br#"[{"clip": {"cone": {"apex": [0,0,-1], "base": [0,0,1], "radius": 0.8}}}]"#;
            let (bytes, size) = (json.as_ptr(), json.len());
            assert_ok(rara_clip_from_json(
                bytes,
                size,
                std::ptr::null(),
                &mut region,
            ));
            assert_ok(rara_scene_buffers_set_layer_clip(uploaded, index, region));
            rara_clip_destroy(region); // the layer has a copy
            let drawn = own.drawn_in_c(ours.device, &canvas, |_| uploaded);
            assert!(drawn == own.drawn(device, &canvas), "a region of its own");
            let none = std::ptr::null();
            assert_ok(rara_scene_buffers_set_layer_clip(uploaded, index, none));
            let again = shared.drawn_in_c(ours.device, &canvas, |_| uploaded);
            assert!(
                again == shared.drawn(device, &canvas) && again != drawn,
                "the frame's"
            );
            rara_scene_buffers_destroy(uploaded);
        }
    });
}
