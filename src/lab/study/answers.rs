//! The file that a participant's page saves, and what is checked of it.

use std::collections::HashSet;
use std::path::Path;

use rara::{Error, Result};
use serde::{Deserialize, Serialize};

use super::Metric;

pub(super) const FORMAT: &str = "rara study answers";
pub(super) const VERSION: u32 = 1;

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
pub struct Answers {
    format: String,
    version: u32,
    pub study: Study,
    /// The participant's code, without spaces around it and in capitals.
    pub participant: String,
    /// The group, 1 or 2.
    pub group: u8,
    pub background: Background,
    /// The time at which the study was begun, in ISO 8601.
    pub begun: String,
    /// The time at which the file was saved.
    pub saved: String,
    pub answers: Vec<Answer>,
    /// What was written about the methods.
    #[serde(default)]
    pub questions: Questions,
}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize, Serialize)]
pub struct Study {
    /// Changes with every picture.
    pub id: String,
    pub method: String,
    /// The names of the cases, in the order of the report.
    pub cases: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize, Serialize)]
pub struct Background {
    pub age: String,
    pub experience: String,
}

/// What was written at the end.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize, Serialize)]
#[serde(default)]
pub struct Questions {
    /// The properties that an ideal cut has.
    pub properties: String,
    pub limitations: String,
    pub strengths: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    Left,
    Right,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Which {
    Hard,
    Method,
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
pub struct Answer {
    pub case: String,
    pub metric: Metric,
    pub left: Which,
    pub choice: Side,
    /// How much better: 1, barely, to 7, extremely.
    pub strength: u8,
    /// How long it was looked at, milliseconds.
    pub ms: u64,
    /// How often choice or strength were set.
    pub changes: u64,
    pub at: String,
    /// Its place among the participant's items, from 1.
    pub position: u64,
}

impl Answer {
    /// The strength, positive for the method and negative for hard cuts.
    pub fn preference(&self) -> f64 {
        let is_left = self.choice == Side::Left;
        let is_method = is_left == (self.left == Which::Method);
        f64::from(self.strength) * if is_method { 1.0 } else { -1.0 }
    }
}

const AS_SAVED: &str = "use the file as the page has saved it";

impl Answers {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read; [`Error::Format`], which names the element, if it is not what a page saves.
    pub fn load(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).map_err(Error::io(path))?;
        Self::read(&bytes).map_err(|message| Error::format(path, message))
    }

    /// Reads the bytes of a file; an error names the element.
    fn read(bytes: &[u8]) -> std::result::Result<Self, String> {
        // A byte order mark is what editors and mail programs add.
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut json = serde_json::Deserializer::from_slice(bytes);
        let read: std::result::Result<Self, _> = serde_path_to_error::deserialize(&mut json);
        let mut answers = read.map_err(|error| {
            let element = error.path().to_string();
            let error = error.into_inner();
            format!("{element}: {error}; {AS_SAVED}")
        })?;
        json.end().map_err(|error| format!("{error}; {AS_SAVED}"))?;
        answers.participant = answers.participant.trim().to_uppercase();
        answers.check()?;
        Ok(answers)
    }

    fn check(&self) -> std::result::Result<(), String> {
        let refused = |element: &str, what: String| Err(format!("{element}: {what}; {AS_SAVED}"));
        if self.format != FORMAT {
            return refused("format", format!("{:?} is not {FORMAT:?}", self.format));
        }
        if self.version != VERSION {
            let (version, known) = (self.version, VERSION);
            return Err(format!(
                "version: this is version {version} and the report knows {known}; use the rara that wrote the page"
            ));
        }
        if self.participant.is_empty() {
            return refused("participant", "the code is empty".into());
        }
        if !(1..=2).contains(&self.group) {
            return refused("group", format!("{} is neither 1 nor 2", self.group));
        }
        let cases: HashSet<_> = self.study.cases.iter().collect();
        if cases.len() < self.study.cases.len() {
            return refused("study.cases", "two cases have the same name".into());
        }
        let mut seen = HashSet::new();
        for (number, answer) in self.answers.iter().enumerate() {
            let element = |name: &str| format!("answers[{number}].{name}");
            let strength = answer.strength;
            if !(1..=7).contains(&strength) {
                return refused(&element("strength"), format!("{strength} is not 1 to 7"));
            }
            if !cases.contains(&answer.case) {
                let what = format!("the study has no case {:?}", answer.case);
                return refused(&element("case"), what);
            }
            if !seen.insert((&answer.case, answer.metric)) {
                let name = answer.metric.name();
                let what = format!("{:?} is answered twice for {name}", answer.case);
                return refused(&element("metric"), what);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
pub(super) mod tests;
