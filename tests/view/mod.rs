//! `rara view` on a display of its own: the tests start Xvfb, a script drives the window, and the content of the X server
//! is compared with what must be seen. All of it runs under validation.
#![cfg(all(feature = "view", unix))]

mod display;
mod drag;
mod faces;
mod shapes;
mod text;
mod viewer;
mod x11;

use std::fs;
use std::thread::sleep;
use std::time::Duration;

use crate::folder::until;
use display::Display;
use rara::Picture;
use viewer::{Viewer, apart, done, draws_again, folder, rara, stderr};

const BACKGROUND: [f32; 3] = [0.2, 0.4, 0.6];

fn background() -> String {
    let [r, g, b] = BACKGROUND;
    format!("--background {r},{g},{b}")
}

#[test]
fn a_plane_is_moved_and_what_is_seen_is_what_render_draws() {
    let folder = folder("plane");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let words = format!("--size 320x240 --clip plane:1,0,0,0.1 {}", background());
    let mut viewer = Viewer::start(&display, &folder, &words);
    let first = viewer.screenshot("first");
    viewer.shows("the start", &first);

    viewer.say("plane +0.3");
    let moved = viewer.screenshot("moved");
    viewer.shows("the moved plane", &moved);
    assert!(apart(&first, &moved) > 50.0, "the plane has moved");
    viewer.sleeps("nothing changes");

    viewer.say("mode hard");
    let hard = viewer.screenshot("hard");
    viewer.shows("mode hard", &hard);
    viewer.say(
        "mode exact\nplane flip\nrepeat 20 plane +0.01\ntilt 10,20\nrepeat 5 turn 4,-3\nzoom 2",
    );
    let turned = viewer.screenshot("turned");
    viewer.shows("another view", &turned);
    viewer.say("plane 0,0,1,0.2\ncamera fly\nturn 3,3\nmove 0.1,0,0.2");
    let flown = viewer.screenshot("flown");
    viewer.shows("from elsewhere", &flown);
    viewer.say("camera orbit\ncamera orthographic\nzoom -1\nturn -5,2");
    let flat = viewer.screenshot("flat");
    viewer.shows("without perspective", &flat);
    viewer.say("plane off\ntimings");
    let whole = viewer.screenshot("whole");
    viewer.shows("nothing cut", &whole);
    let printed = viewer.quit();
    assert!(
        printed.contains("tiles") && printed.contains("on the device"),
        "{printed}"
    );

    for name in ["first", "moved", "hard", "turned", "flown", "flat", "whole"] {
        draws_again(&folder, name, &printed);
    }
}

#[test]
fn every_setting_and_any_name_draws_a_screenshot_again() {
    let folder = folder("again");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let words = "--size 160x120 --clip plane:1,0,0,0.1 --clip plane:0,1,0.3,0 --clip-op or --mode rara --decay depth \
                 --sigma 2.3 --miss keep --background 0.1,0.25,1 --sh-degree 1 --preset fast --phi quintic \
                 --beam-switch 0.0123";
    let mut viewer = Viewer::start(&display, &folder, words);
    viewer.screenshot("it's $one");
    // The eye does not go beyond what numbers can hold.
    viewer.say(
        "repeat 5 move 1e308,0,0\nshift -1e308,0\nturn 20,0\nmode exact\nplane next\nplane +0.2",
    );
    viewer.screenshot("two; more");
    let printed = viewer.quit();
    draws_again(&folder, "it's $one", &printed);
    draws_again(&folder, "two; more", &printed);

    let words = "--size 160x120 --clip plane:0,0,1,0 --preset exact --key-bits 16 --target-format 8 --trace-all";
    let mut viewer = Viewer::start(&display, &folder, words);
    viewer.screenshot("three");
    let printed = viewer.quit();
    draws_again(&folder, "three", &printed);
}

