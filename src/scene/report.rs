//! The report on what a loader had to leave out or put right, for people and for statistics.

use std::fmt;

use rara_base::counted::counted;

/// How many elements of each kind are named; the rest is only counted.
const NAMED: usize = 5;

/// One element that was dropped or repaired.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remark {
    /// Number of the element in the file, counted from 0.
    pub element: u64,
    /// The reason why it was dropped or repaired.
    pub reason: String,
}

/// A loader's changes to a file's elements.
///
/// *Dropped* elements hold a number that is not finite (or is not once converted to single precision, or whose scale
/// is not once exponentiated); nothing sensible can be drawn from them. *Repaired* elements have a quaternion of four
/// zeros, which became the identity, or an infinity that stands for a finite value: the logit of opacity 0 or 1, the
/// logarithm of scale 0. Bringing an ordinary quaternion to length one is no repair: trainers store them
/// unnormalised on purpose.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct LoadReport {
    /// Elements left out.
    pub dropped: u64,
    /// Elements kept with a value put right.
    pub repaired: u64,
    /// The first few dropped elements.
    pub first_dropped: Vec<Remark>,
    /// The first few repaired elements.
    pub first_repaired: Vec<Remark>,
    /// Bytes that follow the declared data (0 also where a list makes their number unknowable).
    pub trailing_bytes: u64,
    /// Sentences that say what else the loader left out, replaced or assumed.
    pub notes: Vec<String>,
}

impl LoadReport {
    /// True when the file needed no intervention at all.
    pub fn is_clean(&self) -> bool {
        *self == Self::default()
    }

    /// Counts a dropped element; `reason` is only called for the first few.
    pub(crate) fn drop_element(&mut self, element: u64, reason: impl FnOnce() -> String) {
        self.dropped += 1;
        remember(&mut self.first_dropped, element, reason);
    }

    /// Counts a repaired element; `reason` is only called for the first few.
    pub(crate) fn repair_element(&mut self, element: u64, reason: impl FnOnce() -> String) {
        self.repaired += 1;
        remember(&mut self.first_repaired, element, reason);
    }

    /// Says what was left out.
    pub(crate) fn note(&mut self, note: String) {
        self.notes.push(note);
    }

    /// Says that `what` was left out, where there is any: its names.
    pub(crate) fn left_out(&mut self, what: &str, names: &[String]) {
        if !names.is_empty() {
            self.note(format!("left out {what}: {}", names.join(", ")));
        }
    }

    /// Adds the report on another part of the same scene, before which there were `before` elements.
    pub(crate) fn append(&mut self, other: Self, before: u64) {
        self.dropped += other.dropped;
        self.repaired += other.repaired;
        self.trailing_bytes += other.trailing_bytes;
        for (to, from) in [
            (&mut self.first_dropped, other.first_dropped),
            (&mut self.first_repaired, other.first_repaired),
        ] {
            for remark in from {
                remember(to, before + remark.element, || remark.reason);
            }
        }
        for note in other.notes {
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
    }

    /// One sentence for each kind of intervention; none for a clean file.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        let mut add = |count: u64, what: &str, first: &[Remark]| {
            if count == 0 {
                return;
            }
            let mut line = format!("{what} {}: ", counted(count, "Gaussian"));
            let named: Vec<_> = first
                .iter()
                .map(|remark| format!("element {} ({})", remark.element, remark.reason))
                .collect();
            line += &named.join(", ");
            if count > first.len() as u64 {
                line += &format!(" and {} more", count - first.len() as u64);
            }
            lines.push(line);
        };
        add(self.dropped, "dropped", &self.first_dropped);
        add(self.repaired, "repaired", &self.first_repaired);
        if self.trailing_bytes > 0 {
            lines.push(format!(
                "ignored {} byte(s) after the declared data",
                self.trailing_bytes
            ));
        }
        lines.extend_from_slice(&self.notes);
        lines
    }
}

impl fmt::Display for LoadReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_clean() {
            return f.write_str("nothing dropped or repaired");
        }
        f.write_str(&self.lines().join("; "))
    }
}

fn remember(list: &mut Vec<Remark>, element: u64, reason: impl FnOnce() -> String) {
    if list.len() < NAMED {
        list.push(Remark {
            element,
            reason: reason(),
        });
    }
}
