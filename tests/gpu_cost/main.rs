//! What frames cost a GPU, as far as it can be known without one: the commands that a frame records, how wide its passes are
//! and how long their chains of loads, and what a GPU's compiler makes of its pipelines. `budget.toml` says how much each may
//! have, so that a change that costs more has to change that file too.
//!
//! The compiler is Mesa's for AMD, RADV, on devices that the library of the package mesa-drm-shim pretends there are. It
//! compiles as for real ones; what it draws there means nothing, and nothing here looks at pictures or times.

#![allow(unreachable_pub, reason = "modules of one test share with each other")]

use std::collections::BTreeMap;

#[path = "../common/mod.rs"]
mod common;
// What shaders declare, as build.rs reads it.
#[path = "../../src/codegen/spirv.rs"]
#[allow(dead_code, reason = "the names and workgroups are a part of it")]
mod spirv;

mod budget;
mod frames;
mod model;
mod passes;
mod pipelines;

use budget::{Rule, Table};
use frames::{Frames, SMALL};
use rara::Raster;

/// The most dispatches and barriers of a frame whose clip cuts and which is drawn by tiles. Expected depths, which a host may
/// ask for besides, are a dispatch more.
const MOST: [u64; 2] = [32, 36];

#[test]
fn frames_record_no_more_commands_than_budgeted() {
    let frames = Frames::on_a_gpus_kernels(SMALL);
    let mut found = Table::new();
    for frame in frames.all().iter().filter(|frame| frame.is_counted()) {
        let recorded = frames.draw(frame).recorded;
        let count = [recorded.dispatches.len() as u64, recorded.barriers.into()];
        if frame.raster == Raster::Tiles && frame.planes > 0 && frame.moves == 0 {
            let most = [MOST[0] + u64::from(frame.wants_depth()), MOST[1]];
            assert!(
                count[0] <= most[0] && count[1] <= most[1],
                "{}: {count:?} dispatches and barriers, {most:?} are allowed whatever the budget says",
                frame.name
            );
        }
        let numbers = ["dispatches", "barriers"].into_iter().zip(count);
        found.insert(frame.name.clone(), numbers.collect());
    }
    frames.close();
    budget::check(BTreeMap::from([("frames".into(), found)]), Rule::Ceiling);
}