#[test]
fn planes_that_move_with_the_camera_are_drawn_again() {
    let folder = folder("camera_planes");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let words = format!(
        "--size 160x120 --eye 0,0,-5 --target 0,0,0 --clip-near 4.75 --clip-far 5.5 {}",
        background()
    );
    let mut viewer = Viewer::start(&display, &folder, &words);
    let start = viewer.screenshot("start");
    viewer.say("turn 20,10\nmove 0.1,0,0.2");
    let moved = viewer.screenshot("moved");
    assert!(apart(&start, &moved) > 5.0, "the camera has moved");
    // Near its pivot the camera of an orthographic view stands farther back, and so are its planes from it.
    viewer.say("camera orthographic\nzoom 9");
    viewer.screenshot("flat");
    let printed = viewer.quit();
    for name in ["start", "moved", "flat"] {
        draws_again(&folder, name, &printed);
    }
}

#[test]
fn an_axis_is_made_up_and_stays_up() {
    let folder = folder("up");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let words = format!("--size 160x120 {}", background());
    let mut viewer = Viewer::start(&display, &folder, &words);
    let start = viewer.screenshot("start");
    viewer.say("up x\nflags");
    let rolled = viewer.screenshot("rolled");
    viewer.shows("the rolled view", &rolled);
    assert!(apart(&start, &rolled) > 20.0, "another axis is up");
    let mut client = display.client();
    let window = client.window();
    let (shift, x) = (50, 53);
    client.press_with(window, shift, x);
    until("x is down", || {
        (apart(&display.corner(160, 120), &rolled) > 20.0).then_some(())
    });
    viewer.say("up x\nturn 30,10\ncamera reset");
    let reset = viewer.screenshot("reset");
    let off = apart(&rolled, &reset);
    assert!(off <= 1.01, "the start keeps what is up: off by {off}/255");
    viewer.say("turn 40,-20\nup 0,1,2");
    viewer.screenshot("turned");
    viewer.say("up z\ndrop @/scene.ply");
    let dropped = viewer.screenshot("dropped");
    let printed = viewer.quit();
    for name in ["rolled", "reset", "turned", "dropped"] {
        draws_again(&folder, name, &printed);
    }
    done(rara(
        &folder,
        &format!(
            "render @/scene.ply -o @/z.png --size 160x120 --up z {}",
            background()
        ),
    ));
    let drawn = Picture::load(folder.join("z.png")).expect("a picture");
    let off = apart(&drawn, &dropped);
    assert!(off <= 1.01, "the dropped scene is off by {off}/255");
}

#[test]
fn a_window_may_change_its_size_and_vanish_for_a_while() {
    let folder = folder("size");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let words = format!("--size 300x200 --clip plane:0,1,0,0 {}", background());
    let mut viewer = Viewer::start(&display, &folder, &words);
    let mut seen = Vec::new();
    for (width, height) in [(300, 200), (517, 401), (64, 300), (1, 1), (400, 300)] {
        viewer.say(&format!("resize {width}x{height}\nplane +0.01"));
        let shot = viewer.screenshot(&format!("at_{width}"));
        assert_eq!((shot.width, shot.height), (width, height));
        viewer.shows(&format!("{width}x{height}"), &shot);
        seen.push(shot);
    }
    // A minimised window draws nothing and waits for nothing; screenshots are still possible.
    viewer.say("minimise\nrepeat 30 plane +0.005");
    let hidden = viewer.screenshot("hidden");
    assert!(apart(&hidden, &seen[4]) > 20.0, "the plane has moved");
    viewer.sleeps("minimised");
    viewer.shows("what it was before", &seen[4]);
    viewer.say("restore");
    viewer.shows("what it is now", &hidden);
    // Whoever brings the window back, it is seen, so it is drawn.
    viewer.say("minimise\nplane -0.1");
    let hidden = viewer.screenshot("hidden_again");
    let mut client = display.client();
    let window = client.window();
    client.unmap(window);
    client.map(window);
    viewer.shows("what it is after that", &hidden);
    let printed = viewer.quit();
    draws_again(&folder, "hidden", &printed);
}

