//! Selections as layers: they change no picture by themselves, and each is hidden, faded and cut by itself.

use std::ptr::null;

use super::*;
use rara::clip::Expression;
use rara::scene::{Predicate, generate};
use rara::{Layer, LayerState};
use rara_c::clip::*;
use rara_c::layer::*;
use rara_c::selection::*;

/// Gaussians of which many are equally deep, whose order the picture shows.
fn in_heaps(count: usize) -> Gaussians {
    let mut made = generate(Kind::General, count, 5);
    for position in made.positions_mut() {
        *position = (*position * 3.0).round() / 3.0;
    }
    made
}

#[test]
fn selections_are_the_same_bytes() {
    with_saved(
        "c-frames-selections",
        &in_heaps(900),
        |scene, lent, device, ours| {
            let texts = [c"opacity>0.5 and not inside(sphere:0,0,0,0.6)", c"red>0.5"];
            let mut handles = vec![ours.gaussians];
            let whole = ours.uploaded();
            let mut part_of = vec![0_u32; scene.len()];
            for (number, text) in (1..).zip(texts) {
                let predicate: Predicate = text.to_str().expect("UTF-8").parse().expect("one");
                let taken = predicate
                    .select(scene, &[], &Placement::IDENTITY)
                    .expect("no property");
                for (part, taken) in part_of.iter_mut().zip(taken) {
                    *part = if taken && *part == 0 { number } else { *part };
                }
                let mut taken = null_mut();
                // SAFETY: the handle is alive, the text ends in NUL, the pointer may be overwritten.
                assert_ok(unsafe {
                    rara_gaussians_select(ours.gaussians, text.as_ptr(), null(), &mut taken)
                });
                handles.push(taken);
            }
            let parts = scene
                .clone()
                .into_parts(&part_of, handles.len())
                .expect("fits");
            assert!(parts.iter().all(|part| part.numbers.len() > 50));

            let cut = c"!cylinder:0,0,-1,0,0,1,0.7";
            let expression: Expression = cut.to_str().expect("UTF-8").parse().expect("a region");
            let shown = LayerState::default();
            let mut seen: Vec<Pixels> = Vec::new();
            for (states, is_cut) in [
                ([shown; 3], false),
                ([shown, shown.visible(false), shown.opacity(0.3)], false),
                ([shown, shown, shown.opacity(0.6)], true),
            ] {
                let made = parts
                    .iter()
                    .zip(states)
                    .enumerate()
                    .map(|(index, (part, state))| {
                        let layer = Layer::new("part", &part.gaussians).with(state);
                        let layer = layer.numbered(0, &part.numbers);
                        match is_cut && index == 1 {
                            true => layer.clipped(expression.clip()),
                            false => layer,
                        }
                    });
                let world = World {
                    layers: made.collect(),
                    ..World::new(scene, Raster::Tiles)
                };
                let canvas = world.canvas(lent, device);
                let truth = world.drawn(device, &canvas);
                let (mut uploaded, mut region) = (null_mut(), null_mut());
                // SAFETY: the handles are alive, and the pointers may be overwritten.
                unsafe {
                    assert_ok(rara_clip_parse(cut.as_ptr(), &mut region));
                    let states = states.map(RaraLayerState::from);
                    let layers: Vec<RaraLayer> = (0..handles.len())
                        .map(|index| {
                            let mut layer: RaraLayer = std::mem::zeroed();
                            let (size, name) = (size_of_val(&layer), c"part".as_ptr());
                            assert_ok(rara_layer_default(&mut layer, size, name, handles[index]));
                            layer.state = &states[index];
                            if is_cut && index == 1 {
                                layer.clip = region;
                            }
                            layer
                        })
                        .collect();
                    assert_ok(rara_scene_buffers_upload(
                        ours.device,
                        layers.as_ptr(),
                        layers.len(),
                        RARA_SH_FORMAT_PACKED,
                        &mut uploaded,
                    ));
                    rara_clip_destroy(region);
                    let drawn = world.drawn_in_c(ours.device, &canvas, |_| uploaded);
                    assert!(drawn == truth, "{states:?}");
                    if seen.is_empty() {
                        let of_whole = world.drawn_in_c(ours.device, &canvas, |_| whole);
                        assert!(drawn == of_whole, "a selection changes no picture");
                        let plain = parts.iter().map(|part| Layer::new("part", &part.gaussians));
                        let world = World {
                            layers: plain.collect(),
                            ..world
                        };
                        let plain = world.drawn(device, &canvas);
                        assert!(plain != truth, "the order of the layers would change it");
                    }
                    assert!(seen.iter().all(|before| *before != drawn));
                    seen.push(drawn);
                    rara_scene_buffers_destroy(uploaded);
                }
            }
            // SAFETY: all frames were waited for; the first handle is ended with the device.
            unsafe {
                rara_scene_buffers_destroy(whole);
                handles[1..]
                    .iter()
                    .for_each(|handle| rara_gaussians_destroy(*handle));
            }
        },
    );
}
