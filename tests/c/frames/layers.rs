//! Scenes of several layers, which are hidden, moved, faded and cut each by its own clip.

use std::cell::Cell;
use std::ffi::CStr;
use std::ptr::null;

use super::channels::with_renderer;
use super::ours::loaded_in_c;
use super::staged::staging;
use super::*;
use crate::clips::clip_of;
use crate::results::assert_fails;
use rara::{Clip, Layer, LayerState};
use rara_c::boundary::*;
use rara_c::editor::*;
use rara_c::layer::*;
use rara_c::layer_info::*;

const NAMES: [&CStr; 2] = [c"first", c"zweite \u{e4}"];

/// Two layers as rara.h has them.
fn layers_in_c(
    gaussians: [*mut RaraGaussians; 2],
    states: [*const RaraLayerState; 2],
) -> [RaraLayer; 2] {
    [0, 1].map(|index| {
        // SAFETY: the struct may hold any bytes, and has the room that the call is given.
        unsafe {
            let mut layer: RaraLayer = std::mem::zeroed();
            let (size, name) = (size_of_val(&layer), NAMES[index].as_ptr());
            assert_ok(rara_layer_default(&mut layer, size, name, gaussians[index]));
            layer.state = states[index];
            layer
        }
    })
}

#[test]
fn layers_are_the_same_bytes() {
    let own = Folder::new("c-frames-layers");
    let (path, other) = saved(&own, Kind::Strands, 1_300);
    with_both(2_100, |scene, lent, device, ours| {
        let gaussians = [ours.gaussians, loaded_in_c(&path)];
        let counts = [scene.len(), other.len()];
        let shown = LayerState::default();
        let turn = DQuat::from_xyzw(0.1, 0.3, -0.2, 0.9);
        let moved = Placement::new(DVec3::new(0.4, -0.2, 0.1), turn, 1.2).expect("possible");
        let faded = shown.placement(moved).opacity(0.35);
        let format = RARA_SH_FORMAT_PACKED;
        let mut uploaded = null_mut();
        // SAFETY: the layers are alive, the pointer may be overwritten.
        unsafe {
            let layers = layers_in_c(gaussians, [null(); 2]);
            assert_ok(rara_scene_buffers_upload(
                ours.device,
                layers.as_ptr(),
                layers.len(),
                format,
                &mut uploaded,
            ));
            assert_eq!(rara_scene_buffers_layer_count(uploaded), layers.len());
            for (index, count) in counts.into_iter().enumerate() {
                let mut info: RaraLayerInfo = std::mem::zeroed();
                let size = size_of_val(&info);
                let result = rara_scene_buffers_layer_info(uploaded, index, &mut info, size);
                assert_ok(result);
                assert_eq!((info.struct_size, info.count), (size, count as u64));
                assert_eq!(info.room, count as u64);
                assert_eq!(CStr::from_ptr(info.name), NAMES[index]);
            }
        }
        let mut seen: Vec<Pixels> = Vec::new();
        for (raster, states) in [
            (Raster::Tiles, [shown, shown]),
            (Raster::Tiles, [shown.visible(false), shown]),
            (Raster::Tiles, [shown, faded]),
            (Raster::Quad, [shown, faded]),
        ] {
            let names = NAMES.map(|name| name.to_str().expect("UTF-8"));
            let world = World {
                layers: Scene::from_iter([
                    Layer::new(names[0], scene).with(states[0]),
                    Layer::new(names[1], &other).with(states[1]),
                ]),
                ..World::new(scene, raster)
            };
            let canvas = world.canvas(lent, device);
            let truth = world.drawn(device, &canvas);
            let what = format!("{raster:?}, {states:?}");

            // The state is set in a scene that has been drawn in another state.
            let given = states.map(RaraLayerState::from);
            // SAFETY: the scene is alive, and nobody else uses it.
            unsafe {
                for (index, given) in given.iter().enumerate() {
                    assert_ok(rara_scene_buffers_set_layer_state(uploaded, index, given));
                    let mut state: RaraLayerState = std::mem::zeroed();
                    let size = size_of_val(&state);
                    let result = rara_scene_buffers_layer_state(uploaded, index, &mut state, size);
                    assert_ok(result);
                    assert_eq!(state, *given, "{what}");
                }
                let drawn = world.drawn_in_c(ours.device, &canvas, |_| uploaded);
                assert!(drawn == truth, "{what}");
            }

            // The scene is uploaded in that state, by the host's staging memory.
            let layers = layers_in_c(gaussians, given.each_ref().map(std::ptr::from_ref));
            let (list, count) = (layers.as_ptr(), layers.len());
            let (mut bytes, staged) = (0, Cell::new(null_mut()));
            // SAFETY: the handles and the memory are alive; the scene is when its frame has been waited for.
            unsafe {
                assert_ok(rara_scene_buffers_staging_bytes(
                    list, count, format, &mut bytes,
                ));
                let (_memory, staging) = staging(device, bytes);
                let drawn = world.drawn_in_c(ours.device, &canvas, |cmd| {
                    assert_ok(rara_scene_buffers_upload_with(
                        ours.device,
                        cmd,
                        &staging,
                        list,
                        count,
                        format,
                        staged.as_ptr(),
                    ));
                    staged.get()
                });
                assert!(drawn == truth, "{what}, staged");
                rara_scene_buffers_destroy(staged.get());
            }
            seen.push(truth);
        }
        assert!(seen[0] != seen[1] && seen[0] != seen[2] && seen[1] != seen[2]);

        // A clip without planes keeps a layer that the frame's clip would cut.
        let names = NAMES.map(|name| name.to_str().expect("UTF-8"));
        let world = World {
            layers: Scene::from_iter([
                Layer::new(names[0], scene),
                Layer::new(names[1], &other).clipped(Clip::default()),
            ]),
            ..World::new(scene, Raster::Tiles)
        };
        let canvas = world.canvas(lent, device);
        let truth = world.drawn(device, &canvas);
        assert!(truth != seen[0], "the frame's clip cuts it otherwise");
        let whole = clip_of(&[]);
        // SAFETY: as above.
        unsafe {
            let given = RaraLayerState::from(shown);
            for index in 0..2 {
                assert_ok(rara_scene_buffers_set_layer_state(uploaded, index, &given));
            }
            assert_ok(rara_scene_buffers_set_layer_clip(uploaded, 1, whole));
            let drawn = world.drawn_in_c(ours.device, &canvas, |_| uploaded);
            assert!(drawn == truth, "a clip of its own");
            assert_ok(rara_scene_buffers_set_layer_clip(uploaded, 1, null()));
            let drawn = world.drawn_in_c(ours.device, &canvas, |_| uploaded);
            assert!(drawn == seen[0], "the frame's clip again");
        }
        // SAFETY: all frames were waited for.
        unsafe {
            rara_scene_buffers_destroy(uploaded);
            rara_gaussians_destroy(gaussians[1]);
        }
    });
}

