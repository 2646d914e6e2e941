//! Layers that are hidden and changed from frame to frame.

use super::*;

#[test]
fn a_hidden_layer_is_not_there() {
    let (scene, parts) = in_parts(6_000);
    let hidden = LayerState::default().visible(false);
    let all = named(parts.iter().map(|part| (part, LayerState::default())));
    let mut headless = common::headless();
    headless.load(all).expect("uploads");
    headless.set_layer_state(5, hidden).expect("a layer");
    let mut rest = headless.sharing().expect("another renderer");
    let without = named(parts[..5].iter().map(|part| (part, LayerState::default())));
    rest.load(without).expect("uploads");
    let camera = common::views(&scene, 1, common::scaled(SIZE))[0];
    for (mode, planes) in [(Mode::None, 0), (Mode::Exact, 1)] {
        let clip = common::clip(&scene, planes, ClipOp::And);
        let settings = Settings::default().mode(mode);
        let [ours, theirs] = [&mut headless, &mut rest].map(|headless| {
            headless
                .render(&camera, &clip, &settings)
                .expect("renders")
                .counts
        });
        assert!(picture(&mut headless) == picture(&mut rest), "{mode:?}");
        let gone = parts[5].len() as u32;
        assert_eq!(ours.culled, theirs.culled + gone);
        assert_eq!((ours.visible, ours.cutoff), (theirs.visible, theirs.cutoff));
        // Its blocks are settled as a whole: none of its Gaussians is tested.
        let sides = headless.working_buffer("block_sides").expect("a buffer");
        let sides: &[u32] = bytemuck::cast_slice(&sides);
        let blocks = |parts: &[Gaussians]| -> usize {
            parts.iter().map(|part| part.len().div_ceil(256)).sum()
        };
        let hidden = &sides[blocks(&parts[..5])..blocks(&parts)];
        assert!(hidden.iter().all(|&side| side == 0), "{mode:?}: {sides:?}");
    }
    drop(rest);
    headless.close().expect("nothing to say");
}

/// Whatever a frame takes over from the one before, its bytes are those of a whole frame.
#[test]
fn layers_that_change_leave_nothing_behind() {
    let (scene, parts) = in_parts(3_000);
    let layers = named(parts.iter().map(|part| (part, LayerState::default())));
    let mut keeps = common::headless();
    let mut forgets = keeps.sharing().expect("another renderer");
    keeps.load(layers.clone()).expect("uploads");
    forgets.load(layers).expect("uploads");
    let mut pick = common::picker(5);
    let cameras = common::views(&scene, 2, common::scaled((125, 95)));
    let (mut camera, mut shift, mut settings) = (0, 0.0, Settings::default());
    let (mut seen, mut changes, mut reused) = (None, 0, [0; 3]);
    for _ in 0..90 {
        match pick(9) {
            0 => camera = pick(2),
            1 => settings.mode = [Mode::Exact, Mode::Hard, Mode::Rara, Mode::None][pick(4)],
            2 => shift = [0.0, 0.1, -0.1][pick(3)],
            kind => {
                let layer = pick(parts.len());
                let value = pick(3);
                let own = common::clip(&scene, 1 + value, [ClipOp::And, ClipOp::Or][layer % 2]);
                for headless in [&mut keeps, &mut forgets] {
                    let state = headless.layers()[layer].state();
                    let placements = [Placement::IDENTITY, elsewhere(1.0), elsewhere(0.5)];
                    let changed = match kind {
                        8 => headless.set_layer_clip(layer, (value > 0).then(|| own.clone())),
                        3 => headless.set_layer_state(layer, state.opacity([1.0, 0.5, 0.0][value])),
                        4 | 5 => headless.set_layer_state(layer, state.visible(value > 0)),
                        _ => headless.set_layer_state(layer, state.placement(placements[value])),
                    };
                    changed.expect("a layer");
                }
            }
        }
        let clip = common::moved(common::clip(&scene, 2, ClipOp::And), shift);
        forgets.forget();
        let [ours, theirs] = [&mut keeps, &mut forgets].map(|headless| {
            let drawn = headless.render(&cameras[camera], &clip, &settings);
            (drawn.expect("renders").skipped, picture(headless))
        });
        let ((skipped, ours), (_, theirs)) = (ours, theirs);
        assert!(ours == theirs, "{settings:?}");
        let skips = |stage| skipped.contains(&stage);
        reused[0] += usize::from(skips("project") && !skips("recut"));
        reused[1] += usize::from(!skips("project") && skips("clip"));
        reused[2] += usize::from(skips("project") && skips("tiles"));
        changes += usize::from(seen.as_ref() != Some(&ours));
        seen = Some(ours);
    }
    assert!(
        changes > 25,
        "only {changes} of 90 frames were another picture"
    );
    // Frames whose clip alone has moved, that find the view anew with the sides that there are, and that change nothing.
    assert!(reused.iter().all(|&frames| frames > 2), "{reused:?}");
    drop(forgets);
    keeps.close().expect("nothing to say");
}

/// With all layers hidden a frame shows nothing, whatever it takes over, and then shows again what it did.
#[test]
fn all_layers_may_be_hidden() {
    let (scene, parts) = in_parts(2_000);
    let layers = named(parts.iter().map(|part| (part, LayerState::default())));
    let mut headless = common::headless();
    headless.load(&layers).expect("uploads");
    let camera = common::views(&scene, 1, common::scaled((125, 95)))[0];
    let clips = [0.0, 0.1].map(|by| common::moved(common::clip(&scene, 1, ClipOp::And), by));
    let mut draw = |visible: Option<bool>, clip| {
        for index in 0..visible.map_or(0, |_| parts.len()) {
            let state = LayerState::default().visible(visible == Some(true));
            headless.set_layer_state(index, state).expect("a layer");
        }
        let drawn = headless.render(&camera, clip, &Settings::default());
        (drawn.expect("renders").counts, picture(&mut headless))
    };
    let shown = draw(None, &clips[0]);
    assert!(shown.0.cutoff > 10, "{:?}", shown.0);
    // A whole frame, one whose clip alone has moved, and one in which nothing has changed.
    for (visible, clip) in [(Some(false), 0), (None, 1), (None, 1)] {
        let (counts, picture) = draw(visible, &clips[clip]);
        assert_eq!((counts.drawn, counts.culled as usize), (0, scene.len()));
        assert!(picture.pixels.iter().all(|pixel| *pixel == [0.0; 4]));
    }
    assert!(draw(Some(true), &clips[0]) == shown);
    headless.close().expect("nothing to say");
}
