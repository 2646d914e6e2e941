//! Shapes that are moved, outlines, layers and sections in the window.

use std::fs;

use rara::Picture;
use rara::clip::load_clips;

use super::display::Display;
use super::viewer::{Viewer, apart, done, draw, draws_again, draws_again_of, folder, rara};
use crate::folder::until;

#[test]
fn every_shape_is_moved_turned_and_scaled_and_drawn_again() {
    let folder = folder("shapes");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let words = "--size 160x120 --mode hard --background 0.2,0.4,0.6 --clip sphere:0.2,0,0,0.8 --clip !capsule:-1,0,0,1,0.3,0,0.2 \
                 --clip-expr any(box:0,0,0,0.6,0.4,0.5,1,0.2,0,0.1,not(cone:0,0,-1,0,0,1,0.9))";
    let mut viewer = Viewer::start(&display, &folder, words);
    let mut before = viewer.screenshot("start");
    for (number, lines) in [
        "drag 9,-6\nscale 0.9",
        "shape next\ndrag 8,8\ntilt 20,30",
        "shape next\nshape +0.2\ntilt -35,20",
        "shape next\nshape flip\nshape x",
        "shape next\nshape ellipsoid:0.1,0,0,0.9,0.5,0.7\nscale 1.1",
    ]
    .into_iter()
    .enumerate()
    {
        viewer.say(lines);
        let name = format!("step_{number}");
        let shot = viewer.screenshot(&name);
        viewer.shows(&name, &shot);
        assert!(apart(&before, &shot) > 20.0, "{lines}");
        before = shot;
    }
    let printed = viewer.quit();
    for number in 0..5 {
        draws_again(&folder, &format!("step_{number}"), &printed);
    }
}

#[test]
fn a_lasso_keeps_what_it_holds_and_is_moved_as_shapes_are() {
    let folder = folder("lasso");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let mut viewer = Viewer::start(
        &display,
        &folder,
        "--size 160x120 --mode hard --background 0.1,0.2,0.3",
    );
    let whole = viewer.screenshot("whole");
    viewer.say("lasso 20,10;150,5;75,100");
    let held = viewer.screenshot("held");
    assert!(apart(&whole, &held) > 20.0);
    viewer.say("drag 9,0\nscale 0.8");
    let moved = viewer.screenshot("moved");
    assert!(apart(&held, &moved) > 20.0);
    viewer.say("undo\nundo\nundo");
    let back = viewer.screenshot("back");
    assert!(apart(&whole, &back) == 0.0, "nothing is cut any more");
    let printed = viewer.quit();
    for name in ["held", "moved"] {
        draws_again(&folder, name, &printed);
    }
}

#[test]
fn a_mesh_is_moved_turned_and_scaled_as_shapes_are() {
    let folder = folder("mesh");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let corners = "v 0 0 1\nv 0.9 0 -0.5\nv -0.5 0.8 -0.5\nv -0.5 -0.8 -0.5\n";
    let faces = "f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n";
    fs::write(folder.join("cutter.obj"), format!("{corners}{faces}")).expect("a file");
    let words =
        "--size 160x120 --mode hard --background 0.1,0.2,0.3 --clip mesh:@/cutter.obj;scale=0.9";
    let mut viewer = Viewer::start(&display, &folder, words);
    let start = viewer.screenshot("start");
    viewer.say("drag 9,4\ntilt 20,30\nscale 0.8");
    let moved = viewer.screenshot("moved");
    assert!(apart(&start, &moved) > 20.0);
    viewer.say("shape flip");
    let flipped = viewer.screenshot("flipped");
    assert!(apart(&moved, &flipped) > 20.0);
    let printed = viewer.quit();
    for name in ["start", "moved", "flipped"] {
        draws_again(&folder, name, &printed);
    }
}

