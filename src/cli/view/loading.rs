//! Scenes that are read on a thread of their own, while the window goes on.

use std::panic::{self, AssertUnwindSafe};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use glam::DVec3;
use rara::Error;
use rara::scene::Bounds;

use super::layers::Clips;
use super::scenery::Scenery;
use super::text::ProgressBar;
use super::{Begin, name};
use crate::camera::FOV_Y;
use crate::failure::Failure;
use crate::framing::Visible;
use crate::lens::{Depths, Lens};
use crate::output::counted;
use crate::reading::{Reading, Watch};
use crate::scene_layers::SceneLayers;
use crate::scenes;
use crate::views::Framing;
use crate::views::Views;
use crate::{training, values};

/// A scene that has been read, and how it is looked at.
pub(super) struct LoadedWindow {
    pub(super) loaded: SceneLayers,
    pub(super) scenery: Scenery,
}

/// How a scene is read.
pub(super) type Load = Box<dyn FnOnce(Watch<'_>) -> Result<LoadedWindow, Failure> + Send>;

pub(super) const TICK: Duration = Duration::from_millis(100);
/// The time in which a bar that knows no share goes from end to end.
const ROUND: f64 = 1.5;

pub(super) struct Loading {
    begun: Instant,
    now: Arc<Mutex<Now>>,
}

#[derive(Debug, Clone, Default)]
struct Now {
    what: String,
    /// The share of all files' bytes, each file counted alike; none where nobody knows.
    share: Option<f64>,
}

impl LoadedWindow {
    /// A scene as it is looked at first. `typed` are the flags that made its layers.
    pub(super) fn new(
        loaded: SceneLayers,
        begin: Begin,
        up: Option<DVec3>,
        typed: &[(&str, &str)],
    ) -> Result<Self, Failure> {
        let scene = loaded.scene();
        let middle = Bounds::of(&scene).centre();
        let visible = Visible::from_scene(&scene);
        let (views, cut) = begin.cameras((&scene, &visible), up, middle)?;
        let scenery = Scenery {
            name: name(&scene),
            views,
            clips: Clips::new(cut, &loaded.layers, middle).typed(typed),
            centre: visible.middle,
            radius: visible.radius,
        };
        Ok(Self { loaded, scenery })
    }

    /// The scene of dropped files, as it is looked at without any flags but for what is up, in a window of this size.
    pub(super) fn of_files(files: Vec<PathBuf>, up: Option<DVec3>, size: (u32, u32)) -> Load {
        Box::new(move |watch| {
            let loaded = scenes::load_files(&files, watch)?;
            let (up, note) = training::up_of(up, &files);
            let framed = Views::Framed(Framing {
                up,
                lens: Lens::Perspective(FOV_Y),
                size,
                depths: Depths::default(),
                eye: None,
                target: None,
                note,
            });
            Self::new(loaded, Begin::unclipped(framed), None, &[])
        })
    }
}

impl Loading {
    /// Begins to read; `done` is called with the outcome, on the thread that has read. That ends with the program where nobody
    /// waits for it any more.
    pub(super) fn begin(
        load: Load,
        done: impl FnOnce(Result<LoadedWindow, Failure>) + Send + 'static,
    ) -> Result<Self, Failure> {
        let now = Arc::new(Mutex::new(Now::default()));
        let told = now.clone();
        let work = move || {
            let outcome = panic::catch_unwind(AssertUnwindSafe(|| {
                load(&mut |reading| {
                    *told.lock().unwrap_or_else(PoisonError::into_inner) =
                        Now::from_reading(reading);
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
        *self.now.lock().unwrap_or_else(PoisonError::into_inner) = Now {
            what: format!("uploading {}", counted(count as u64, "Gaussian")),
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

impl Now {
    fn from_reading(reading: Reading<'_>) -> Self {
        let Reading {
            path,
            file: (number, files),
            bytes: (done, total),
        } = reading;
        let file = path.file_name().unwrap_or(path.as_os_str());
        let mut what = match file.to_str() {
            Some(values::STANDARD) => "reading standard input".to_owned(),
            _ => format!("reading {}", file.to_string_lossy()),
        };
        if files > 1 {
            what += &format!(" ({number} of {files})");
        }
        let within = (total > 0).then(|| done as f64 / total as f64);
        Self {
            share: within.map(|share| ((number - 1) as f64 + share) / files as f64),
            what,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;
    use std::sync::mpsc;

    fn reading(file: (usize, usize), bytes: (u64, u64)) -> Now {
        let path = Path::new("folder/a b.ply");
        Now::from_reading(Reading { path, file, bytes })
    }

    #[test]
    fn the_share_is_that_of_all_files_where_it_is_known() {
        let one = reading((1, 1), (25, 100));
        assert_eq!((&one.what[..], one.share), ("reading a b.ply", Some(0.25)));
        let second = reading((2, 4), (50, 100));
        assert_eq!(second.what, "reading a b.ply (2 of 4)");
        assert_eq!(second.share, Some(0.375));
        assert_eq!(reading((1, 1), (0, 0)).share, None);
    }

    #[test]
    fn what_cannot_be_read_is_said_as_on_the_command_line() {
        let missing = PathBuf::from("/nowhere/scene.ply");
        let (sent, got) = mpsc::channel();
        let load = LoadedWindow::of_files(vec![missing.clone()], None, (64, 64));
        let loading = Loading::begin(load, move |outcome| sent.send(outcome).unwrap()).unwrap();
        let failure = got.recv().unwrap().err().expect("it is not there");
        let typed = scenes::load_files(&[missing], &mut |_| ()).err();
        assert_eq!(
            failure.to_string(),
            typed.expect("nor for a command").to_string()
        );
        let (what, _) = loading.progress();
        assert_eq!(what, "reading scene.ply");
    }
}
