//! `--part`: the part of several jobs that one of them draws.

use std::fmt;
use std::str::FromStr;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct RunPart {
    /// The number of the part, from 1.
    number: u32,
    of: u32,
}

impl FromStr for RunPart {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/');
        let numbers =
            numbers.and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if (1..=of).contains(&number) => Ok(Self { number, of }),
            Some((number, of)) if of > 0 => Err(format!(
                "there is no part {number} of {of}: give a part from 1/{of} to {of}/{of}"
            )),
            _ => Err(
                "expected the number of a part and the number of all parts, such as 3/10".into(),
            ),
        }
    }
}

impl RunPart {
    /// The ones of `all` that are in this part. Parts follow each other, and differ by one at most.
    pub(super) fn take_from<T>(self, mut all: Vec<T>) -> Vec<T> {
        let count = all.len() as u128;
        // At most as large as the count.
        let end = |part: u32| (count * u128::from(part) / u128::from(self.of)) as usize;
        all.truncate(end(self.number));
        all.split_off(end(self.number - 1))
    }

    /// True if this is the part in which a share of the whole lies, from 0 to below 1.
    pub(in super::super) fn has(self, share: f64) -> bool {
        let part = (share * f64::from(self.of)) as u32;
        part.min(self.of - 1) == self.number - 1
    }
}

impl fmt::Display for RunPart {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests;
