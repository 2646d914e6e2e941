//! The stress suite under validation: what `rara-lab stress --validation` prints, held to its targets. That runs all cases; here
//! are three of the five of each regime, whose truth takes minutes to compute.

use crate::common;
use rara_lab::stress::{self, Regime, RegimeRow};

/// Runs every regime, so that a failure shows the whole table.
fn check(regimes: Vec<Regime>) {
    let mut headless = common::headless();
    let run = |regime: &Regime| -> RegimeRow {
        // The first, the third and the last of five cases run, which is the crowd; on slow drivers the first and the last.
        let every = if common::scale() < 1.0 { 4 } else { 2 };
        let row = stress::run(&mut headless, regime, every);
        row.unwrap_or_else(|error| panic!("{}: {error}", regime.name))
    };
    let rows: Vec<_> = regimes.iter().map(run).collect();
    let failed: Vec<_> = rows.iter().filter(|row| !row.ok).collect();
    assert!(failed.is_empty(), "{failed:#?}");
    // A regime that draws nothing would pass, so only one, which is meant to, may draw nothing.
    let empty = rows
        .iter()
        .filter(|row| row.splats == 0)
        .map(|row| row.regime);
    assert!(empty.eq(regimes.iter().filter(|r| r.empty).map(|r| r.name)));
}

#[test]
fn shapes() {
    check(stress::shapes());
}

#[test]
fn places() {
    check(stress::places());
}

#[test]
fn planes() {
    check(stress::planes());
}

#[test]
fn regions() {
    check(stress::regions());
}

#[test]
fn meshes() {
    check(stress::meshes());
}

#[test]
fn frames_and_files() {
    check([stress::frames(), stress::files()].concat());
}
