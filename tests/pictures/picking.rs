//! Picks: the Gaussian that a pixel shows most of, as the reference finds it, in the whole picture and in parts of it.

use ash::vk;
use rara::glam::{DQuat, DVec3};
use rara::scene::{Bounds, Kind, generate};
use rara::{
    Camera, Clip, ClipOp, Gaussians, Headless, Layer, LayerState, Mode, Pick, PickTicket, Picker,
    Picks, Picture, Placement, Renderer, RendererDesc, Scene, Settings, Show,
};

use crate::common;

fn rect(x: i32, y: i32, width: u32, height: u32) -> vk::Rect2D {
    vk::Rect2D {
        offset: vk::Offset2D { x, y },
        extent: vk::Extent2D { width, height },
    }
}

/// Compares picks with the reference's picture of them, and returns in how many pixels another splat is the strongest.
fn differing(picks: &Picks, truth: &Picture) -> usize {
    let (left, top) = (picks.rect.offset.x as u32, picks.rect.offset.y as u32);
    let mut others = 0;
    for y in 0..picks.rect.extent.height {
        for x in 0..picks.rect.extent.width {
            let at = ((top + y) * truth.width + left + x) as usize;
            let [low, high, layer, alpha] = truth.pixels[at];
            let number = low as u32 + 65536 * high as u32;
            let pick = picks.at(left + x, top + y);
            let found = pick.map_or(0.0, |pick| pick.alpha);
            // Where two splats add the same, rounding decides between them, and not over what they add.
            let (least, rounding) = (1.0 / 255.0, 2e-3);
            let shows = if alpha < least { 0.0 } else { alpha };
            let is_faint = (alpha - least).abs() < rounding;
            assert!(
                (found - shows).abs() < rounding || is_faint,
                "pixel {x}, {y}: {pick:?}, {number} adds {alpha}"
            );
            let is_same = pick.map_or(shows == 0.0, |pick| {
                (pick.number, pick.layer) == (number, layer as usize)
            });
            others += usize::from(!is_same && !is_faint);
        }
    }
    others
}

/// The same picks, but for the rounding of pipelines that reach their buffers in another way.
fn assert_alike(picks: &Picks, expected: &Picks) {
    assert_eq!(picks.rect, expected.rect);
    assert_eq!(picks.pixels.len(), expected.pixels.len());
    for (found, expected) in picks.pixels.iter().zip(&expected.pixels) {
        let of = |pick: &Option<Pick>| pick.map(|pick| (pick.number, pick.layer));
        assert_eq!(of(found), of(expected));
        let alpha = |pick: &Option<Pick>| pick.map_or(0.0, |pick| pick.alpha);
        assert!((alpha(found) - alpha(expected)).abs() < 1e-6);
    }
}

#[test]
fn pixels_show_most_of_what_the_reference_says() {
    let mut headless = common::headless();
    let scene = generate(Kind::General, 3_000, 5);
    let outside = common::views(&scene, 3, common::scaled((120, 90)))[1];
    let size = (outside.width, outside.height);
    // From within, splats that reach into a part have their centres far outside of it.
    let centre = Bounds::of(&scene).centre();
    let within = Camera::look_at(centre, outside.eye, -DVec3::Y, 80.0, size).expect("a view");
    let flat = common::flattened(&outside, &scene);
    headless.load(&scene).expect("uploads");
    for (camera, mode, planes) in [
        (outside, Mode::None, 0),
        (outside, Mode::Hard, 1),
        (outside, Mode::Rara, 1),
        (outside, Mode::Exact, 1),
        (outside, Mode::Exact, 3),
        (within, Mode::None, 0),
        (within, Mode::Exact, 1),
        (flat, Mode::Exact, 1),
    ] {
        let clip = common::clip(&scene, planes, ClipOp::And);
        let settings = Settings::default().mode(mode);
        let strongest = settings.show(Show::Strongest);
        let truth = rara_reference::render::<f64>(&scene, &camera, &clip, &strongest).picture;
        let whole = headless
            .pick(&camera, &clip, &settings, rect(0, 0, size.0, size.1))
            .expect("picks");
        let others = differing(&whole, &truth);
        let shown = whole.pixels.iter().flatten().count();
        assert!(
            shown > whole.pixels.len() / 8,
            "{shown} pixels show anything"
        );
        assert!(
            others * 500 <= shown,
            "{mode:?}: {others} of {shown} differ"
        );
        // A part of the picture is that part, also where it begins within a tile and ends at the picture's edge.
        let (width, height) = (size.0 as i32, size.1 as i32);
        for part in [
            rect(31, 17, 23, 30),
            rect(width / 2, height / 2, 1, 1),
            rect(width - 9, height - 5, 9, 5),
        ] {
            let picks = headless
                .pick(&camera, &clip, &settings, part)
                .expect("picks");
            assert_eq!(
                picks.pixels.len() as u32,
                part.extent.width * part.extent.height
            );
            let others = differing(&picks, &truth);
            assert!(others * 100 <= picks.pixels.len(), "{part:?}: {others}");
        }
    }
    headless.close().expect("no validation messages");
}

