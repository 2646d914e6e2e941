//! Dispatches that do next to nothing, each waiting for the one before: no frame of so many stages takes less time.

use rara::{Headless, Result};

use super::numbers::Measurements;
use super::rates::Rates;
use super::run::Run;
use super::world::World;
use crate::frames::in_turn;

pub(super) fn measure(run: &mut Run<'_>, _: &World, mut numbers: Measurements) -> Result<()> {
    let headless = Headless::new(&run.options.device)?;
    let rates = Rates::new(headless.device(), 64 << 20)?;
    let rounds = in_turn(run.rounds(), 1, |_, _| rates.fixed())?.remove(0);
    for (index, (name, _)) in rounds[0].iter().enumerate() {
        let values = rounds.iter().map(|round| round[index].1).collect();
        numbers.add("", name, "us", values);
    }
    run.finish(&numbers)
}
