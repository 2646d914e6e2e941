//! Pictures of splats that random regions cut, against numerical integration that shares no formula with the renderer.
//!
//! Cases of small splats have few pixels, of which all are integrated; of large ones a few are, which stand for the rest.

mod meshes;

use std::thread;

use crate::common;
use glam::{DQuat, DVec2, DVec3};
use rara::clip::Expression;
use rara::{Camera, Clip, Decay, Gaussians, Headless, Mode, Raster, Settings};
use rara_reference::cutoff::cutting_count;
use rara_reference::quadrature::PixelRays;
use rara_reference::{Footprint, ViewTransform};

/// Random cases of each class of size, and the classes: standard deviations in pixels.
const CASES: usize = 64;
const CLASSES: [[f64; 2]; 5] = [
    [0.2, 1.0],
    [1.0, 5.0],
    [5.0, 30.0],
    [30.0, 100.0],
    [100.0, 300.0],
];
/// Most pixels of a case that are integrated, of those that the splat covers.
const PIXELS: usize = 24;
/// Most surfaces that cut a splat. A region is one of up to five shapes, of which a box has six.
const MOST_SURFACES: usize = 5;
/// Rays along each side of a pixel's grid.
const STEPS: u32 = 40;
/// Of each class, the largest share of the integrated pixels that may be more than 1/255 off, and the largest error, of 255.
const WORST: [[f64; 2]; 5] = [[0.002, 2.0], [0.0, 1.0], [0.0, 0.5], [0.0, 0.1], [0.0, 0.1]];
const SIZE: (u32, u32) = (96, 72);
const FOCAL: f64 = 90.0;

/// Random numbers, the same ones in every run.
struct Dice(Box<dyn FnMut(usize) -> usize>);

impl Dice {
    fn new(seed: u64) -> Self {
        Self(Box::new(common::picker(seed)))
    }

    fn unit(&mut self) -> f64 {
        (self.0)(1 << 30) as f64 / f64::from(1 << 30)
    }

    fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// From `low` to `high`, every factor as likely as the next.
    fn factor(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    fn direction(&mut self) -> DVec3 {
        let z = self.range(-1.0, 1.0);
        let (sin, cos) = self.range(0.0, std::f64::consts::TAU).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cos, radius * sin, z)
    }

    fn turn(&mut self) -> DQuat {
        DQuat::from_axis_angle(self.direction(), self.range(0.0, std::f64::consts::TAU))
    }
}

/// One splat, a view of it, a region that cuts it, and the rays along each side of a pixel's grid.
struct Case {
    steps: u32,
    gaussians: Gaussians,
    camera: Camera,
    region: String,
    clip: Clip,
}

impl Case {
    /// As [`any`](Self::any), cut by 1 to 5 surfaces.
    fn random(dice: &mut Dice, sizes: [f64; 2]) -> Self {
        loop {
            let case = Self::any(dice, sizes);
            if (1..=MOST_SURFACES).contains(&case.cutting()) {
                return case;
            }
        }
    }

    /// How many surfaces pass through the splat, as far as it reaches.
    fn cutting(&self) -> usize {
        let view = ViewTransform::<f64>::new(&self.camera);
        let settings = Settings::default();
        let footprint = Footprint::new(&self.gaussians, 0, &view);
        footprint.map_or(0, |seen| {
            cutting_count(&self.gaussians, 0, &seen, &self.clip, &settings)
        })
    }

    /// A splat of this size in pixels somewhere in the picture, and 1 to 5 shapes about it.
    fn any(dice: &mut Dice, sizes: [f64; 2]) -> Self {
        let (gaussians, camera) = splat(dice, sizes);
        let count = 1 + (dice.unit() * 5.0) as usize;
        let mut parts: Vec<_> = (0..count).map(|_| shape(dice, &gaussians)).collect();
        while parts.len() > 1 {
            let name = if dice.unit() < 0.5 { "all" } else { "any" };
            let (a, b) = (parts.remove(0), parts.remove(0));
            parts.push(format!("{name}({a}, {b})"));
        }
        let region = parts.remove(0);
        let expression: Expression = region.parse().expect("an expression");
        Self {
            steps: STEPS,
            clip: expression.clip(),
            gaussians,
            camera,
            region,
        }
    }