#[test]
fn a_window_outlives_a_screenshot_that_cannot_be_written() {
    let folder = folder("key");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let shots = folder.join("shots");
    fs::create_dir(&shots).expect("a folder");
    let mut viewer = Viewer::start(&display, &folder, "--size 64x64 -o @/shots/{}.png");
    viewer.screenshot("open");
    let mut client = display.client();
    let window = client.window();
    let (c, escape) = (54, 9);
    client.press(window, c);
    let shot = shots.join("001.json");
    until("a screenshot by key", || shot.exists().then_some(()));
    // It ends at once, also where the last picture is still being written.
    fs::rename(&shots, folder.join("gone")).expect("it is there");
    fs::write(&shots, "in the way").expect("a file"); // a folder that is missing would be made
    client.press(window, c);
    client.press(window, escape);
    let printed = viewer.printed();
    assert!(
        printed.contains("rara: ") && printed.contains("not a folder"),
        "{printed}"
    );
    assert_eq!(viewer.child.0.wait().expect("it ends").code(), Some(0));
}

#[test]
fn a_display_that_goes_away_is_a_failure_and_no_panic() {
    let folder = folder("lost");
    for server in [true, false] {
        let Some(display) = Display::start(&folder) else {
            return;
        };
        let mut viewer = Viewer::start(&display, &folder, "--size 64x64");
        viewer.screenshot(if server { "a" } else { "b" });
        viewer.say("repeat 2000 turn 1,0\nquit");
        sleep(Duration::from_millis(300));
        let Viewer { mut child, .. } = viewer;
        if server {
            display.kill();
        } else {
            let mut client = display.client();
            let window = client.window();
            client.kill(window);
        }
        let printed = child.printed();
        let status = child.0.wait().expect("it ends");
        assert_eq!(status.code(), Some(1), "{printed}");
        assert!(!printed.contains("panicked"), "{printed}");
        // Xlib may be the first to notice; which of its two lines it prints depends on the socket.
        let says = [
            "rara: the window was lost",
            "X connection to",
            "XIO:  fatal IO error",
        ];
        assert!(says.iter().any(|says| printed.contains(says)), "{printed}");
    }
}

#[test]
fn a_screenshot_replaces_nothing_and_a_script_that_fails_ends_the_viewer() {
    let folder = folder("script");
    let Some(display) = Display::start(&folder) else {
        return;
    };
    let mut viewer = Viewer::start(&display, &folder, "--size 64x64 -o @/shot_{}.png");
    viewer.say("screenshot\nscreenshot");
    viewer.screenshot("own");
    assert!(folder.join("shot_001.png").is_file() && folder.join("shot_002.json").is_file());
    viewer.say("screenshot @/own.png");
    let printed = viewer.printed();
    assert!(
        printed.contains("own.png") && printed.contains("replaces nothing"),
        "{printed}"
    );
    assert_eq!(viewer.child.0.wait().expect("it ends").code(), Some(1));

    let mut viewer = Viewer::start(&display, &folder, "--size 64x64");
    viewer.say("# a comment\nleap");
    let printed = viewer.printed();
    assert!(
        printed.contains("line 2: \"leap\" is not an action"),
        "{printed}"
    );
    assert_eq!(viewer.child.0.wait().expect("it ends").code(), Some(2));
}

#[test]
fn what_cannot_work_is_said_in_a_line() {
    let folder = folder("refused");
    fs::write(folder.join("wrong.txt"), "plane +0.1\nplane sideways\n").expect("a script");
    for (words, status, says) in [
        ("view @/scene.ply", 1, "rara render"),
        (
            "view @/scene.ply --script @/wrong.txt",
            2,
            "wrong.txt, line 2",
        ),
        ("view @/scene.ply --script @/none.txt", 1, "none.txt"),
        ("view - --script -", 2, "give the script as a file"),
        ("view @/scene.ply -o @/one.png", 2, "{}"),
        (
            "view @/scene.ply --section axial=0.1..0.9:3",
            2,
            "one section, and these are 3",
        ),
        (
            "view @/scene.ply --section axial=0.4 --ortho 2",
            2,
            "--section places the camera",
        ),
    ] {
        let output = rara(&folder, words).output().expect("the rara binary runs");
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(status), "{words}: {message}");
        assert!(
            message.starts_with("rara: ") && message.contains(says),
            "{words}: {message}"
        );
        assert_eq!(message.trim_end().lines().count(), 1, "{words}: {message}");
    }
}
