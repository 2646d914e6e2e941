//! A scene in parts is drawn as the scene, in layers that may be empty, and what is no layer is refused.

use super::*;
use rara::clip::Expression;
use rara::scene::Bounds;

#[test]
fn layers_are_drawn_as_the_scene_that_they_are_parts_of() {
    let (scene, parts) = in_parts(6_000);
    let layers = named(parts.iter().map(|part| (part, LayerState::default())));
    let mut whole = common::headless();
    let mut layered = whole.sharing().expect("another renderer");
    whole.load(&scene).expect("uploads");
    layered.load(layers.clone()).expect("uploads");
    let names: Vec<_> = layered
        .layers()
        .iter()
        .map(|l| l.name().to_owned())
        .collect();
    assert_eq!(names[1], "layer 1");
    assert_eq!(layered.layer_index("layer 1").expect("is there"), 1);
    let error = layered.layer_index("skin").expect_err("no layer");
    let says = "no layer is called 'skin'; there are 'layer 0', 'layer 1', ";
    assert!(error.to_string().starts_with(says), "{error}");
    for camera in common::views(&scene, 2, common::scaled(SIZE)) {
        for raster in common::rasters(whole.device()) {
            for (mode, planes, op) in [
                (Mode::None, 0, ClipOp::And),
                (Mode::Hard, 1, ClipOp::And),
                (Mode::Rara, 2, ClipOp::Or),
                (Mode::Exact, 1, ClipOp::And),
                (Mode::Exact, 3, ClipOp::Or),
            ] {
                let clip = common::clip(&scene, planes, op);
                let settings = Settings::default().mode(mode).raster(raster);
                let counts = [&mut whole, &mut layered].map(|headless| {
                    headless
                        .render(&camera, &clip, &settings)
                        .expect("renders")
                        .counts
                });
                assert_eq!(counts[0], counts[1], "{raster:?}, {mode:?}");
                assert!(
                    picture(&mut whole) == picture(&mut layered),
                    "{raster:?}, {mode:?}"
                );
            }
        }
    }
    drop(layered);
    whole.close().expect("nothing to say");
}

/// Layers store their harmonics at the highest degree of any, in every format.
#[test]
fn layers_of_different_degrees_keep_their_colours() {
    let (scene, mut parts) = in_parts(2_000);
    for (index, part) in parts.iter_mut().enumerate() {
        part.set_sh_degree([3, 0, 1, 2][index % 4]);
    }
    let layers = named(parts.iter().map(|part| (part, LayerState::default())));
    let camera = common::views(&scene, 1, common::scaled((125, 95)))[0];
    let (clip, settings) = (Clip::default(), Settings::default());
    let truth = rara_reference::render::<f64>(&layers, &camera, &clip, &settings).picture;
    let mut headless = common::headless();
    for (format, least) in [
        (rara::ShFormat::Float, 60.0),
        (rara::ShFormat::Half, 50.0),
        (rara::ShFormat::Packed, 45.0),
        (rara::ShFormat::Byte, 40.0),
    ] {
        headless.load_as(&layers, format).expect("uploads");
        headless.render(&camera, &clip, &settings).expect("renders");
        let apart =
            rara_lab::measure::differences(&picture(&mut headless), &truth).expect("one size");
        assert!(apart.psnr >= least, "{format:?}: {apart:?}");
    }
    headless.close().expect("nothing to say");
}

/// Layers without Gaussians, wherever they stand among the others, and the last block of each no fuller than it is.
#[test]
fn layers_may_be_empty() {
    let (_, scene) = common::generated_scenes(300).remove(0);
    let none = Gaussians::default();
    let camera = common::views(&scene, 1, common::scaled((97, 61)))[0];
    let clip = common::clip(&scene, 1, ClipOp::And);
    let mut headless = common::headless();
    let mut draw = |scene: Scene<'_>, format| {
        headless.load_as(scene, format).expect("uploads");
        let stats = headless
            .render(&camera, &clip, &Settings::default())
            .expect("renders");
        (stats.counts, picture(&mut headless))
    };
    for format in [rara::ShFormat::Float, rara::ShFormat::Packed] {
        let alone = draw((&scene).into(), format);
        assert!(alone.0.drawn > 50, "{:?}", alone.0);
        for order in [
            [&scene, &none, &none],
            [&none, &scene, &none],
            [&none, &none, &scene],
        ] {
            let layers = order.map(|part| (part, LayerState::default()));
            assert!(draw(named(layers), format) == alone, "{format:?}");
        }
        let empty = draw(named([(&none, LayerState::default()); 2]), format);
        assert_eq!(empty.0, rara::Counts::default());
    }
    headless.close().expect("nothing to say");
}

