//! Cut faces in the window: the slice on the held shape's, and marks at the edges of cut surfaces.

use std::fs;
use std::path::Path;

use rara::Picture;

use super::display::Display;
use super::viewer::{Viewer, apart, done, draws_again, folder, rara};
use crate::folder::until;

/// The colours of the window's marks.
const MARKS: &str = "--outline=1,0.9,0.2 --rim=1,0.5,0.1";

/// What the command draws of these flags.
fn drawn(folder: &Path, flags: &str) -> Picture {
    let file = folder.join("drawn.png");
    done(rara(folder, &format!("render {flags} -o @/drawn.png")));
    Picture::load(file).expect("a picture")
}

#[test]
fn marks_are_drawn_once_the_view_rests_and_as_render_draws_them() {
    let folder = folder("marks");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let words = "--size 320x240 --background 0.2,0.4,0.6 --clip box:0,0,0,0.6,0.5,0.7";
    let mut viewer = Viewer::start(&display, &folder, words);
    let plain = viewer.screenshot("plain");
    let mut client = display.client();
    let window = client.window();
    let eight = 17;
    client.press(window, eight);
    until("a line", || {
        (apart(&display.corner(320, 240), &plain) > 50.0).then_some(())
    });
    let mut shots = vec![plain.clone()];
    for (name, lines) in [
        ("edged", ""),
        ("both", "rim on"),
        ("turned", "turn 25,-15"),
        ("rimmed", "edge off\nresize 200x240"),
        (
            "moved",
            "resize 320x240\nshape +0.3\nlayer 1 tint blue\nmode hard",
        ),
    ] {
        viewer.say(lines);
        let shot = viewer.screenshot(name);
        viewer.shows(name, &shot);
        let alike = |other: &&Picture| (other.width, other.height) == (shot.width, shot.height);
        for before in shots.iter().filter(alike) {
            assert!(
                apart(before, &shot) > 20.0,
                "{name} is a picture of its own"
            );
        }
        shots.push(shot);
    }
    viewer.sleeps("at rest");
    // A sphere has no faces, and a clip that is off has none either.
    viewer.say("shape sphere");
    let ball = viewer.screenshot("ball");
    viewer.shows("a ball", &ball);
    viewer.say("shape box\nshape off");
    let off = viewer.screenshot("off");
    viewer.shows("no clip", &off);
    viewer.say("shape on\nrim off");
    let unmarked = viewer.screenshot("unmarked");
    viewer.shows("no marks", &unmarked);
    let printed = viewer.quit();
    assert!(!printed.contains("the slice"), "{printed}");
    for name in [
        "plain", "edged", "both", "turned", "rimmed", "moved", "ball", "off", "unmarked",
    ] {
        draws_again(&folder, name, &printed);
    }
}

#[test]
fn a_held_section_is_sliced_as_render_slices_it() {
    let folder = folder("slice");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let list = r#"{"layers": [{"path": "scene.ply", "name": "skin"},
        {"path": "scene.ply", "name": "core", "scale": 0.7, "clip_expr": "!sphere:0,0,0,0.3"},
        {"path": "scene.ply", "name": "rest", "visible": false}]}"#;
    fs::write(folder.join("list.json"), list).expect("a list");
    let section = "@/list.json --section axial=0.5 --clip !sphere:0.4,0,0,0.3 --size 200x150 --background 0.2,0.4,0.6";
    let mut viewer = Viewer::open(&display, &folder, &format!("{section} --no-outline"));
    let plain = viewer.screenshot("plain");
    for (name, lines, flags) in [
        ("sliced", "slice on", ""),
        ("marked", "edge on\nrim on", MARKS),
        (
            "red",
            "layer skin tint red:1",
            &format!("{MARKS} --layer-tint skin=red:1"),
        ),
    ] {
        viewer.say(lines);
        let shot = viewer.screenshot(name);
        viewer.shows(name, &shot);
        assert!(
            apart(&plain, &shot) > 20.0,
            "{name} is a picture of its own"
        );
        let drawn = drawn(&folder, &format!("{section} --slice --opaque {flags}"));
        // The window's camera stands elsewhere on the same lines of sight, up to rounding.
        let off = apart(&drawn, &shot);
        assert!(off <= 2.01, "{name} is off by {off}/255");
    }
    // From anywhere, and of the shape that is held.
    viewer.say("turn 30,20");
    let aslant = viewer.screenshot("aslant");
    viewer.shows("from aside", &aslant);
    viewer.say("shape next");
    let ball = viewer.screenshot("ball");
    viewer.shows("a sphere has no slice", &ball);
    assert!(apart(&aslant, &ball) > 20.0, "the scene is there again");
    viewer.say("edit core\nshape box");
    let own = viewer.screenshot("own");
    viewer.shows("the faces of a box", &own);
    assert!(apart(&ball, &own) > 20.0, "the faces of the layer's box");
    viewer.say("slice off\nedge off\nrim off\nedit release\nedit frame\nlayer skin tint none\ncamera reset");
    let back = viewer.screenshot("back");
    viewer.shows("the scene again", &back);
    viewer.sleeps("at rest");
    let printed = viewer.quit();
    assert_eq!(
        printed.matches("leave out the slice").count(),
        5,
        "{printed}"
    );
}
