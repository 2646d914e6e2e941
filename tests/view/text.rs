//! Text over the window's picture, files that are dropped on it, and how far the reading of a scene has come.

use std::fs;
use std::io::Write;
use std::process::Stdio;

use rara::Picture;

use super::display::{Display, Owned};
use super::viewer::{Viewer, apart, done, draws_again, draws_again_of, folder, rara, stderr};
use crate::folder::until;

/// The colours of papers and of bars.
const PAPER: [u8; 3] = [22, 25, 30];
const TRACK: [u8; 3] = [60, 66, 75];
const FILLED: [u8; 3] = [64, 179, 255];

/// The pixels that have a colour.
fn of_colour(picture: &Picture, colour: [u8; 3]) -> Vec<(u32, u32)> {
    let is_it = |x: u32, y: u32| {
        let [r, g, b, _] = picture.at(x, y);
        [r, g, b].map(|v| (255.0 * v).round() as u8) == colour
    };
    let rows = 0..picture.height;
    let all = rows.flat_map(|y| (0..picture.width).map(move |x| (x, y)));
    all.filter(|(x, y)| is_it(*x, *y)).collect()
}

#[test]
fn keys_and_numbers_are_written_over_the_window_and_not_into_screenshots() {
    let folder = folder("text");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let words =
        "@/scene.ply --size 640x480 --no-outline --background 0.5,0.5,0.5 --clip sphere:0,0,0,1";
    let mut viewer = Viewer::with_text(&display, &folder, words);
    // The numbers are in the upper left corner, the hint in the lower one, and keys are wherever there is room.
    let shows = |what: &str, corners: [bool; 2], keys: bool| {
        until(what, || {
            let seen = display.corner(640, 480);
            let all = of_colour(&seen, PAPER);
            let has = [(9, 9), (9, 470)].map(|at| all.contains(&at));
            (has == corners && (all.len() > 100_000) == keys).then_some(seen)
        })
    };
    shows("numbers and a hint", [true, true], false);
    viewer.say("keys on");
    shows("the keys, and no hint", [true, false], true);
    let shot = viewer.screenshot("with_keys");
    assert!(
        of_colour(&shot, PAPER).is_empty(),
        "the picture has no text"
    );
    let mut client = display.client();
    let window = client.window();
    let h = 43;
    client.press(window, h);
    let closed = shows("the numbers alone", [true, false], false);
    // What changes the clip changes its numbers.
    viewer.say("scale 1.5");
    let scaled = viewer.screenshot("scaled");
    until("another radius", || {
        let seen = display.corner(640, 480);
        let differs = |at: &(u32, u32)| seen.at(at.0, at.1) != closed.at(at.0, at.1);
        let numbers = (40..100).flat_map(|y| (8..250).map(move |x| (x, y)));
        (numbers.filter(differs).count() > 10).then_some(())
    });
    viewer.say("numbers off\nresize 200x100");
    let bare = viewer.screenshot("bare");
    client.press(window, 36); // Enter, a key without a meaning takes the message away
    viewer.shows("nothing is written", &bare);
    viewer.say(
        "keys on\nnumbers on\nresize 40x20\nresize 1x1\nresize 640x480\nkeys off\nnumbers off",
    );
    viewer.screenshot("again");
    client.press(window, 36);
    viewer.shows("large again", &scaled);
    viewer.sleeps("nothing is written");
    let printed = viewer.quit();
    for name in ["with_keys", "scaled", "again"] {
        draws_again(&folder, name, &printed);
    }
}

