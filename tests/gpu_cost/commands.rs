//! The commands of real frames, held to ceilings.

use std::collections::BTreeMap;

use rara::Raster;
use rara_gpu::RecordedCommands;

use crate::gpu_cost::budget::{self, Rule, Table};
use crate::gpu_cost::frames::{Frame, Frames, SMALL};

/// The most dispatches and barriers of a frame whose clip cuts and which is drawn by tiles. Expected depths, which a host may
/// ask for besides, are a dispatch more.
const MOST: [u64; 2] = [32, 36];

#[test]
fn frames_have_the_commands_in_the_budget() {
    let frames = Frames::on_a_gpus_pipelines(SMALL);
    let mut found = Table::new();
    for frame in frames.all().iter().filter(|frame| frame.is_counted()) {
        let count = commands(frame, &frames.draw(frame));
        let numbers = ["dispatches", "barriers"].into_iter().zip(count);
        found.insert(frame.name.clone(), numbers.collect());
    }
    frames.close();
    budget::check(BTreeMap::from([("frames".into(), found)]), Rule::Ceiling);
}

/// The dispatches and barriers of a frame.
fn commands(frame: &Frame, recorded: &RecordedCommands) -> [u64; 2] {
    let count = [recorded.dispatches.len() as u64, recorded.barriers.into()];
    if frame.raster == Raster::Tiles && frame.planes > 0 && frame.moves == 0 {
        let most = [MOST[0] + u64::from(frame.wants_depth()), MOST[1]];
        assert!(
            count[0] <= most[0] && count[1] <= most[1],
            "{}: {count:?} dispatches and barriers, {most:?} are allowed whatever the budget says",
            frame.name
        );
    }
    count
}
