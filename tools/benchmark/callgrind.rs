//! Reads what callgrind writes. `tests/files/benchmark.rs` tests it.

use std::collections::HashMap;
use std::path::Path;

/// Instructions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Counted {
    pub(crate) all: u64,
    /// Instructions in the program's own code; the others are in libraries and drivers.
    pub(crate) own: u64,
}

/// Sums up a `callgrind.out` with `Ir` as its only event (see Callgrind Format Specification in valgrind's manual).
pub(crate) fn read(text: &str, program: &Path) -> Counted {
    // Objects have a number, and their name only where they first appear.
    let mut objects: HashMap<&str, bool> = HashMap::new();
    let mut counted = Counted::default();
    let (mut own, mut inclusive) = (false, false);
    for line in text.lines() {
        if let Some((id, name)) = object(line) {
            if let Some(name) = name {
                objects.insert(id, Path::new(name) == program);
            }
            if line.starts_with("ob=") {
                own = objects.get(id).copied().unwrap_or(false);
            }
        } else if line.starts_with("calls=") {
            inclusive = true; // the next line is the called function's, which has lines of its own
        } else if line.starts_with(|c: char| c.is_ascii_digit() || "+-*".contains(c)) {
            let cost = line
                .rsplit_once(' ')
                .and_then(|(_, cost)| cost.parse().ok())
                .unwrap_or(0);
            if !inclusive {
                counted.all += cost;
                counted.own += if own { cost } else { 0 };
            }
            inclusive = false;
        }
    }
    counted
}

/// The number of an object, and its name where it first appears: `ob=(2) /lib/driver.so`, or `cob=` of a called one.
fn object(line: &str) -> Option<(&str, Option<&str>)> {
    let rest = line
        .strip_prefix("ob=")
        .or_else(|| line.strip_prefix("cob="))?;
    let (id, name) = rest.split_once(')')?;
    Some((id, name.strip_prefix(' ')))
}