#[test]
fn outlines_are_drawn_over_the_window_and_not_into_screenshots() {
    let folder = folder("outlines");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    // Sixty pixels a unit, around the middle.
    let words = "@/scene.ply --size 320x240 --background 0.1,0.1,0.1 --eye 0,0,-8 --target 0,0,0 --ortho 4 \
                 --clip box:0,0,0,1,0.5,1 --clip !sphere:0,0,0,0.25";
    let mut viewer = Viewer::open(&display, &folder, words);
    let plain = viewer.screenshot("plain");
    let colours = |viewer: &mut Viewer<'_>, name: &str| {
        let shot = viewer.screenshot(name);
        assert!(apart(&shot, &plain) == 0.0, "no line is in {name}");
        // Two edges of the box, and the sphere's contour.
        let seen = display.corner(320, 240);
        [(100, 120), (160, 150), (175, 120)].map(|(x, y)| {
            let [r, g, b, _] = seen.at(x, y);
            [r, g, b].map(|v| (255.0 * v).round() as i32)
        })
    };
    let is_near = |a: [i32; 3], b: [i32; 3]| (0..3).all(|i| (a[i] - b[i]).abs() <= 1);
    let (held, other) = ([255, 153, 26], [64, 179, 255]);
    let [side, bottom, ball] = colours(&mut viewer, "box");
    assert!(
        is_near(side, held) && is_near(bottom, held),
        "{side:?} {bottom:?}"
    );
    assert!(is_near(ball, other), "{ball:?}");
    viewer.say("shape next");
    let [side, _, ball] = colours(&mut viewer, "ball");
    assert!(
        is_near(side, other) && is_near(ball, held),
        "{side:?} {ball:?}"
    );
    // The eye within the scene sees what is before it, and the validation layer nothing wrong.
    viewer.say(
        "camera perspective\ncamera fly\nmove 0,0,7.7\nturn 100,20\nresize 64x200\ncamera reset",
    );
    viewer.say("resize 320x240\noutline off");
    let shot = viewer.screenshot("without");
    viewer.shows("without outlines", &shot);
    viewer.sleeps("without outlines");
    viewer.quit();
}

#[test]
fn layers_are_switched_and_cut_by_clips_of_their_own() {
    let folder = folder("layers");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    done(rara(
        &folder,
        "generate layers -n 2000 --seed 5 -o @/more.ply",
    ));
    let list = r#"{"layers": [{"path": "scene.ply", "name": "outer skin"}, {"path": "more.ply", "visible": false},
        {"path": "scene.ply", "name": "k=v", "scale": 0.5, "clip_expr": "plane:0,1,0,0"}]}"#;
    fs::write(folder.join("list.json"), list).expect("a list");
    let words = "@/list.json --no-outline --mode hard --background 0.2,0.4,0.6 --size 160x120 --clip plane:1,0,0,0 \
                 --save-clip @/saved.json";
    let mut viewer = Viewer::open(&display, &folder, words);
    let mut shots: Vec<Picture> = Vec::new();
    let steps = [
        ("shown", "layer more on"),
        ("own", "edit 2\nshape sphere:0,0,0,0.4"),
        ("moved", "drag 30,5\nscale 1.5"),
        ("whole", "edit k=v\nshape off"),
        ("released", "edit release"),
        ("cut", "edit frame\nshape +0.3"),
        ("faded", "layer outer skin 40%"),
        ("tinted", "layer k=v tint red:90%"),
        ("hidden", "layer 1"),
    ];
    for (name, lines) in steps {
        viewer.say(lines);
        let shot = viewer.screenshot(name);
        viewer.shows(name, &shot);
        for before in &shots {
            assert!(apart(before, &shot) > 5.0, "{name} is a picture of its own");
        }
        shots.push(shot);
    }
    let printed = viewer.quit();
    for (name, _) in steps {
        draws_again_of(&folder, "@/list.json", name, &printed);
    }
    // What is saved is the clip at the end, not the one at the start.
    let saved = load_clips(&folder.join("saved.json")).expect("clips");
    let expected = [(None, "plane:1,0,0,-0.3"), (Some("more"), "sphere:")];
    assert_eq!(saved.len(), expected.len());
    for (one, (layer, begin)) in saved.iter().zip(expected) {
        let text = one.clip.to_string();
        assert!(
            one.layer.as_deref() == layer && text.starts_with(begin),
            "{layer:?} {text}"
        );
    }
}

#[test]
fn layers_are_faded_and_tinted_by_keys_and_drawn_again() {
    let folder = folder("looks");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    // The parts of a set keep their order, and what was typed stays below what the window mixes in.
    let words = "@/scene.ply --no-outline --background 0.2,0.4,0.6 --size 160x120 --select left=inside(plane:-1,0,0,0) \
                 --layer-tint left=blue:60% --layer-opacity left=80%";
    let mut viewer = Viewer::open(&display, &folder, words);
    let typed = viewer.screenshot("typed");
    let mut client = display.client();
    let window = client.window();
    let (shift, control, f2) = (50, 37, 68);
    let mut before = typed.clone();
    for (name, held) in [("faded", shift), ("red", control), ("gold", control)] {
        client.press_with(window, held, f2);
        until(name, || {
            (apart(&display.corner(160, 120), &before) > 5.0).then_some(())
        });
        before = viewer.screenshot(name);
        viewer.shows(name, &before);
    }
    viewer.say("layer left 80%\nlayer left tint none\nundo");
    let back = viewer.screenshot("back");
    assert_eq!(apart(&back, &typed), 0.0, "it is as it was typed");
    let printed = viewer.quit();
    for name in ["typed", "faded", "red", "gold", "back"] {
        draws_again(&folder, name, &printed);
    }
}