/// Numbers run on from layer to layer, and a layer that is hidden, moved or clipped away is picked where it is then.
#[test]
fn layers_are_picked_where_they_are_shown() {
    let mut headless = common::headless();
    let (near, far) = (
        generate(Kind::Layers, 800, 1),
        generate(Kind::General, 900, 2),
    );
    let camera = common::views(&near, 2, (64, 48))[0];
    let (settings, everywhere) = (Settings::default(), rect(0, 0, 64, 48));
    let strongest = settings.show(Show::Strongest);
    let usual = LayerState::default();
    let moved = Placement::new(DVec3::new(0.3, -0.2, 0.1), DQuat::from_rotation_y(0.7), 0.6);
    let moved = usual.placement(moved.expect("possible"));
    let half = common::clip(&near, 1, ClipOp::And);
    let layers = [Layer::new("near", &near), Layer::new("far", &far)];
    headless
        .load(Scene::from_iter(layers.clone()))
        .expect("uploads");
    let mut seen: Vec<Vec<Pick>> = Vec::new();
    for (state, own) in [
        (usual, None),
        (moved, None),
        (usual, Some(half)),
        (usual.visible(false), None),
    ] {
        headless.set_layer_state(0, state).expect("a state");
        headless.set_layer_clip(0, own.clone()).expect("a clip");
        let mut first = layers[0].clone().with(state);
        if let Some(own) = own {
            first = first.clipped(own);
        }
        let scene = Scene::from_iter([first, layers[1].clone()]);
        let truth = rara_reference::render::<f64>(scene, &camera, &Clip::default(), &strongest);
        let picks = headless.pick(&camera, &Clip::default(), &settings, everywhere);
        let picks = picks.expect("picks");
        assert!(differing(&picks, &truth.picture) < 16);
        let all = picks.gaussians();
        for pick in &all {
            assert_eq!(pick.layer, usize::from(pick.number >= 800), "{pick:?}");
        }
        assert_eq!(all.iter().any(|pick| pick.layer == 0), state.visible);
        assert!(all.iter().any(|pick| pick.layer == 1));
        assert!(!seen.contains(&all), "another state shows others");
        seen.push(all);
    }
    headless.close().expect("no validation messages");
}