#[test]
fn an_edited_layer_is_the_same_bytes() {
    with_both(2_300, |scene, lent, device, ours| {
        let (first, count) = (300_u32, 700_u32);
        let mut faded = scene.clone();
        let range = first as usize..(first + count) as usize;
        faded.opacities_mut()[range.clone()].fill(0.25);
        let world = World::new(scene, Raster::Tiles);
        let canvas = world.canvas(lent, device);
        let before = world.drawn(device, &canvas);
        let world = World {
            layers: (&faded).into(),
            ..world
        };
        let truth = world.drawn(device, &canvas);
        assert!(truth != before, "the edit shows");
        let plain = vec![
            RaraPlainGaussian {
                opacity: 0.25,
                ..Default::default()
            };
            range.len()
        ];
        let size = size_of_val(&plain[..]);
        let (memory, staging) = staging(device, size as u64);
        let uploaded = ours.uploaded();
        with_renderer(ours.device, |renderer| {
            // SAFETY: the handles and the memory are alive until the frame has been waited for, and the structs may hold any bytes.
            unsafe {
                let from = plain.as_ptr().cast::<u8>();
                staging
                    .mapped
                    .cast::<u8>()
                    .copy_from_nonoverlapping(from, size);
                let mut editor = null_mut();
                let made = rara_layer_editor_create(renderer, uploaded, count, &mut editor);
                assert_ok(made);
                assert_eq!(rara_layer_editor_bytes(editor), size as u64);
                let mut edit: RaraLayerEdit = std::mem::zeroed();
                let edit_size = size_of_val(&edit);
                assert_ok(rara_layer_edit_default(&mut edit, edit_size));
                (edit.first, edit.opacities) = (first, vk::TRUE);
                let drawn = world.drawn_in_c(ours.device, &canvas, |cmd| {
                    let copy = vk::BufferCopy::default().src_offset(staging.offset);
                    let copy = [copy.size(size as u64)];
                    let buffer = rara_layer_editor_buffer(editor);
                    let raw = device.raw();
                    raw.cmd_copy_buffer(cmd, memory.handle(), buffer, &copy);
                    let record = |count| {
                        let edit = RaraLayerEdit { count, ..edit };
                        rara_layer_editor_record(editor, cmd, uploaded, 0, &edit)
                    };
                    assert_fails(record(count + 1), RARA_ERROR_INVALID, "this one is for 700");
                    assert_ok(record(count));
                    uploaded
                });
                assert!(drawn == truth);
                rara_layer_editor_destroy(editor);
            }
        });
        // SAFETY: all frames were waited for.
        unsafe { rara_scene_buffers_destroy(uploaded) };
    });
}
