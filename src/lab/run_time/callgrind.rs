//! Reads what callgrind writes.

use std::collections::HashMap;
use std::path::Path;

/// Instructions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct InstructionCounts {
    pub(super) all: u64,
    /// Instructions in the program's own code; the others are in libraries and drivers.
    pub(super) own: u64,
}

/// Sums up a `callgrind.out` with `Ir` as its only event (see Callgrind Format Specification in valgrind's manual).
pub(super) fn read(text: &str, program: &Path) -> InstructionCounts {
    // Objects have a number, and their name only where they first appear.
    let mut objects: HashMap<&str, bool> = HashMap::new();
    let mut counted = InstructionCounts::default();
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

#[cfg(test)]
mod tests {
    use super::*;

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
            InstructionCounts {
                all: 1165,
                own: 165
            }
        );
        assert_eq!(
            read("", Path::new("/bin/ours")),
            InstructionCounts::default()
        );
    }
}
