//! Variants that are compared take turns, so that other work on the machine disturbs all of them alike.

use std::time::{Duration, Instant};

use rara::Result;

/// How many rounds there are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rounds {
    pub(crate) most: u32,
    pub(crate) least: u32,
    /// After this long, the least number of rounds is enough.
    pub(crate) enough: Duration,
}

/// Measures `count` things in turn, `one(thing, round)`; the results by thing, then by round. The round 0 comes first
/// and its results are dropped: it compiles, allocates and fills caches.
pub(crate) fn in_turn<T>(
    rounds: Rounds,
    count: usize,
    mut one: impl FnMut(usize, u32) -> Result<T>,
) -> Result<Vec<Vec<T>>> {
    for thing in 0..count {
        one(thing, 0)?;
    }
    let mut results: Vec<Vec<T>> = (0..count).map(|_| Vec::new()).collect();
    let begin = Instant::now();
    for round in 1..=rounds.most {
        if round > rounds.least && begin.elapsed() > rounds.enough {
            break;
        }
        // The order alternates, so that none always follows the same one.
        let mut order: Vec<usize> = (0..count).collect();
        if round % 2 == 0 {
            order.reverse();
        }
        for thing in order {
            results[thing].push(one(thing, round)?);
        }
    }
    Ok(results)
}