/// A picker beside a renderer that draws a scene elsewhere finds it there, and nothing in an empty scene.
#[test]
fn scenes_are_picked_where_the_renderer_places_them() {
    let mut headless = common::headless();
    let scene = generate(Kind::General, 900, 4);
    let camera = common::views(&scene, 3, (64, 48))[0];
    let (clip, settings) = (Clip::default(), Settings::default());
    let everywhere = rect(0, 0, 64, 48);
    let placed = Placement::new(DVec3::new(0.2, 0.1, -0.3), DQuat::from_rotation_z(0.5), 0.8);
    let placed = placed.expect("possible");
    let state = LayerState::default().placement(placed);
    let layer = Layer::new("placed", &scene).with(state);
    headless.load(Scene::from_iter([layer])).expect("uploads");
    let expected = headless.pick(&camera, &clip, &settings, everywhere);
    let expected = expected.expect("picks");
    let device = headless.device().clone();
    let mut renderer =
        Renderer::new(&device, RendererDesc::new(vk::Format::R8G8B8A8_UNORM)).expect("a renderer");
    renderer.set_placement(placed);
    let mut beside = Headless::beside(&renderer).expect("beside");
    beside.load(&scene).expect("uploads");
    let found = beside
        .pick(&camera, &clip, &settings, everywhere)
        .expect("picks");
    let same = found.pixels.iter().zip(&expected.pixels);
    let same = same
        .filter(|(a, b)| a.map(|a| a.number) == b.map(|b| b.number))
        .count();
    assert!(same + 16 > found.pixels.len(), "{same}"); // it is rounded in another space
    let shown = found.pixels.iter().flatten().count();
    assert!(shown > 300, "{shown}");
    beside.load(&Gaussians::default()).expect("uploads");
    let nothing = beside
        .pick(&camera, &clip, &settings, everywhere)
        .expect("picks");
    assert_eq!(nothing.strongest(), None);
    drop((beside, renderer, device));
    headless.close().expect("no validation messages");
}

/// A host records requests beside its frames and reads them when these are finished; no request disturbs another.
#[test]
fn requests_in_flight_have_answers_of_their_own() {
    let mut headless = common::headless();
    let scene = generate(Kind::General, 2_000, 9);
    let camera = common::views(&scene, 3, (96, 64))[2];
    let clip = common::clip(&scene, 1, ClipOp::And);
    let settings = Settings::default();
    headless.load(&scene).expect("uploads");
    let parts = [rect(10, 10, 40, 20), rect(50, 30, 1, 1), rect(0, 0, 96, 64)];
    let expected = parts.map(|part| {
        let picks = headless.pick(&camera, &clip, &settings, part);
        picks.expect("picks")
    });
    let device = headless.device().clone();
    let buffers = rara::SceneBuffers::upload(&device, &scene, rara::ShFormat::Float);
    let buffers = buffers.expect("uploads");
    let renderer = Renderer::new(&device, RendererDesc::new(vk::Format::R8G8B8A8_UNORM));
    let mut picker = Picker::new(&renderer.expect("a renderer"), 2).expect("a picker");
    let ask = |picker: &mut Picker, parts: &[vk::Rect2D]| -> Vec<PickTicket> {
        let mut tickets = Vec::new();
        let asked = device.submit_and_wait(|cmd| {
            for part in parts {
                // SAFETY: `cmd` is recording outside a rendering scope, no more than two requests are unfinished, and scene and
                // picker outlive the wait.
                let ticket =
                    unsafe { picker.record(cmd, &buffers, &camera, &clip, &settings, *part) };
                tickets.push(ticket?);
            }
            Ok(())
        });
        asked.expect("submits");
        tickets
    };
    for _ in 0..3 {
        for pair in [[0, 1], [1, 2], [2, 0]] {
            let tickets = ask(&mut picker, &pair.map(|at| parts[at]));
            for (ticket, at) in tickets.iter().zip(pair) {
                // SAFETY: the submission was waited for.
                let picks = unsafe { picker.read(*ticket) }.expect("it is held");
                assert_alike(&picks, &expected[at]);
            }
        }
    }
    let last = ask(&mut picker, &parts[..1]);
    // SAFETY: the submission was waited for.
    let held = unsafe { picker.read(last[0]) }.expect("it is held");
    assert_alike(&held, &expected[0]);
    ask(&mut picker, &parts[1..]);
    // SAFETY: all submissions were waited for.
    let gone = unsafe { picker.read(last[0]) }.expect_err("two others have its memory");
    assert!(gone.to_string().contains("a later one has taken"), "{gone}");
    let outside = rect(90, 0, 7, 1);
    let refused = headless.pick(&camera, &clip, &settings, outside);
    let text = refused.expect_err("it reaches out").to_string();
    assert!(
        text.contains("is not inside the picture of 96x64 px"),
        "{text}"
    );
    drop((picker, buffers));
    drop(device);
    headless.close().expect("no validation messages");
}
