//! Pictures on their way to their places.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use rara::{Channel, Picture};

use super::super::failure::Failure;
use super::super::film::Film;
use super::super::output::{self, Progress};
use super::super::profile::Profile;
use super::super::report::{Answer, Frame};
use super::{Destination, Place, Planned};

/// What was drawn for one picture.
pub(in super::super) struct Drawn {
    /// What is reported of it.
    pub(in super::super) frame: Frame,
    /// The frames that it is made of, if they are several.
    pub(in super::super) faces: Vec<Frame>,
    /// None where it goes nowhere.
    pub(in super::super) picture: Option<Picture>,
    /// Beside its colours.
    pub(in super::super) channels: Vec<Channel>,
}

/// What goes nowhere.
impl From<Frame> for Drawn {
    fn from(frame: Frame) -> Self {
        Self {
            frame,
            faces: Vec::new(),
            picture: None,
            channels: Vec::new(),
        }
    }
}

/// What is known of a run's pictures when all are drawn.
#[derive(Default)]
pub(in super::super) struct Written {
    /// A frame for each picture.
    pub(in super::super) pictures: Vec<Frame>,
    /// The frames that these are made of, where they are several each.
    pub(in super::super) faces: Vec<Frame>,
    pub(in super::super) files: Vec<PathBuf>,
}

impl Destination<'_> {
    /// Draws the pictures, all of a film of one `size`, and hands each on; ends early where nobody wants more.
    pub(in super::super) fn draw<T>(
        &self,
        what: &'static str,
        profile: &Profile,
        (planned, size): (&[Planned<T>], (u32, u32)),
        mut draw: impl FnMut(&Planned<T>) -> Result<Drawn, Failure>,
    ) -> Result<Written, Failure> {
        let mut film = match &self.place {
            Place::Film(kind, file) => {
                Some(self.args.film.begin(*kind, file, size, planned.len())?)
            }
            _ => None,
        };
        let mut written = Written::default();
        let mut progress = Progress::new(what);
        for (done, one) in planned.iter().enumerate() {
            progress.update(done as u64, planned.len() as u64);
            let drawn = draw(one)?;
            if !self.put(
                profile,
                film.as_mut(),
                (one.file.as_ref(), drawn),
                &mut written,
            )? {
                break;
            }
        }
        if let Some(film) = film {
            profile.span("encode", || film.finish())?;
        }
        Ok(written)
    }

    /// Puts a picture to its place, and prints its line; false where nobody wants more.
    fn put(
        &self,
        profile: &Profile,
        film: Option<&mut Film>,
        (file, drawn): (Option<&PathBuf>, Drawn),
        written: &mut Written,
    ) -> Result<bool, Failure> {
        let Drawn {
            frame,
            faces,
            picture,
            channels,
        } = drawn;
        let prints = self.args.answer() == Answer::Lines;
        let _settled = prints.then(|| SETTLED.lock().unwrap_or_else(PoisonError::into_inner));
        let mut is_wanted = true;
        if let (Some(picture), Some(file)) = (picture, file) {
            profile.span("encode", || match film {
                Some(film) => film.add(&picture).map(|wanted| is_wanted = wanted),
                None if channels.is_empty() => output::picture(&picture, file),
                None => picture.save_with(file, &channels),
            })?;
            if is_wanted && written.files.last() != Some(file) {
                written.files.push(file.clone());
            }
        }
        if prints {
            // Pictures are wanted, even if nobody reads their lines.
            is_wanted = output::json_line(&frame)? || file.is_some();
        }
        written.pictures.push(frame);
        written.faces.extend(faces);
        Ok(is_wanted)
    }
}

/// Locked from before a picture gets its name until its line is printed.
static SETTLED: Mutex<()> = Mutex::new(());

/// Waits until every picture that has its name has its line too, and lets no other get one: for a process that is told to
/// end. It does not wait long, as for a reader that does not read.
#[cfg(unix)]
pub(in super::super) fn settle() {
    use std::sync::TryLockError;
    use std::thread::sleep;
    use std::time::{Duration, Instant};
    const PATIENCE: Duration = Duration::from_secs(2);
    let begin = Instant::now();
    while begin.elapsed() < PATIENCE {
        match SETTLED.try_lock() {
            Err(TryLockError::WouldBlock) => sleep(Duration::from_millis(1)),
            settled => return std::mem::forget(settled),
        }
    }
}
