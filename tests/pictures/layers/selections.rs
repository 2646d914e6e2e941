//! A selection divides a set of Gaussians into layers, and no picture shows it, however many are equally deep.

use super::*;
use rara::Preset;
use rara::gpu::{Bindings, DeviceShape};
use rara::scene::{Part, Predicate};

/// A scene in which hundreds of Gaussians share each depth, seen from `camera`.
fn in_sheets() -> (Gaussians, rara::Camera) {
    let (_, mut scene) = common::generated_scenes(6_000).remove(0);
    for position in scene.positions_mut() {
        position.z = (position.z * 4.0).round() / 4.0;
    }
    // The depth along z is the z of the scene plus a power of two, to the bit.
    let eye = DVec3::new(0.1, -0.2, -4.0);
    let target = DVec3::new(0.1, -0.2, 0.0);
    let size = common::scaled(SIZE);
    let camera = rara::Camera::look_at(eye, target, DVec3::NEG_Y, 50.0, size).expect("a view");
    (scene, camera)
}

fn divided(scene: &Gaussians, predicate: &str) -> [Part; 2] {
    let predicate: Predicate = predicate.parse().expect("a predicate");
    let parts = predicate.split(scene.clone(), &[]).expect("splits");
    assert!(
        parts.iter().all(|part| part.numbers.len() > 300),
        "{predicate}"
    );
    parts
}

fn layers(parts: &[Part; 2]) -> Scene<'_> {
    let layers = ["rest", "taken"].into_iter().zip(parts);
    layers
        .map(|(name, part)| Layer::new(name, &part.gaussians).numbered(0, &part.numbers))
        .collect()
}

#[test]
fn selections_change_no_picture() {
    let (scene, camera) = in_sheets();
    let round: rara::Shape = "sphere:0.2,0,0,0.7".parse().expect("a shape");
    let frames = [
        (Clip::default(), Preset::Balanced, 32),
        (Clip::default(), Preset::Fast, 8),
        (common::clip(&scene, 2, ClipOp::Or), Preset::Exact, 32),
        (round.clip(), Preset::Balanced, 24),
    ];
    for shape in [DeviceShape::Cpu, DeviceShape::Gpu { subgroup: 0 }] {
        let open = || common::headless_shaped(Bindings::Mixed, shape);
        let (mut whole, mut layered) = (open(), open());
        whole.load(&scene).expect("uploads");
        for predicate in ["size>0.03", "inside(sphere:0,0,0,0.6) or opacity<0.2"] {
            let parts = divided(&scene, predicate);
            layered.load(layers(&parts)).expect("uploads");
            for (clip, preset, bits) in &frames {
                let precision = preset.precision().key_bits(*bits);
                let settings = Settings::default().precision(precision);
                let counts = [&mut whole, &mut layered].map(|headless| {
                    let stats = headless.render(&camera, clip, &settings);
                    stats.expect("renders").counts
                });
                assert_eq!(counts[0], counts[1]);
                assert!(
                    picture(&mut whole) == picture(&mut layered),
                    "{shape:?}, {predicate}, {preset:?}, {clip:?}"
                );
            }
        }
        // Numbered as if each were a scene by itself, the parts of a sheet lie one behind the other.
        let parts = divided(&scene, "size>0.03");
        let unnumbered = named(parts.iter().map(|p| (&p.gaussians, LayerState::default())));
        layered.load(unnumbered).expect("uploads");
        for headless in [&mut whole, &mut layered] {
            let stats = headless.render(&camera, &Clip::default(), &Settings::default());
            stats.expect("renders");
        }
        assert!(picture(&mut whole) != picture(&mut layered), "no ties");
        whole.close().expect("nothing to say");
        layered.close().expect("nothing to say");
    }
}

/// Two files, of which both are divided: the numbers of the second follow on those of the first.
#[test]
fn every_file_can_be_divided() {
    let (scene, camera) = in_sheets();
    let count = scene.len() as u32;
    let all = Scene::from_iter([Layer::new("a", &scene), Layer::new("b", &scene)]);
    let (first, second) = (divided(&scene, "size>0.03"), divided(&scene, "opacity>0.5"));
    let of = |set, part| -> Layer<'_> {
        let (parts, before): (&[Part; 2], u32) = [(&first, 0), (&second, count)][set];
        let part: &Part = &parts[part];
        Layer::new("part", &part.gaussians).numbered(before, &part.numbers)
    };
    let layers = Scene::from_iter([of(1, 1), of(0, 0), of(1, 0), of(0, 1)]);
    let (clip, settings) = (Clip::default(), Settings::default());
    let mut headless = common::headless();
    let pictures = [&all, &layers].map(|scene| {
        headless.load(scene).expect("uploads");
        headless.render(&camera, &clip, &settings).expect("renders");
        picture(&mut headless)
    });
    assert!(pictures[0] == pictures[1]);
    let bounds: Vec<_> = headless
        .layers()
        .iter()
        .map(|layer| layer.bounds())
        .collect();
    let alone = rara::Bounds::of(&second[1].gaussians);
    let own = bounds[0].expect("Gaussians");
    assert!(
        own.max.x >= alone.max.x - 0.1 && bounds[0] != bounds[2],
        "a layer's bounds are its own"
    );
    headless.close().expect("nothing to say");

    // The twin has the same order.
    let drawn =
        |scene: &Scene<'_>| rara_reference::render::<f32>(scene, &camera, &clip, &settings).picture;
    assert!(drawn(&all) == drawn(&layers));
    let depths = |scene: &Scene<'_>| {
        rara_reference::depth::expected::<f32>(scene, &camera, &clip, &settings)
    };
    assert!(depths(&all) == depths(&layers));

    let missing = Scene::from_iter([of(0, 0), of(1, 0), of(1, 1)]);
    let mut headless = common::headless();
    let error = headless
        .load(missing)
        .expect_err("a part is missing")
        .to_string();
    assert!(error.contains("give all parts of each"), "{error}");
    headless.close().expect("nothing to say");
}
