//! Regions of many surfaces: each block of Gaussians asks the few that may cut it, and a splat is weighed by all that cut it,
//! however many they are.

use crate::common;
use glam::{DVec2, DVec3, Quat, Vec3};
use rara::clip::Expression;
use rara::scene::{Kind, generate};
use rara::{
    Camera, Clip, ClipOp, Decay, Gaussians, Headless, Mode, Picture, Plane, Raster, Settings,
};
use rara_base::limits::RECORD_PLANES;
use rara_lab::measure::differences;
use rara_reference::quadrature::PixelRays;

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
        ("a polytope", polytope(RECORD_PLANES)),
        (
            "a polytope of more planes than a record has room for",
            polytope(4 * RECORD_PLANES),
        ),
        (
            "a prism in a union",
            clip_of(&format!(
                "any(all({}), sphere:-.5,0,0,.3)",
                prism(40, [0.1, 0.0], 0.1)
            )),
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
    let clip_at = |sphere: &str| clip_of(&format!("any({}, sphere:{sphere})", shapes(30)));
    let around = |index: usize| {
        let [x, y, z] = gaussians.positions()[index].to_array();
        format!("{x},{y},{z},.1")
    };
    let (here, there) = (&*around(0), &*around(1));
    let walk = [
        (0, ".1,0,0,.5"),
        (0, ".3,0,0,.5"),
        (0, ".1,0,0,.5"),
        (1, ".1,0,0,.5"),
        (1, ".3,0,0,.5"),
        (0, ".3,0,0,.5"),
        (0, ".31,0,0,.5"),
        (1, ".3,0,0,.5"),
        // Back to the clip of the last frame that was whole, after one that only moved the clip.
        (1, "-.9,0,0,.5"),
        (0, ".3,0,0,.5"),
        // A small sphere jumps, before a camera that stands still and with it.
        (0, here),
        (0, there),
        (1, here),
        (1, there),
        (1, here),
        (0, there),
    ];
    let mut last = None;
    for (view, sphere) in walk {
        forgets.forget();
        let clip = clip_at(sphere);
        let [kept, fresh] =
            [&mut keeps, &mut forgets].map(|headless| render(headless, &views[view], &clip));
        assert!(kept == fresh, "view {view}, sphere at {sphere}");
        assert!(
            last.as_ref() != Some(&fresh),
            "sphere at {sphere} shows nothing"
        );
        last = Some(fresh);
    }
}

/// The operands of a prism along z, whose sides touch a circle.
fn prism(sides: u32, [x, y]: [f64; 2], radius: f64) -> String {
    let side = |number: u32| {
        let (sine, cosine) =
            (std::f64::consts::TAU * f64::from(number) / f64::from(sides)).sin_cos();
        let offset = radius + cosine * x + sine * y;
        format!("plane:{:.17},{:.17},0,{offset:.17}", -cosine, -sine)
    };
    (0..sides).map(side).collect::<Vec<_>>().join(",")
}

/// One splat of a deviation of 1, about as large as the prisms.
fn ball() -> Gaussians {
    let mut ball = Gaussians::default();
    ball.push(
        Vec3::new(0.0, 0.0, 4.0),
        Vec3::new(0.9, 1.1, 1.0),
        Quat::from_xyzw(0.3, 0.1, -0.2, 0.9).normalize(),
        0.9,
        &[0.5; 3],
    );
    ball
}

