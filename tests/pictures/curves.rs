//! Cut splats whose weight is a fitted curve (glsl/curve.glsl), which has no twin on the CPU: random large, long and flat
//! ones, in pictures large enough for single precision to matter, against the perspective-exact form in f64.

use crate::common;
use glam::{DQuat, DVec3, Quat};
use rara::{Camera, Clip, ClipOp, ExactForm, Gaussians, Mode, Plane, Raster, Settings};

/// How much a pixel may be off: the fit's tolerance, Phi's error, and what the rounding of a pixel's place to single
/// precision changes in alpha in splats of hundreds of pixels.
const TOLERANCE: f64 = 1.5e-4 + 2e-5 + 1.3e-4;

const CASES: usize = 90;

struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn direction(&mut self) -> DVec3 {
        let (z, turn) = (
            self.between(-1.0, 1.0),
            self.between(0.0, std::f64::consts::TAU),
        );
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z)
    }
}

/// A white splat before a camera that looks along z, and a plane through it.
fn case(random: &mut Random, size: u32) -> (Gaussians, Camera, Clip) {
    let depth = random.between(1.0, 4.0);
    let focal = f64::from(size) * random.between(0.6, 1.5);
    let half = 0.5 * f64::from(size) / focal;
    let aside = |random: &mut Random| depth * half * random.between(-0.9, 0.9);
    let centre = DVec3::new(aside(random), aside(random), depth);
    let largest = depth * 10_f64.powf(random.between(-2.2, -0.7));
    let thin = largest * 10_f64.powf(-random.between(0.0, 4.0));
    let middle = if random.between(0.0, 1.0) < 0.5 {
        thin
    } else {
        largest
    };
    let turn = DQuat::from_axis_angle(random.direction(), random.between(0.0, 6.0));
    let scales = DVec3::new(largest, middle, thin);
    let normal = random.direction();
    let deviation = ((turn.inverse() * normal) * scales).length();
    let offset = -normal.dot(centre) + random.between(-2.0, 2.0) * deviation;
    let mut scene = Gaussians::default();
    scene.push(
        centre.as_vec3(),
        scales.as_vec3(),
        Quat::from_array(turn.as_quat().to_array()).normalize(),
        random.between(0.1, 1.0) as f32,
        &[0.5 / 0.282_094_79; 3],
    );
    let camera = Camera::look_at(
        DVec3::ZERO,
        DVec3::Z,
        DVec3::NEG_Y,
        2.0 * half.atan().to_degrees(),
        (size, size),
    );
    let plane = Plane::new(normal, offset).expect("a finite normal");
    let clip = Clip::of([plane], ClipOp::And);
    (scene, camera.expect("a camera"), clip)
}

#[test]
fn fitted_weights_are_the_exact_ones() {
    let mut headless = common::headless();
    let mut random = Random(1);
    let (mut worst, mut cut) = (0.0_f64, 0);
    for index in 0..CASES {
        let size = [384, 768, 1536][index % 3];
        let (scene, camera, clip) = case(&mut random, size);
        headless.load(&scene).expect("uploads");
        let raster = if index % 2 == 0 {
            Raster::Tiles
        } else {
            Raster::Quad
        };
        let settings = Settings::default().mode(Mode::Exact).raster(raster);
        let stats = headless.render(&camera, &clip, &settings).expect("renders");
        cut += stats.counts.cutoff;
        let truth = settings.form(ExactForm::Beam).trace_all(true);
        let truth = rara_reference::render::<f64>(&scene, &camera, &clip, &truth).picture;
        let picture = headless.picture().expect("reads back");
        // Alpha alone is compared, since no colour scales it. On the splat's contour rounding decides whether a pixel has
        // any.
        let pairs = picture.pixels.iter().zip(&truth.pixels);
        let pairs = pairs.map(|(a, b)| (f64::from(a[3]), f64::from(b[3])));
        let on_contour = |a: f64, b: f64| a.min(b) == 0.0 && a.max(b) < 1.001 / 255.0;
        let off = pairs
            .filter(|&(a, b)| !on_contour(a, b))
            .map(|(a, b)| (a - b).abs());
        // A splat that is not called cut may change by half a level.
        let allowed = if stats.counts.cutoff == 0 {
            0.5 / 255.0
        } else {
            TOLERANCE
        };
        let most = off.fold(0.0, f64::max);
        println!("{index}: {size} px, off by {most:.1e}, {:?}", stats.counts);
        worst = if stats.counts.cutoff == 0 {
            worst
        } else {
            worst.max(most)
        };
        assert!(
            most <= allowed,
            "case {index}: alpha is off by {most:.1e}: {scene:?} {clip:?}"
        );
    }
    println!("{cut} cut splats, the worst off by {worst:.1e}");
    assert!(2 * cut > CASES as u32, "only {cut} are cut");
}
