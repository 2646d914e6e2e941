//! Channels beside the colours, in the host's memory, are those of a headless renderer.

use std::ffi::CStr;
use std::ptr::null;

use super::*;
use crate::results::assert_fails;
use rara::clip::Expression;
use rara::gpu::Bindings;
use rara::scene::Bounds;
use rara::{Aov, Camera, Clip, Headless, HeadlessDesc, Layer, LayerState, Settings};
use rara_c::boundary::*;
use rara_c::camera::*;
use rara_c::channels::*;
use rara_c::clip::*;
use rara_c::layer::*;
use rara_c::placement::*;
use rara_c::renderer::*;
use rara_c::renderer_desc::*;

pub(super) const SIZE: (u32, u32) = (61, 43);
const PIXELS: usize = (SIZE.0 * SIZE.1) as usize;
const ALL: RaraAovs =
    RARA_AOV_DEPTH | RARA_AOV_NORMAL | RARA_AOV_LAYER | RARA_AOV_WEIGHT | RARA_AOV_COUNT;

/// The same by a headless renderer of its own, one channel after the other.
fn headless(scene: &Scene<'_>, camera: &Camera, clip: &Clip) -> Vec<f32> {
    // Another way to reach buffers rounds otherwise.
    let desc = HeadlessDesc::default().bindings(Some(Bindings::Mixed));
    let mut headless = Headless::new(&desc).expect("a device");
    headless.load(scene.clone()).expect("uploads");
    let all = [Aov::Depth, Aov::Normal, Aov::Layer, Aov::Weight, Aov::Count];
    let frame = (camera, clip, &Settings::default());
    let channels = headless.channels(&all, frame).expect("draws");
    channels
        .into_iter()
        .flat_map(|channel| channel.values)
        .collect()
}

/// Room for some channels of the camera's picture.
fn room(aovs: RaraAovs, values: &mut [f32]) -> RaraChannels {
    // SAFETY: the struct may hold any bytes, and has the room that the call is given.
    unsafe {
        let mut room: RaraChannels = std::mem::zeroed();
        let size = size_of_val(&room);
        let (width, height) = SIZE;
        assert_ok(rara_channels_default(&mut room, size, aovs, width, height));
        assert_eq!(room.value_count, values.len());
        room.values = values.as_mut_ptr();
        room
    }
}

/// Makes a renderer, which `test` uses.
pub(super) fn with_renderer(device: *mut RaraDevice, test: impl FnOnce(*mut RaraRenderer)) {
    let mut renderer = null_mut();
    // SAFETY: the device is alive, and the struct may hold any bytes.
    unsafe {
        let mut desc: RaraRendererDesc = std::mem::zeroed();
        let (size, format) = (size_of_val(&desc), vk::Format::R8G8B8A8_UNORM);
        assert_ok(rara_renderer_desc_default(&mut desc, size, format));
        desc.bindings = RARA_BINDINGS_MIXED;
        assert_ok(rara_renderer_create(device, &desc, &mut renderer));
        test(renderer);
        rara_renderer_destroy(renderer);
    }
}

/// These layers on a device.
pub(super) fn uploaded(device: *mut RaraDevice, layers: &[RaraLayer]) -> *mut RaraSceneBuffers {
    let mut scene = null_mut();
    let (list, count) = (layers.as_ptr(), layers.len());
    // SAFETY: the device is alive, and so is what the layers are made of.
    unsafe {
        let format = RARA_SH_FORMAT_FLOAT;
        assert_ok(rara_scene_buffers_upload(
            device, list, count, format, &mut scene,
        ));
    }
    scene
}

pub(super) fn camera(scene: &Gaussians) -> Camera {
    Camera::frame(&Bounds::of(scene), DVec3::NEG_Y, 50.0, SIZE).expect("a view")
}

