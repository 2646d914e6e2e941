//! Properties that must not change a picture, checked on the GPU and under validation: how a cut is given, how a scene
//! is stored, where the world is.

mod cuts;
mod layers;
mod mirrors;
mod similarity;
mod worlds;

use std::cell::RefCell;

use crate::common;
use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use rara::scene::{Kind, generate};
use rara::{Camera, Clip, ClipOp, Gaussians, Headless, Picture, Plane, Settings};

const SIZE: (u32, u32) = (101, 77);
/// Cases of each property, unless `PROPTEST_CASES` is set.
const CASES: u32 = 12;

/// Runs a check on `CASES` values, with one device for all.
fn check<S: Strategy>(
    strategy: S,
    check: impl Fn(&mut Headless, S::Value) -> Result<(), TestCaseError>,
) {
    let headless = RefCell::new(common::headless());
    let config = Config {
        failure_persistence: None,
        // A case is some ten frames, so it is hardly shrunk; its message shows what a smaller one's would.
        max_shrink_iters: 20,
        cases: std::env::var("PROPTEST_CASES")
            .map_or(CASES, |cases| cases.parse().expect("a number")),
        ..Config::default()
    };
    TestRunner::new(config)
        .run(&strategy, |value| check(&mut headless.borrow_mut(), value))
        .unwrap_or_else(|error| panic!("{error}"));
}

fn draw(headless: &mut Headless, camera: &Camera, clip: &Clip, settings: &Settings) -> Picture {
    headless.render(camera, clip, settings).expect("renders");
    headless.picture().expect("reads back")
}

fn directions() -> impl Strategy<Value = DVec3> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0_f64]
        .prop_map(DVec3::from)
        .prop_filter_map("a direction", DVec3::try_normalize)
}

/// Planes through the unit ball about the origin, where the scenes are.
fn planes(count: impl Into<prop::collection::SizeRange>) -> impl Strategy<Value = Vec<Plane>> {
    let plane =
        (directions(), -0.5..0.5_f64).prop_map(|(normal, d)| Plane::new(normal, d).unwrap());
    prop::collection::vec(plane, count)
}

fn operations() -> impl Strategy<Value = ClipOp> {
    prop::sample::select(vec![ClipOp::And, ClipOp::Or])
}

/// A view of the unit ball from outside.
fn views() -> impl Strategy<Value = Camera> {
    (directions(), 2.0..4.0_f64).prop_filter_map("not along up", |(from, distance)| {
        Camera::look_at(from * distance, DVec3::ZERO, -DVec3::Y, 50.0, SIZE).ok()
    })
}

fn scenes() -> impl Strategy<Value = Gaussians> {
    let kinds = vec![Kind::General, Kind::Strands, Kind::Layers];
    (prop::sample::select(kinds), 0..1000_u64).prop_map(|(kind, seed)| generate(kind, 1500, seed))
}
