use super::*;
use crate::viewer::cut::ClipEditor;
use glam::DVec3;
use rara::{ClipOp, PassTime};

fn clips(shapes: &[&str]) -> Clips {
    let shapes = shapes.iter().map(|text| text.parse().unwrap()).collect();
    Clips::new(
        ClipEditor::new(shapes, ClipOp::And, DVec3::ZERO),
        &[],
        DVec3::ZERO,
    )
}

fn seen<'a>(clips: &'a Clips, size: (u32, u32)) -> OverlayScene<'a> {
    OverlayScene {
        clips: Some(clips),
        mode: Mode::Exact,
        stats: None,
        progress: None,
        size,
        scale_factor: 1.0,
    }
}

#[test]
fn the_numbers_are_those_of_the_held_shape_and_of_the_last_frame() {
    let mut stats = FrameStats::default();
    let pass = |name, ms| PassTime { name, ms };
    stats.passes = vec![pass("clip", 1.25), pass("tiles", 10.0)];
    let mut clips = clips(&["sphere:1,2,3,0.5", "plane:1,0,0,0"]);
    let written = lines(&clips, Mode::Exact, Some(&stats));
    assert_eq!(written[0], "mode exact, last frame 11.2 ms");
    assert_eq!(written[1], "sphere 1 of 2");
    assert!(written[3].starts_with("radius") && written[3].ends_with("0.5000"));
    clips.frame.next();
    let written = lines(&clips, Mode::Hard, None);
    assert_eq!(written[..2], ["mode hard", "plane 2 of 2 at 0.0000"]);
    clips.frame.on = false;
    assert_eq!(lines(&clips, Mode::None, None).len(), 2);
}

#[test]
fn panels_are_made_anew_only_where_something_has_changed() {
    let mut overlay = Overlay::new(true);
    let mut clips = clips(&["plane:1,0,0,0"]);
    let size = (1280, 720);
    assert!(overlay.is_old(&seen(&clips, size)));
    let first = overlay
        .panels(overlay.content(&seen(&clips, size)))
        .expect("the first");
    assert_eq!(first.len(), 2, "numbers and a hint");
    assert!(
        overlay
            .panels(overlay.content(&seen(&clips, size)))
            .is_none()
    );
    clips.frame.flip();
    assert!(overlay.is_old(&seen(&clips, size)));
    assert!(
        overlay
            .panels(overlay.content(&seen(&clips, size)))
            .is_some()
    );
    overlay.set_keys(None);
    let with_keys = overlay
        .panels(overlay.content(&seen(&clips, size)))
        .expect("keys");
    assert_eq!(with_keys.len(), 2, "the keys are there, and no hint");
    overlay.set_numbers(Some(false));
    overlay.set_keys(Some(false));
    let none = overlay
        .panels(overlay.content(&seen(&clips, size)))
        .expect("a change");
    assert!(none.is_empty());
}

#[test]
fn hints_and_messages_go_away_in_time() {
    let mut overlay = Overlay::new(true);
    let now = Instant::now();
    assert!(overlay.until().is_none(), "there is no scene yet");
    overlay.scene_is_seen();
    assert!(!overlay.pass(now) && overlay.until().is_some());
    assert!(overlay.pass(now + HINT_TIME + MESSAGE_TIME));
    overlay.scene_is_seen();
    assert_eq!(overlay.until(), None, "it does not come again");
    overlay.warn("a.ply: no scene".into());
    assert!(overlay.hush() && !overlay.hush());
    overlay.tell("wrote a.png".into());
    assert!(overlay.pass(now + HINT_TIME + MESSAGE_TIME));
    let mut silent = Overlay::new(false);
    silent.tell("wrote a.png".into());
    assert!(silent.until().is_none());
    silent.warn("a.ply: no scene".into());
    assert!(silent.until().is_some());
}

#[test]
fn in_a_window_of_any_size_panels_begin_within_it_and_the_keys_beside_the_numbers() {
    let clips = clips(&["box:0,0,0,1,1,1"]);
    for size in [
        (1, 1),
        (64, 64),
        (320, 240),
        (700, 500),
        (1280, 720),
        (3840, 2160),
    ] {
        let mut overlay = Overlay::new(true);
        overlay.set_keys(Some(true));
        overlay.warn("what is wrong ".repeat(20));
        let content = overlay.content(&OverlayScene {
            progress: Some(("reading a.ply".into(), ProgressBar::Share(0.5))),
            ..seen(&clips, size)
        });
        for panel in laid_out(&content) {
            let Picture { width, height, .. } = panel.picture;
            assert!(width <= size.0 && height <= size.1, "{size:?}");
            let is_nothing = width == 0 || height == 0;
            let end = (panel.at.0 + width, panel.at.1 + height);
            assert!(
                is_nothing || end.0 <= size.0 && end.1 <= size.1,
                "{size:?}: {end:?}"
            );
        }
    }
    let mut overlay = Overlay::new(true);
    overlay.set_keys(Some(true));
    let panels = laid_out(&overlay.content(&seen(&clips, (1280, 720))));
    let [keys, numbers] = &panels[..] else {
        panic!("{} panels", panels.len());
    };
    assert!(numbers.at.0 + numbers.picture.width < keys.at.0);
    assert_eq!(keys.at.0 + keys.picture.width, 1280 - 8);
    assert!(keys.at.1 + keys.picture.height < 720);
    // A window of 640 by 480 shows the whole list.
    let panels = laid_out(&overlay.content(&seen(&clips, (640, 480))));
    let [keys, _] = &panels[..] else {
        panic!("{} panels", panels.len());
    };
    let (width, height) = (keys.picture.width, keys.picture.height);
    assert!(
        width < 640 - 2 * 8 && height < 480 - 2 * 8,
        "{width}x{height}"
    );
}
