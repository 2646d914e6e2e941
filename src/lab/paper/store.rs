//! Results that are kept, so that a run that was interrupted goes on where it stopped.

use std::path::{Path, PathBuf};
use std::time::Instant;

use rara::{Error, Result};
use rara_base::files::write_atomically;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::cases::plain;

#[derive(Debug, Clone, PartialEq)]
pub struct PaperProgress {
    pub what: String,
    pub done: usize,
    pub parts: usize,
    /// The seconds that the rest will take if it goes on as it did; `None` before anything was measured.
    pub seconds_left: Option<f64>,
}

/// The folder in which results lie, and what they are results of.
pub(super) struct Store<'a> {
    folder: PathBuf,
    /// What all results depend on: version, device, driver, scenes and options.
    origin: String,
    /// The parts that are still to come, with estimates of their work in any unit.
    plan: Vec<(String, f64)>,
    parts: usize,
    /// The seconds that all parts so far have taken, in whichever run.
    pub(super) seconds: f64,
    /// Work that was measured in this run, and the seconds it took.
    measured: (f64, f64),
    progress: &'a mut dyn FnMut(&PaperProgress),
}

#[derive(Serialize, Deserialize)]
struct CacheRecord<T> {
    origin: String,
    seconds: f64,
    result: T,
}

impl<'a> Store<'a> {
    /// A store of these parts, which are asked for in this order.
    pub(super) fn new(
        folder: &Path,
        origin: String,
        plan: Vec<(String, f64)>,
        progress: &'a mut dyn FnMut(&PaperProgress),
    ) -> Result<Self> {
        let folder = folder.join("parts");
        std::fs::create_dir_all(&folder).map_err(Error::io(&folder))?;
        let parts = plan.len();
        Ok(Self {
            folder,
            origin,
            plan,
            parts,
            seconds: 0.0,
            measured: (0.0, 0.0),
            progress,
        })
    }

    /// The result of the next part: what an earlier run has kept of the same origin, or what `measure` returns, which is kept.
    pub(super) fn part<T: Serialize + DeserializeOwned>(
        &mut self,
        measure: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        let left = self.plan.len();
        let progress = PaperProgress {
            what: self
                .plan
                .first()
                .map_or(String::new(), |(name, _)| name.clone()),
            done: self.parts - left,
            parts: self.parts,
            seconds_left: self.seconds_left(),
        };
        (self.progress)(&progress);
        let (name, work) = self.plan.remove(0);
        let file = self.folder.join(plain(&name) + ".json");
        if let Some(known) = self.read(&file) {
            self.seconds += known.seconds;
            return Ok(known.result);
        }
        let begin = Instant::now();
        let result = measure()?;
        let seconds = begin.elapsed().as_secs_f64();
        self.measured.0 += work;
        self.measured.1 += seconds;
        self.seconds += seconds;
        let stored = CacheRecord {
            origin: self.origin.clone(),
            seconds,
            result,
        };
        let text = serde_json::to_string(&stored).expect("results have string keys only");
        write_atomically(&file, |file| file.write_all(text.as_bytes()))?;
        Ok(stored.result)
    }

    fn seconds_left(&self) -> Option<f64> {
        let (work, seconds) = self.measured;
        // Parts that an earlier run has kept take no time.
        let left = self.plan.iter();
        let left = left.filter(|(name, _)| !self.folder.join(plain(name) + ".json").exists());
        (work > 0.0).then(|| seconds / work * left.map(|(_, work)| work).sum::<f64>())
    }

    /// What was kept, if it is whole and of the same origin.
    fn read<T: DeserializeOwned>(&self, file: &Path) -> Option<CacheRecord<T>> {
        let text = std::fs::read_to_string(file).ok()?;
        let stored: CacheRecord<T> = serde_json::from_str(&text).ok()?;
        (stored.origin == self.origin).then_some(stored)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_measured_is_not_measured_again_unless_it_is_of_another_origin() {
        let folder = std::env::temp_dir().join(format!("rara-lab-store-{}", std::process::id()));
        let plan = || vec![("a b".to_owned(), 1.0), ("c".to_owned(), 3.0)];
        let mut told = Vec::new();
        let run = |origin: &str, value: u32, told: &mut Vec<PaperProgress>| {
            let mut hear = |progress: &PaperProgress| told.push(progress.clone());
            let mut store = Store::new(&folder, origin.into(), plan(), &mut hear).unwrap();
            let first = store.part(|| Ok(value)).unwrap();
            // The run ends here, before the second part.
            (first, store.seconds_left().is_some())
        };
        assert_eq!(run("x", 1, &mut told), (1, true));
        assert_eq!(run("x", 2, &mut told), (1, false));
        assert_eq!(run("y", 3, &mut told), (3, true));
        assert_eq!(
            (told[0].done, told[0].parts, told[0].seconds_left),
            (0, 2, None)
        );
        // Half of a file is no result.
        std::fs::write(folder.join("parts/a-b.json"), "{\"origin\": \"y\", \"re").unwrap();
        assert_eq!(run("y", 4, &mut told).0, 4);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