#[test]
fn what_is_no_layer_is_refused() {
    let part = Gaussians::default();
    let mut headless = common::headless();
    let error = headless.load(Scene::default()).expect_err("no layer");
    assert!(error.to_string().contains("at least one layer"), "{error}");
    for opacity in [-0.1, 1.5, f32::NAN] {
        let state = LayerState::default().opacity(opacity);
        let error = headless
            .load(named([(&part, state)]))
            .expect_err("no opacity");
        let text = error.to_string();
        assert!(
            text.contains("'layer 0'") && text.contains("give 0 to 1"),
            "{text}"
        );
    }
    headless
        .load(named([(&part, LayerState::default())]))
        .expect("uploads");
    let state = LayerState::default();
    for state in [state.opacity(2.0), state.opacity(f32::NAN)] {
        let error = headless.set_layer_state(0, state).expect_err("no opacity");
        assert!(error.to_string().contains("'layer 0'"), "{error}");
    }
    let error = headless.set_layer_state(1, state).expect_err("no layer");
    assert!(error.to_string().contains("the scene has 1"), "{error}");
    let plane = rara::Plane::new(DVec3::X, 0.0).expect("a plane");
    let error = headless.set_layer_clip(0, Some(Clip::of(vec![plane; 65_537], ClipOp::And)));
    let error = error.expect_err("too many surfaces").to_string();
    assert!(
        error.contains("'layer 0'") && error.contains("65537 surfaces"),
        "{error}"
    );
    let far = Placement::new(DVec3::ZERO, DQuat::IDENTITY, 1e39).expect("a placement");
    let error = headless.set_layer_state(0, state.placement(far));
    assert!(error.expect_err("no scale").to_string().contains("1e39"));
    assert_eq!(
        headless.layers()[0].state(),
        state,
        "what is refused changes nothing"
    );
    // A scene that is refused leaves the one before it.
    headless.load(Scene::default()).expect_err("no layer");
    assert_eq!(headless.layers().len(), 1);
    headless.close().expect("nothing to say");
}

/// Curved surfaces are packed relative to each layer, so that a clip is as exact in one that is far from the others.
#[test]
fn layers_far_apart_are_cut_alike() {
    let (_, near) = common::generated_scenes(2_000).remove(0);
    let away = DVec3::new(3e4, -1e4, 2e4);
    let mut far = near.clone();
    let lost = far.place(&Placement::new(away, DQuat::IDENTITY, 1.0).expect("a place"));
    assert!(lost.is_empty());
    let middle = Bounds::of(&far).centre();
    let ball = |radius: f64| format!("sphere:{},{},{},{radius}", middle.x, middle.y, middle.z);
    let text = format!(
        "any({}, all({}, plane:0,0,1,{}))",
        ball(0.4),
        ball(0.7),
        -middle.z
    );
    let clip = text.parse::<Expression>().expect("an expression").clip();
    let mut headless = common::headless();
    let camera = common::views(&far, 1, common::scaled(SIZE))[0];
    let mut draw = |scene: Scene<'_>| {
        headless.load(scene).expect("uploads");
        headless
            .render(&camera, &clip, &Settings::default())
            .expect("renders");
        headless.picture().expect("reads back")
    };
    let alone = draw(named([(&far, LayerState::default())]));
    let behind = draw(named(
        [&near, &far].map(|part| (part, LayerState::default())),
    ));
    assert!(
        alone == behind,
        "the near layer is not in view, and changes nothing"
    );
    let truth =
        rara_reference::render::<f64>(&Scene::from(&far), &camera, &clip, &Settings::default());
    common::assert_agrees("far away", &behind, &truth.picture);
}
