//! The parts of tools/bench that can be tested without measuring; a benchmark has no test harness of its own.

use std::path::Path;

#[path = "../../tools/benchmark/callgrind.rs"]
mod callgrind;
#[path = "../../tools/benchmark/fragments.rs"]
mod fragments;
#[path = "../../tools/benchmark/statistics.rs"]
mod statistics;

use callgrind::{Counted, read};
use rara::glam::{DVec3, Quat, Vec3};
use rara::{Camera, Gaussians, Settings};
use statistics::{Summary, ratios};

fn of(values: &[f64]) -> (usize, f64, f64, f64) {
    let s = Summary::of(values);
    (s.n, s.min, s.median, s.p90)
}

#[test]
fn summaries_do_not_depend_on_order() {
    assert_eq!(of(&[7.0]), (1, 7.0, 7.0, 7.0));
    assert_eq!(of(&[4.0, 1.0, 9.0, 2.0]), (4, 1.0, 3.0, 9.0));
    let ten: Vec<f64> = (1..=10).rev().map(f64::from).collect();
    assert_eq!(of(&ten), (10, 1.0, 5.5, 9.0));
    let eleven: Vec<f64> = (1..=11).map(f64::from).collect();
    assert_eq!(of(&eleven), (11, 1.0, 6.0, 10.0));
}

#[test]
fn nothing_measured_is_no_number() {
    let nothing = Summary::of(&[]);
    assert_eq!(nothing.n, 0);
    assert!(nothing.min.is_nan() && nothing.median.is_nan() && nothing.p90.is_nan());
}

#[test]
fn ratios_are_of_pairs() {
    // The second round was disturbed; the ratio was not.
    let ratios = ratios(&[2.0, 20.0, 2.2], &[1.0, 10.0, 1.0]);
    assert_eq!(ratios, [2.0, 2.0, 2.2]);
    assert_eq!(Summary::of(&ratios).median, 2.0);
}

#[test]
fn costs_are_kept_apart_and_counted_once() {
    let text = "\
version: 1
positions: line
events: Ir
summary: 1165

ob=(1) /bin/ours
fl=(1) a.rs
fn=(1) main
16 100
+2 5
cob=(2) /lib/driver.so
cfn=(2) record
calls=3 50
18 1000
* 10

ob=(2)
fn=(2)
50 1000

ob=(1)
fn=(3) more
-1 50
totals: 1165
";
    let counted = read(text, Path::new("/bin/ours"));
    assert_eq!(
        counted,
        Counted {
            all: 1165,
            own: 165
        }
    );
    assert_eq!(read("", Path::new("/bin/ours")), Counted::default());
}

#[test]
fn fragments_count_until_a_pixel_is_saturated() {
    let eye = DVec3::new(0.0, 0.0, -4.0);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, (37, 41)).expect("a view");
    let count = |copies, scale, opacity| {
        let mut scene = Gaussians::default();
        for _ in 0..copies {
            let scale = Vec3::splat(scale);
            scene.push(Vec3::ZERO, scale, Quat::IDENTITY, opacity, &[0.0; 3]);
        }
        fragments::count(&scene, &camera, &Settings::default())
    };
    // Larger than the picture: 1/100 of the light is left, then 1e-4, then 1e-6, where 4e-6 are enough.
    assert_eq!(count(10, 200.0, 1.0), 3 * 37 * 41);
    assert_eq!(count(10, 200.0, 0.1), 10 * 37 * 41);
    let small = count(1, 0.1, 0.5);
    assert!((10..200).contains(&small), "{small}");
    assert_eq!(count(5, 0.1, 0.003), 0, "below 1/255");
}