#[test]
fn channels_are_those_of_a_headless_renderer() {
    with_both(1_200, |scene, _, _, ours| {
        let text = c"all(plane:0.6,0,0.8,0, !sphere:0.2,0,0,0.4)";
        let whole = c"slab:0,1,0,0,9";
        let parsed = |text: &CStr| -> Clip {
            let parsed: Expression = text.to_str().expect("UTF-8").parse().expect("a region");
            parsed.clip()
        };
        let turn = DQuat::from_xyzw(0.1, 0.3, -0.2, 0.9);
        let moved = Placement::new(DVec3::new(0.4, -0.2, 0.1), turn, 0.7).expect("possible");
        let state = LayerState::default().placement(moved).opacity(0.7);
        let other = Layer::new("one", scene).with(state).clipped(parsed(whole));
        let layers = Scene::from_iter([Layer::new("one", scene), other]);
        let camera = camera(scene);
        let depth = (camera.rotation * (Bounds::of(scene).centre() - camera.eye)).z;
        let camera = camera.clip_far(Some(depth + 0.4));
        let truth = headless(&layers, &camera, &parsed(text));
        assert_eq!(truth.len(), 7 * PIXELS);
        with_renderer(ours.device, |renderer| {
            // SAFETY: the handles are alive, and the pointers are null, or point to what they say.
            unsafe {
                let (mut cut, mut kept) = (null_mut(), null_mut());
                assert_ok(rara_clip_parse(text.as_ptr(), &mut cut));
                assert_ok(rara_clip_parse(whole.as_ptr(), &mut kept));
                let mut layers = [one_layer(ours.gaussians); 2];
                let state = RaraLayerState::from(state);
                (layers[1].state, layers[1].clip) = (&state, kept);
                let camera = RaraCamera::from(camera);
                let uploaded = uploaded(ours.device, &layers);
                let draw = |room: &RaraChannels| {
                    rara_renderer_channels(renderer, uploaded, &camera, cut, null(), room)
                };
                let before = rara_device_bytes(ours.device);
                let mut values = vec![-7.0; 7 * PIXELS];
                assert_ok(draw(&room(ALL, &mut values)));
                assert_eq!(rara_device_bytes(ours.device), before, "all is freed");
                for (channel, name) in ["Z", "N.X", "N.Y", "N.Z", "layer", "weight", "count"]
                    .into_iter()
                    .enumerate()
                {
                    let own = |all: &[f32]| all[channel * PIXELS..][..PIXELS].to_vec();
                    assert!(own(&values) == own(&truth), "{name}");
                }
                let shown = truth[..PIXELS].iter().filter(|depth| **depth > 0.0).count();
                let second = truth[4 * PIXELS..5 * PIXELS].iter();
                assert!(shown > 300 && second.filter(|layer| **layer == 1.0).count() > 50);
                // Some of them, in the order of their bits.
                let mut some = vec![0.0; 2 * PIXELS];
                assert_ok(draw(&room(RARA_AOV_COUNT | RARA_AOV_LAYER, &mut some)));
                assert!(some[..PIXELS] == values[4 * PIXELS..5 * PIXELS]);
                assert!(some[PIXELS..] == values[6 * PIXELS..]);
                rara_scene_buffers_destroy(uploaded);
                rara_clip_destroy(cut);
                rara_clip_destroy(kept);
            }
        });
    });
}