#[test]
fn a_section_is_what_render_draws_and_can_be_moved() {
    let folder = folder("section");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let section = "--section axial=0.4 --section-thickness 0.8 --clip !sphere:0,0,0,0.3 --size 200x150 --mode hard \
                   --background 0.2,0.4,0.6";
    let mut viewer = Viewer::open(
        &display,
        &folder,
        &format!("@/scene.ply --no-outline {section}"),
    );
    let shot = viewer.screenshot("section");
    viewer.shows("the section", &shot);
    done(rara(
        &folder,
        &format!("render @/scene.ply -o @/drawn.png {section}"),
    ));
    let drawn = Picture::load(folder.join("drawn.png")).expect("a picture");
    // The window's camera stands elsewhere on the same lines of sight, up to rounding.
    let off = apart(&drawn, &shot);
    assert!(off <= 1.01, "the section is off by {off}/255");
    viewer.say("shape +0.2");
    let moved = viewer.screenshot("moved");
    assert!(apart(&shot, &moved) > 20.0, "the section's plane is held");
    viewer.say("turn 20,10\nflags");
    let turned = viewer.screenshot("turned");
    let printed = viewer.quit();
    for name in ["section", "moved", "turned"] {
        draws_again(&folder, name, &printed);
    }
    // The flags alone place the camera, up to rounding.
    let line = printed
        .lines()
        .find_map(|line| line.strip_prefix("flags    "));
    let flags = line.expect("the flags were printed");
    assert!(
        flags.contains("--ortho ") && flags.contains("--clip plane:"),
        "{flags}"
    );
    let again = folder.join("flags.png");
    draw(&folder, "@/scene.ply", flags, &again);
    let off = apart(&Picture::load(again).expect("a picture"), &turned);
    assert!(off <= 1.01, "{flags}: off by {off}/255");
}

#[test]
fn a_section_cuts_layers_with_clips_of_their_own_as_in_render() {
    let folder = folder("section_layers");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let list = r#"{"layers": [{"path": "scene.ply", "name": "skin"},
        {"path": "scene.ply", "name": "core", "scale": 0.7, "clip_expr": "!sphere:0,0,0,0.3"},
        {"path": "scene.ply", "name": "bone", "scale": 0.2, "position": [0.6, 0.4, -0.8], "clip_expr": "whole"}]}"#;
    fs::write(folder.join("list.json"), list).expect("a list");
    let section = "--section axial=0.5 --size 160x120 --mode hard --background 0.2,0.4,0.6";
    let words = format!("@/list.json --no-outline {section}");
    let mut viewer = Viewer::open(&display, &folder, &words);
    let mut shots: Vec<Picture> = Vec::new();
    for (name, lines, flags) in [
        ("listed", "", ""),
        (
            "changed",
            "edit core\nshape sphere:0.1,0,0,0.5",
            "--layer-clip core=sphere:0.1,0,0,0.5",
        ),
        ("whole", "shape off", "--layer-clip core=whole"),
        ("as_the_frame", "edit release", "--layer-clip core=frame"),
    ] {
        viewer.say(lines);
        let shot = viewer.screenshot(name);
        viewer.shows(name, &shot);
        let words = format!("render @/list.json -o @/drawn_{name}.png {section} {flags}");
        done(rara(&folder, &words));
        let drawn = Picture::load(folder.join(format!("drawn_{name}.png"))).expect("a picture");
        // The window's camera stands elsewhere on the same lines of sight, up to rounding.
        let off = apart(&drawn, &shot);
        assert!(off <= 1.01, "{name} is off by {off}/255");
        for before in &shots {
            assert!(apart(before, &shot) > 5.0, "{name} is a picture of its own");
        }
        shots.push(shot);
    }
    // Where the section moves, or is off, the layers follow.
    viewer.say("edit core\nshape sphere:0.1,0,0,0.5\nedit frame\nshape +0.2");
    let moved = viewer.screenshot("moved");
    assert!(apart(&shots[1], &moved) > 5.0, "the section has moved");
    viewer.say("shape off");
    let off = viewer.screenshot("off");
    assert!(apart(&moved, &off) > 5.0, "the section is off");
    let printed = viewer.quit();
    for name in ["listed", "changed", "whole", "as_the_frame", "moved", "off"] {
        draws_again_of(&folder, "@/list.json", name, &printed);
    }
}
