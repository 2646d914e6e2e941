//! Regions of many surfaces, of which each block of Gaussians asks the few that may cut it.

use crate::common;
use glam::DVec3;
use rara::clip::Expression;
use rara::scene::{Kind, generate};
use rara::{Clip, ClipOp, Headless, Mode, Picture, Plane, Raster, Settings};
use rara_lab::measure::differences;

fn clip_of(text: &str) -> Clip {
    text.parse::<Expression>().expect("an expression").clip()
}

/// Shapes on a spiral through a scene of radius 1, one after the other.
fn shapes(count: u32) -> String {
    let shape = |number: u32| {
        let share = f64::from(number) / f64::from(count);
        let (sine, cosine) = (40.0 * share).sin_cos();
        let at = format!("{},{},{}", share * cosine, 2.0 * share - 1.0, share * sine);
        match number % 3 {
            0 => format!("sphere:{at},.15"),
            1 => format!("box:{at},.1,.05,.2"),
            _ => format!("all(sphere:{at},.2, plane:1,.3,.2,{})", -share * cosine),
        }
    };
    (0..count).map(shape).collect::<Vec<_>>().join(",")
}

/// A polytope around a sphere of radius .8.
fn polytope(planes: u32) -> Clip {
    let plane = |number: u32| {
        let height = 2.0 * (f64::from(number) + 0.5) / f64::from(planes) - 1.0;
        let (sine, cosine) = (2.4 * f64::from(number)).sin_cos();
        let round = (1.0 - height * height).sqrt();
        Plane::new(-DVec3::new(round * cosine, height, round * sine), 0.8).expect("a normal")
    };
    Clip::of((0..planes).map(plane), ClipOp::And)
}

fn render(headless: &mut Headless, camera: &rara::Camera, clip: &Clip) -> Picture {
    let settings = Settings::default().raster(Raster::Tiles);
    headless.render(camera, clip, &settings).expect("renders");
    headless.picture().expect("reads back")
}

#[test]
fn many_shapes_are_the_references() {
    let gaussians = generate(Kind::General, 3_000, 3);
    let mut headless = common::headless();
    headless.load(&gaussians).expect("uploads");
    let views = common::views(&gaussians, 2, common::scaled((125, 94)));
    let clips = [
        (
            "a union of shapes",
            clip_of(&format!("any({})", shapes(40))),
        ),
        (
            "holes",
            clip_of(&format!("all(not(any({})), plane:0,1,0,.5)", shapes(40))),
        ),
        ("a polytope", polytope(Clip::MAX_SURFACES as u32)),
        (
            "a polytope of more planes than a flat record has room for",
            polytope(4 * Clip::MAX_SURFACES as u32),
        ),
    ];
    for (name, clip) in &clips {
        for camera in &views {
            for mode in [Mode::Exact, Mode::Rara] {
                let settings = Settings::default().mode(mode).raster(Raster::Tiles);
                common::check(&mut headless, name, &gaussians, camera, clip, &settings);
            }
        }
    }
}

#[test]
fn surfaces_far_away_change_no_pixel() {
    let gaussians = generate(Kind::General, 8_000, 3);
    let mut headless = common::headless();
    headless.load(&gaussians).expect("uploads");
    let near = "sphere:.2,.1,0,.6, all(!box:.2,0,0,.3,.3,.3, plane:1,.3,.2,.1)";
    let far: Vec<String> = (0..300)
        .map(|n| format!("sphere:{},{},50,3", 9 * (n % 20), 9 * (n / 20)))
        .collect();
    let alone = clip_of(&format!("any({near})"));
    let among = clip_of(&format!("any({near}, {})", far.join(",")));
    // From outside, and from among the splats, of which some then are cut far from where their contours are.
    for camera in common::views(&gaussians, 3, common::scaled((253, 190))) {
        let [alone, among] = [&alone, &among].map(|clip| render(&mut headless, &camera, clip));
        let difference = differences(&among, &alone).expect("the same size");
        assert!(difference.max < 0.1, "{difference:?}, in 1/255");
    }
}

/// Frames that take over what they can of the one before are the same bytes as frames that take over nothing.
#[test]
fn shortlists_follow_clip_and_camera() {
    // So many that most blocks have no part in most shapes.
    let gaussians = generate(Kind::General, 60_000, 3);
    let mut keeps = common::headless();
    let mut forgets = keeps.sharing().expect("another renderer");
    for headless in [&mut keeps, &mut forgets] {
        headless.load(&gaussians).expect("uploads");
    }
    let views = common::views(&gaussians, 2, common::scaled((125, 94)));
    let clip_at = |x: f64| clip_of(&format!("any({}, sphere:{x},0,0,.5)", shapes(30)));
    let walk = [
        (0, 0.1),
        (0, 0.3),
        (0, 0.1),
        (1, 0.1),
        (1, 0.3),
        (0, 0.3),
        (0, 0.31),
        (1, 0.3),
        // Back to the clip of the last frame that was whole, after one that only moved the clip.
        (1, -0.9),
        (0, 0.3),
    ];
    for (view, x) in walk {
        forgets.forget();
        let clip = clip_at(x);
        let [kept, fresh] =
            [&mut keeps, &mut forgets].map(|headless| render(headless, &views[view], &clip));
        assert!(kept == fresh, "view {view}, sphere at {x}");
    }
}