    /// The share that integration finds in the middle of a pixel.
    fn share(&self, pixel: usize) -> f64 {
        let width = SIZE.0 as usize;
        let middle = DVec2::new((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
        PixelRays::parallel(&self.camera, &self.clip, middle, self.steps).share(&self.gaussians, 0)
    }
}

/// A splat of this size in pixels somewhere in a camera's picture. Large ones reach around the eye.
fn splat(dice: &mut Dice, [low, high]: [f64; 2]) -> (Gaussians, Camera) {
    let eye = DVec3::new(0.3, -0.2, 0.1);
    let camera = Camera::look_at(eye, eye + dice.direction(), dice.direction(), 50.0, SIZE);
    let camera = camera.expect("two random directions").fx(FOCAL).fy(FOCAL);
    let depth = dice.range(1.0, 4.0);
    let sigma = dice.factor(low, high) * depth / FOCAL;
    let aside = DVec2::new(dice.range(-0.4, 0.4), dice.range(-0.3, 0.3)) * depth;
    let centre = eye + camera.rotation.transpose() * aside.extend(depth);
    let scales = DVec3::new(1.0, dice.factor(0.1, 1.0), dice.factor(0.1, 1.0)) * sigma;
    let turn = dice.turn().as_quat();
    let mut gaussians = Gaussians::default();
    let opacity = dice.range(0.5, 0.99) as f32;
    gaussians.push(centre.as_vec3(), scales.as_vec3(), turn, opacity, &[1.0; 3]);
    (gaussians, camera)
}

/// A random direction, a place of the splat up to 2 deviations from its centre along it, and its deviation along it.
fn place(dice: &mut Dice, splat: &Gaussians) -> (DVec3, DVec3, f64) {
    let normal = dice.direction();
    let turn = splat.rotations()[0].as_dquat();
    let deviation = (turn.inverse() * normal * splat.scales()[0].as_dvec3()).length();
    let at = splat.centre(0) + normal * deviation * dice.range(-2.0, 2.0);
    (normal, at, deviation)
}

/// The text of a random shape whose surface passes through a point of the splat. Its radius is 3 to 100 of the splat's
/// largest deviations.
fn shape(dice: &mut Dice, splat: &Gaussians) -> String {
    let (normal, at, deviation) = place(dice, splat);
    let scales = splat.scales()[0].as_dvec3();
    let radius = dice.factor(3.0, 100.0) * scales.max_element();
    let middle = at - normal * radius;
    let aside = normal.cross(dice.direction()).normalize();
    let list = |v: DVec3| format!("{},{},{}", v.x, v.y, v.z);
    let turned = |axis: DVec3| {
        let turn = DQuat::from_rotation_arc(axis, normal);
        format!("{},{},{},{}", turn.w, turn.x, turn.y, turn.z)
    };
    let wide = |dice: &mut Dice| radius * dice.range(1.0, 3.0);
    let not = if dice.unit() < 0.5 { "!" } else { "" };
    let shape = match (dice.unit() * 8.0) as u32 {
        0 => format!("plane:{},{}", list(normal), -normal.dot(at)),
        1 => {
            let thickness = dice.range(1.0, 3.0) * deviation;
            format!("slab:{},{},{thickness}", list(normal), -normal.dot(at))
        }
        2 => {
            let half = DVec3::new(radius, wide(dice), wide(dice));
            format!("box:{},{},{}", list(middle), list(half), turned(DVec3::X))
        }
        3 => format!("sphere:{},{radius}", list(middle)),
        4 => {
            let radii = DVec3::new(radius, wide(dice), wide(dice));
            format!(
                "ellipsoid:{},{},{}",
                list(middle),
                list(radii),
                turned(DVec3::X)
            )
        }
        5 => {
            let half = aside * wide(dice);
            format!(
                "cylinder:{},{},{radius}",
                list(middle - half),
                list(middle + half)
            )
        }
        6 => {
            let half = aside * wide(dice);
            format!(
                "capsule:{},{},{radius}",
                list(middle - half),
                list(middle + half)
            )
        }
        _ => {
            // The side passes through the point half way down.
            let half = aside * wide(dice);
            format!(
                "cone:{},{},{}",
                list(middle - half),
                list(middle + half),
                2.0 * radius
            )
        }
    };
    format!("{not}{shape}")
}

/// The errors of alpha in the pixels of a class, in units of 1/255.
#[derive(Debug, Default)]
struct Errors {
    /// Pixels that the splats cover, and how many of them are more than a level off, by those that are integrated.
    covered: f64,
    off: f64,
    pixels: usize,
    partial: usize,
    over_one: usize,
    sum: f64,
    worst: f64,
    worst_case: String,
}

impl Errors {
    /// Adds a pixel that stands for so many, by its uncut alpha, what is drawn of it, and the share that is left.
    fn add(&mut self, case: &Case, each: f64, [whole, found, share]: [f64; 3]) {
        let error = 255.0 * (found - whole * share).abs();
        self.covered += each;
        self.off += if error > 1.0 { each } else { 0.0 };
        self.pixels += 1;
        self.partial += usize::from((0.01..0.99).contains(&share));
        self.over_one += usize::from(error > 1.0);
        self.sum += error;
        if error > self.worst {
            self.worst = error;
            self.worst_case = format!("share {share:.4}, alpha {whole:.4}: {}", case.region);
        }
    }
}

/// Draws a case and compares pixels that it covers.
fn study(headless: &mut Headless, dice: &mut Dice, case: &Case, errors: &mut Errors) {
    let whole = Settings::default().mode(Mode::None);
    let whole =
        rara_reference::render::<f64>(&case.gaussians, &case.camera, &Clip::default(), &whole);
    let alpha = |pixel: usize| f64::from(whole.picture.pixels[pixel][3]);
    let mut covered: Vec<usize> = (0..whole.picture.pixels.len())
        .filter(|&pixel| alpha(pixel) > 1.01 / 255.0)
        .collect();
    let all = covered.len() as f64;
    while covered.len() > PIXELS {
        let drop = (dice.unit() * covered.len() as f64) as usize;
        covered.swap_remove(drop);
    }
    headless.load(&case.gaussians).expect("uploads");
    // The decay is linear, so that a pixel's alpha is alpha times weight.
    let settings = Settings::default()
        .raster(Raster::Tiles)
        .decay(Some(Decay::Linear));
    headless
        .render(&case.camera, &case.clip, &settings)
        .expect("renders");
    let picture = headless.picture().expect("reads back");
    let (first, second) = covered.split_at(covered.len() / 2);
    let shares = |pixels: &[usize]| pixels.iter().map(|&p| case.share(p)).collect::<Vec<_>>();
    let shares = thread::scope(|scope| {
        let other = scope.spawn(|| shares(second));
        let mut all = shares(first);
        all.extend(other.join().expect("integrates"));
        all
    });
    let each = all / covered.len().max(1) as f64;
    for (pixel, share) in covered.into_iter().zip(shares) {
        let found = f64::from(picture.pixels[pixel][3]);
        // Behind the eye's tail there is nothing to integrate.
        if share.is_finite() {
            errors.add(case, each, [alpha(pixel), found, share]);
        }
    }
}

#[test]
fn random_regions_keep_what_integration_finds() {
    let mut headless = common::headless();
    let mut dice = Dice::new(2026);
    let cases = (CASES as f64 * common::scale()) as usize;
    let all: Vec<_> = CLASSES
        .iter()
        .map(|class| {
            let mut errors = Errors::default();
            for _ in 0..cases {
                let case = Case::random(&mut dice, *class);
                study(&mut headless, &mut dice, &case, &mut errors);
            }
            println!(
                "{class:?} px: {} pixels, {} partial; mean {:.4}, over 1/255 {}, worst {:.2} ({})",
                errors.pixels,
                errors.partial,
                errors.sum / errors.pixels as f64,
                errors.over_one,
                errors.worst,
                errors.worst_case
            );
            errors
        })
        .collect();
    let sum = |of: fn(&Errors) -> f64| all.iter().map(of).sum::<f64>();
    assert!(sum(|e| e.partial as f64) > 0.2 * sum(|e| e.pixels as f64));
    let off = sum(|e| e.off) / sum(|e| e.covered);
    println!(
        "{:.4} % of the covered pixels are more than 1/255 off",
        100.0 * off
    );
    assert!(off <= 1e-4, "{all:#?}");
    // Where more than three surfaces meet within a splat smaller than a pixel, lines at a lattice's points stand for it.
    for (errors, [over, worst]) in all.iter().zip(WORST) {
        let share = errors.over_one as f64 / errors.pixels as f64;
        assert!(share <= over && errors.worst <= worst, "{errors:#?}");
    }
}