#[test]
fn what_is_dropped_is_shown_and_what_cannot_be_read_changes_nothing() {
    let folder = folder("drop");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    done(rara(
        &folder,
        "generate layers -n 2000 --seed 5 -o @/more.ply",
    ));
    fs::write(
        folder.join("clip.json"),
        r#"[{"normal": [1, 0, 0], "d": 0.1}]"#,
    )
    .expect("a clip");
    let words = "--size 160x120 --background 0.2,0.4,0.6 --clip plane:0,0,1,0 --mode hard";
    let mut viewer = Viewer::start(&display, &folder, words);
    let first = viewer.screenshot("first");
    viewer.shows("the first scene", &first);

    let more = folder.join("more.ply");
    let mut client = display.client();
    let window = client.window();
    client.drop_files(window, &[&more]);
    until("the dropped scene", || {
        let seen = display.corner(160, 120);
        let is_blank = seen.pixels.iter().all(|pixel| *pixel == seen.pixels[0]);
        (!is_blank && apart(&seen, &first) > 50.0).then_some(())
    });
    let second = viewer.screenshot("second");
    viewer.shows("the dropped scene", &second);
    // It is what a command draws of it: without the first scene's clip, in the mode that was chosen.
    done(rara(
        &folder,
        "render @/more.ply -o @/drawn.png --size 160x120 --background 0.2,0.4,0.6",
    ));
    let drawn = Picture::load(folder.join("drawn.png")).expect("a picture");
    let off = apart(&drawn, &second);
    assert!(off <= 1.01, "the dropped scene is off by {off}/255");

    viewer.say("drop @/clip.json");
    let clipped = viewer.screenshot("clipped");
    assert!(apart(&second, &clipped) > 20.0, "the clip cuts");
    // Of several clips with names one is meant: the first, until another is asked for.
    let planes = r#"[{"name": "a", "normal": [1, 0, 0], "d": 0}, {"name": "b", "normal": [-1, 0, 0], "d": 0}]"#;
    fs::write(folder.join("planes.json"), planes).expect("a file");
    viewer.say("drop @/planes.json");
    let one = viewer.screenshot("one");
    viewer.say("clip next");
    let other = viewer.screenshot("other");
    viewer.say("clip next");
    let again = viewer.screenshot("one_again");
    assert!(apart(&one, &other) > 20.0 && apart(&one, &again) == 0.0);
    viewer.say("drop @/clip.json");
    viewer.say("drop @/first.json");
    let elsewhere = viewer.screenshot("elsewhere");
    assert!(apart(&clipped, &elsewhere) > 20.0, "the camera is another");
    fs::write(folder.join("broken.ply"), "ply\nformat ascii 1.0\n").expect("a file");
    let refused = ["none.ply", "broken.ply"];
    for name in refused {
        viewer.say(&format!("drop @/{name}"));
        let same = viewer.screenshot(&format!("after_{name}").replace(".ply", ""));
        assert_eq!(apart(&elsewhere, &same), 0.0, "{name} changes nothing");
    }
    // A file that can be read goes on from there, and two of them are one scene.
    viewer.say("drop @/scene.ply");
    let back = viewer.screenshot("back");
    viewer.shows("back", &back);
    client.drop_files(window, &[&more, &folder.join("scene.ply")]);
    // A bar is another picture too, and from then on the script waits by itself.
    until("the dropped scenes", || {
        (apart(&display.corner(160, 120), &back) > 1.01).then_some(())
    });
    viewer.say("layer 2 off");
    viewer.screenshot("both");
    let printed = viewer.quit_as(1);
    assert!(
        printed.contains("--script: a file could not be opened"),
        "{printed}"
    );
    for name in refused {
        let said = rara(&folder, &format!("render @/{name} -o @/no.png")).output();
        let said = stderr(&said.expect("the rara binary runs"));
        assert!(said.contains(name), "{said}");
        assert!(printed.contains(said.trim_end()), "{printed} lacks {said}");
    }
    for name in ["second", "clipped", "elsewhere"] {
        draws_again_of(&folder, "@/more.ply", name, &printed);
    }
    draws_again(&folder, "back", &printed);
    draws_again_of(&folder, "@/more.ply @/scene.ply", "both", &printed);
}

#[test]
fn a_bar_moves_until_the_scene_is_there() {
    let folder = folder("bar");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let words = "view - --validation --no-text --size 400x200 --background 0.2,0.4,0.6";
    let mut command = rara(&folder, words);
    command.env("DISPLAY", &display.name);
    command.env("MESA_SHADER_CACHE_DIR", folder.join("driver"));
    command.stdin(Stdio::piped()).stderr(Stdio::piped());
    let mut child = Owned(command.spawn().expect("the rara binary runs"));
    // Nobody knows how much is to come by standard input.
    let mut places = Vec::new();
    until("a bar that moves", || {
        let seen = display.corner(400, 200);
        let filled = of_colour(&seen, FILLED);
        let is_bar = !filled.is_empty() && !of_colour(&seen, TRACK).is_empty();
        if is_bar && !places.contains(&filled[0]) {
            places.push(filled[0]);
        }
        (places.len() >= 3).then_some(())
    });
    let scene = fs::read(folder.join("scene.ply")).expect("a scene");
    let mut stdin = child.0.stdin.take().expect("it is piped");
    stdin.write_all(&scene).expect("it is read");
    drop(stdin);
    done(rara(
        &folder,
        "render @/scene.ply -o @/drawn.png --size 400x200 --background 0.2,0.4,0.6",
    ));
    let drawn = Picture::load(folder.join("drawn.png")).expect("a picture");
    until("the scene", || {
        (apart(&display.corner(400, 200), &drawn) <= 1.01).then_some(())
    });
    let mut client = display.client();
    let window = client.window();
    // The driver keeps nothing that the first cut needs, and the window says so before it stands still.
    client.press(window, 33); // P
    let seen = until("a bar while shaders are compiled", || {
        let seen = display.corner(400, 200);
        (!of_colour(&seen, FILLED).is_empty()).then_some(seen)
    });
    // The bar is at the bottom, and above it the last picture stays.
    let bar = of_colour(&seen, PAPER);
    let top = bar.iter().map(|(_, y)| *y).min().expect("a bar");
    let above = |picture: &Picture| Picture {
        height: top,
        pixels: picture.pixels[..(top * picture.width) as usize].to_vec(),
        ..*picture
    };
    assert!(top > 100, "the bar begins at {top}");
    let off = apart(&above(&seen), &above(&drawn));
    assert!(off <= 1.01, "the last picture is off by {off}/255");
    until("the cut", || {
        let seen = display.corner(400, 200);
        let above = above(&seen);
        let is_blank = above.pixels.iter().all(|pixel| *pixel == above.pixels[0]);
        assert!(!is_blank, "a picture stays until all shaders are compiled");
        (of_colour(&seen, FILLED).is_empty() && apart(&seen, &drawn) > 1.01).then_some(())
    });
    client.press(window, 9); // Escape
    let printed = child.printed();
    assert!(child.0.wait().expect("it ends").success(), "{printed}");
    assert!(!printed.contains("validation"), "{printed}");
}