/// Pixels of a splat in which many surfaces are seen are weighed by all of them, as a numerical integral over the pixels' rays
/// says: of lists however long, and where surfaces that bend combine.
#[test]
fn many_surfaces_of_a_splat_are_what_an_integral_says() {
    let mut headless = common::headless();
    let ball = ball();
    headless.load(&ball).expect("uploads");
    let target = DVec3::new(0.0, 0.0, 4.0);
    let up = DVec3::NEG_Y;
    let across = DVec3::new(-6.0, 1.0, 3.0);
    let near = DVec3::new(1.0, -1.0, -1.0);
    let cameras = [
        Camera::orthographic(DVec3::ZERO, target, up, 4.0, (24, 24)),
        Camera::orthographic(across, target, up, 4.0, (24, 24)),
        Camera::look_at(near, target, up, 50.0, (24, 24)),
    ];
    let mut alphas = |camera: &Camera, clip: &Clip| -> Vec<f64> {
        let settings = Settings::default().decay(Some(Decay::Linear));
        headless.render(camera, clip, &settings).expect("renders");
        let picture = headless.picture().expect("reads back");
        picture.pixels.iter().map(|p| f64::from(p[3])).collect()
    };
    let [many, most] = [33, 200].map(|sides| format!("all({})", prism(sides, [0.2, 0.0], 0.5)));
    let cylinder = "cylinder:.2,0,-90,.2,0,90,.5";
    let slab = "all(plane:0,0,1,-3.8, plane:0,0,-1,4.3)";
    // Expressions, how many pixels are looked at, and by how much they may be off, of 255. Lists are off by the integral.
    let clips = [
        (format!("all({})", prism(5, [0.2, 0.0], 0.5)), 2, 0.5),
        (format!("not(all({}))", prism(8, [0.0, -0.1], 0.4)), 2, 0.5),
        (
            format!("all({}, {slab})", prism(6, [0.1, 0.0], 0.5)),
            3,
            0.5,
        ),
        ("box:-0.5,-0.3,3.6,0.6,0.4,4.3".to_owned(), 3, 0.5),
        (many.clone(), 3, 0.5),
        (format!("not({many})"), 2, 0.5),
        (most, 1, 0.5),
        (format!("any({many}, sphere:-1,0,4,.6)"), 2, 2.0),
        (format!("any({cylinder}, sphere:-1,0,4,.6)"), 8, 2.0),
        (
            format!("all(sphere:0,0,4,1.5, not({cylinder}), not({slab}))"),
            8,
            2.0,
        ),
        (
            format!("any(sphere:.1,0,4,.6, all({cylinder}, {slab}), box:-.75,-.25,4,.25,.75,1)"),
            4,
            2.0,
        ),
        (
            "any(sphere:0,0,3.8,.3, sphere:.5,.2,4.2,.4, sphere:-.4,.4,4,.3)".to_owned(),
            8,
            2.0,
        ),
    ];
    let mut wrong = Vec::new();
    for (view, camera) in cameras.iter().enumerate() {
        let camera = camera.as_ref().expect("a camera");
        let whole = alphas(camera, &Clip::default());
        for (expression, pixels, most) in &clips {
            let clip = clip_of(expression);
            let drawn = alphas(camera, &clip);
            let pairs = drawn.iter().zip(&whole).enumerate();
            let cut = pairs.filter(|(_, (alpha, whole))| {
                (0.05..0.95).contains(&(*alpha / *whole)) && **whole > 0.2
            });
            let off = cut.step_by(7).take(*pixels).map(|(index, (alpha, whole))| {
                let pixel = DVec2::new((index % 24) as f64, (index / 24) as f64) + 0.5;
                let rays = PixelRays::parallel(camera, &clip, pixel, STEPS);
                255.0 * (alpha - whole * rays.share(&ball, 0)).abs()
            });
            let worst = off.fold(0.0, f64::max);
            let expression = &expression[..expression.len().min(60)];
            println!("{view}, {expression}: {worst} of 255");
            if worst > *most {
                wrong.push(format!("{view}, {expression}: {worst} of 255"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Rays along each side of a pixel's grid: the integral is within half a level then, where a prism's sides are seen from their edges.
const STEPS: u32 = 240;

/// Where all long records together have too little room none is used, and what that concerns is counted.
#[test]
fn splats_that_too_many_surfaces_cut_are_counted() {
    let mut headless = common::headless();
    let one = ball();
    let target = DVec3::new(0.0, 0.0, 4.0);
    let camera = Camera::orthographic(DVec3::ZERO, target, DVec3::NEG_Y, 4.0, (24, 24));
    let camera = camera.expect("a camera");
    let clip = clip_of(&format!("all({})", prism(200, [0.2, 0.0], 0.5)));
    let settings = Settings::default().mode(Mode::Rara).raster(Raster::Tiles);
    for (count, are_shortened) in [(9_000, false), (10_000, true)] {
        let mut many = Gaussians::default();
        for _ in 0..count {
            many.push(
                one.positions()[0],
                one.scales()[0],
                one.rotations()[0],
                0.005,
                one.sh_of(0),
            );
        }
        headless.load(&many).expect("uploads");
        let stats = headless.render(&camera, &clip, &settings);
        let counts = stats.expect("renders").counts;
        assert_eq!(counts.cutoff, count);
        assert_eq!(counts.shortened, if are_shortened { count } else { 0 });
    }
}
