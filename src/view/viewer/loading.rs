//! Scenes that are read on a thread of their own, while the window goes on.

use std::panic::{self, AssertUnwindSafe};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use rara::Error;
use rara::scene::layers::SceneLayers;
use rara_base::counted::{counted, grouped};

use super::failure::Failure;
use super::scenery::SceneView;
use super::text::ProgressBar;

/// The work that a window waits for, and how far it has come.
#[derive(Debug, Clone, Default)]
pub struct Progress {
    /// What is done, as "reading scene.ply".
    pub what: String,
    /// The share that is done, from 0 to 1; `None` where nobody knows.
    pub share: Option<f64>,
}

/// A function that is told now and then how far the reading of a scene has come.
pub type Watch<'a> = &'a mut dyn FnMut(Progress);

/// A function that reads a scene, on a thread of its own.
pub type Load = Box<dyn FnOnce(Watch<'_>) -> Result<SceneView, Failure> + Send>;

pub(super) const TICK: Duration = Duration::from_millis(100);
/// The time in which a bar that knows no share goes from end to end.
const ROUND: f64 = 1.5;

pub(super) struct Loading {
    begun: Instant,
    now: Arc<Mutex<Progress>>,
}

impl Loading {
    /// Begins to read; `done` is called with the outcome, on the thread that has read. That ends with the program where nobody
    /// waits for it any more.
    pub(super) fn begin(
        load: Load,
        done: impl FnOnce(Result<SceneView, Failure>) + Send + 'static,
    ) -> Result<Self, Failure> {
        let now = Arc::new(Mutex::new(Progress::default()));
        let told = now.clone();
        let work = move || {
            let outcome = panic::catch_unwind(AssertUnwindSafe(|| {
                load(&mut |progress| {
                    *told.lock().unwrap_or_else(PoisonError::into_inner) = progress;
                })
            }));
            // Nobody would end the waiting otherwise.
            done(outcome.unwrap_or_else(|_| {
                let what =
                    "the thread that reads scenes has panicked, as said above; please report it";
                Err(Error::Device(what.into()).into())
            }));
        };
        let named = thread::Builder::new().name("reading".into());
        named
            .spawn(work)
            .map_err(Error::io("the thread that reads scenes"))?;
        Ok(Self {
            begun: Instant::now(),
            now,
        })
    }

    /// The upload, which follows the reading and which the window waits for.
    pub(super) fn uploading(&mut self, loaded: &SceneLayers) {
        let count: usize = loaded.layers.iter().map(|l| l.gaussians.len()).sum();
        *self.now.lock().unwrap_or_else(PoisonError::into_inner) = Progress {
            what: format!("uploading {}", counted(grouped(count as u64), "Gaussian")),
            share: Some(1.0),
        };
    }

    /// What is done now, and how far it has come.
    pub(super) fn progress(&self) -> (String, ProgressBar) {
        let now = self.now.lock().unwrap_or_else(PoisonError::into_inner);
        let progress = match now.share {
            Some(share) => ProgressBar::Share(share),
            None => {
                // As often as the bar moves, so that it is drawn no more often.
                let ticks = self.begun.elapsed().as_millis() / TICK.as_millis();
                let time = ticks as f64 * TICK.as_secs_f64();
                ProgressBar::Moving((time / ROUND).fract())
            }
        };
        (now.what.clone(), progress)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;
    use std::sync::mpsc;

    #[test]
    fn what_cannot_be_read_is_said_and_so_is_what_is_read() {
        let missing = PathBuf::from("/nowhere/scene.ply");
        let (sent, got) = mpsc::channel();
        let load: Load = Box::new(move |watch| {
            watch(Progress {
                what: "reading scene.ply".into(),
                share: None,
            });
            SceneView::of_files(&[missing], None, (64, 64))
        });
        let loading = Loading::begin(load, move |outcome| sent.send(outcome).unwrap()).unwrap();
        let failure = got.recv().unwrap().expect_err("it is not there");
        assert!(failure.to_string().contains("/nowhere/scene.ply"));
        assert_eq!(loading.progress().0, "reading scene.ply");
    }
}