/// A renderer's placement is to its scene what a layer's is to the layer.
#[test]
fn channels_are_of_a_scene_where_the_renderer_places_it() {
    with_both(400, |scene, _, _, ours| {
        let turn = DQuat::from_xyzw(0.1, -0.4, 0.2, 0.9);
        let placed = Placement::new(DVec3::new(0.3, -0.1, 0.2), turn, 1.3).expect("possible");
        let state = LayerState::default().placement(placed);
        let layers = Scene::from_iter([Layer::new("one", scene).with(state)]);
        let camera = camera(scene);
        let truth = headless(&layers, &camera, &Clip::default());
        with_renderer(ours.device, |renderer| {
            let mut values = vec![-7.0; 7 * PIXELS];
            // SAFETY: the handles are alive, and the pointers are null, or point to what they say.
            unsafe {
                let placement = RaraPlacement::from(placed);
                assert_ok(rara_renderer_set_placement(renderer, &placement));
                let camera = RaraCamera::from(camera);
                let scene = ours.uploaded();
                let room = room(ALL, &mut values);
                let made = rara_renderer_channels(renderer, scene, &camera, null(), null(), &room);
                assert_ok(made);
                rara_scene_buffers_destroy(scene);
            }
            // Numbers are rounded in another space; a pixel at a splat's edge may have it or not.
            let differ =
                |(own, truth): (&f32, &f32)| (own - truth).abs() > 1e-3 * truth.abs().max(1.0);
            let differ = values
                .iter()
                .zip(&truth)
                .filter(|pair| differ(*pair))
                .count();
            assert!(differ < PIXELS / 100, "{differ} numbers differ");
            let shown = truth[..PIXELS].iter().filter(|depth| **depth > 0.0).count();
            assert!(shown > 300, "{shown} pixels");
        });
    });
}

#[test]
fn what_is_wrong_with_channels_is_said() {
    with_both(30, |scene, _, _, ours| {
        with_renderer(ours.device, |renderer| {
            let mut values = vec![-7.0; PIXELS];
            let camera = RaraCamera::from(camera(scene));
            let uploaded = ours.uploaded();
            let usual = room(RARA_AOV_DEPTH, &mut values);
            // SAFETY: the handles are alive, and the pointers are null, or point to what they say.
            let draw = |scene, camera: &RaraCamera, room: *const RaraChannels| unsafe {
                rara_renderer_channels(renderer, scene, camera, null(), null(), room)
            };
            for (room, says) in [
                (
                    RaraChannels { aovs: 0, ..usual },
                    "channels->aovs is 0x0: give one or more of the bits of RaraAovs, 0x1f for all",
                ),
                (RaraChannels { aovs: 33, ..usual }, "channels->aovs is 0x21"),
                (
                    RaraChannels { width: 60, ..usual },
                    "channels->width and height are 60x43, and the camera's 61x43",
                ),
                (
                    RaraChannels {
                        aovs: RARA_AOV_NORMAL,
                        ..usual
                    },
                    "channels->value_count is 2623, and such channels have 7869 numbers",
                ),
                (
                    RaraChannels {
                        width: u32::MAX,
                        height: u32::MAX,
                        ..usual
                    },
                    "more than memory holds",
                ),
                (
                    RaraChannels {
                        values: null_mut(),
                        ..usual
                    },
                    "channels->values is null",
                ),
                (
                    RaraChannels {
                        struct_size: 7,
                        ..usual
                    },
                    "channels->struct_size is 7",
                ),
            ] {
                assert_fails(draw(uploaded, &camera, &room), RARA_ERROR_INVALID, says);
            }
            assert_fails(
                draw(uploaded, &camera, null()),
                RARA_ERROR_INVALID,
                "channels is null",
            );
            assert_fails(
                draw(null_mut(), &camera, &usual),
                RARA_ERROR_INVALID,
                "scene is null",
            );
            let odd = RaraCamera {
                projection: 2,
                ..camera
            };
            assert_fails(
                draw(uploaded, &odd, &usual),
                RARA_ERROR_INVALID,
                "projection 2",
            );
            let mut made = usual;
            // SAFETY: the struct has the room that the call is given.
            let failed = unsafe { rara_channels_default(&mut made, size_of_val(&usual), 0, 1, 1) };
            assert_fails(failed, RARA_ERROR_INVALID, "channels->aovs is 0x0");
            assert!(values.iter().all(|value| *value == -7.0), "left alone");
            // SAFETY: nothing uses it any more.
            unsafe { rara_scene_buffers_destroy(uploaded) };
        });
    });
}
