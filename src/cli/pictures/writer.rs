//! Pictures on their way to their places: the next ones are drawn while threads encode and write those before.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError, RwLockReadGuard, mpsc};
use std::thread;

use rara_base::parallel;

use super::super::failure::Failure;
use super::super::film::Film;
use super::super::output::{self, ProgressLine};
use super::super::profile::Profile;
use super::super::report::Answer;
use super::drawn::{RenderedPicture, WrittenPictures};
use super::{Destination, OutputTarget, PictureJob};

/// The most memory of pictures that wait to be encoded, bytes.
const WAITING: u64 = 256 << 20;

/// World units that 16 bits hold in thousandths.
const MOST_DEPTH: f32 = 65.535;

/// What has become of the pictures that were drawn. They are counted in the order in which they were.
#[derive(Default)]
struct Outcome {
    written: WrittenPictures,
    /// The number of pictures that are reported.
    reported: usize,
    /// True where nobody wants more.
    is_over: bool,
    failure: Option<Failure>,
}

/// A run's pictures between drawing and writing.
struct Writer<'a, T> {
    destination: &'a Destination<'a>,
    profile: &'a Profile,
    planned: &'a [PictureJob<T>],
    film: Option<Mutex<Film>>,
    outcome: Mutex<Outcome>,
    /// It is notified of each change of the outcome.
    changed: Condvar,
}

impl Destination<'_> {
    /// Draws the pictures, all of a film of one `size`, and hands each on; ends early where nobody wants more.
    pub(in super::super) fn draw<T: Sync>(
        &self,
        what: &'static str,
        profile: &Profile,
        (planned, size): (&[PictureJob<T>], (u32, u32)),
        mut draw: impl FnMut(&PictureJob<T>) -> Result<RenderedPicture, Failure>,
    ) -> Result<WrittenPictures, Failure> {
        let film = match &self.place {
            OutputTarget::Film(kind, file) => {
                if let Some(order) = self.order
                    && !order.begin(0, Some(file))?
                {
                    return Ok(WrittenPictures::default());
                }
                let film = self.args.film.begin(*kind, file, size, planned.len())?;
                Some(Mutex::new(film))
            }
            _ => None,
        };
        let threads = match planned.len() {
            // A trace shows one thing after the other.
            0 | 1 => 0,
            _ if profile.is_traced() => 0,
            _ => threads(size, film.is_some()),
        };
        let writer = Writer {
            destination: self,
            profile,
            planned,
            film,
            outcome: Mutex::default(),
            changed: Condvar::new(),
        };
        let (pictures, waiting) = mpsc::sync_channel::<(usize, usize, RenderedPicture)>(threads);
        let waiting = Mutex::new(waiting);
        // Whoever waits for an earlier picture's turn knows that it gets one: they become unsettled in their order.
        let next = || {
            let waiting = waiting.lock().unwrap_or_else(PoisonError::into_inner);
            waiting.recv().map(|drawn| (drawn, writer.unsettled()))
        };
        let drawn = thread::scope(|scope| {
            let pictures = pictures; // gone with the last one, so that the threads end
            for _ in 0..threads {
                scope.spawn(|| {
                    while let Ok(((turn, index, drawn), _unsettled)) = next() {
                        writer.put(turn, index, drawn);
                    }
                });
            }
            let mut progress = ProgressLine::new(what);
            let mut turn = 0;
            for (index, one) in planned.iter().enumerate() {
                progress.update(index as u64, planned.len() as u64);
                if writer.outcome().is_over {
                    break;
                }
                if let (Some(order), None) = (self.order, &writer.film)
                    && !order.begin(one.number, one.file.as_deref())?
                {
                    continue;
                }
                let picture = draw(one)?;
                if threads == 0 {
                    let _unsettled = writer.unsettled();
                    writer.put(turn, index, picture);
                } else {
                    let sent = pictures.send((turn, index, picture));
                    sent.expect("the threads wait for more");
                }
                turn += 1;
            }
            Ok(())
        });
        writer.finish(drawn)
    }
}

/// The number of threads that encode pictures of a size; those of a film are encoded one after the other.
fn threads((width, height): (u32, u32), is_film: bool) -> usize {
    let bytes = 16 * u64::from(width) * u64::from(height);
    // Each thread has one picture, and another one waits for it.
    let most = WAITING / (2 * bytes).max(1);
    let wanted = if is_film { 1 } else { parallel::threads() };
    wanted.min(most as usize)
}

impl<T> Writer<'_, T> {
    fn outcome(&self) -> MutexGuard<'_, Outcome> {
        self.outcome.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// True where each picture gets a line.
    fn prints(&self) -> bool {
        self.destination.args.answer() == Answer::Lines
    }

    /// Keeps the process from being told to end while a picture has its name and not yet its line.
    fn unsettled(&self) -> Option<RwLockReadGuard<'static, ()>> {
        self.prints().then(output::unsettled)
    }

    /// Puts a picture to its place, and reports it in its turn.
    fn put(&self, turn: usize, index: usize, mut drawn: RenderedPicture) {
        let one = &self.planned[index];
        let saved = self.save(one, &mut drawn);
        let mut outcome = self.outcome();
        while outcome.reported != turn && !outcome.is_over {
            let changed = self.changed.wait(outcome);
            outcome = changed.unwrap_or_else(PoisonError::into_inner);
        }
        if !outcome.is_over {
            let reported =
                saved.and_then(|wanted| self.report(&mut outcome.written, one, drawn, wanted));
            outcome.reported += 1;
            match reported {
                Ok(is_wanted) => outcome.is_over = !is_wanted,
                Err(failure) => {
                    outcome.is_over = true;
                    outcome.failure = Some(failure);
                }
            }
        }
        drop(outcome);
        self.changed.notify_all();
    }

    /// Encodes and writes a picture; false where nobody wants more.
    fn save(&self, one: &PictureJob<T>, drawn: &mut RenderedPicture) -> Result<bool, Failure> {
        let (Some(pixels), Some(file)) = (drawn.picture.take(), &one.file) else {
            return Ok(true);
        };
        let picture = self.profile.span("decode", || pixels.picture());
        let channels = &drawn.channels;
        let saved = self.profile.span("encode", || match &self.film {
            Some(film) => film
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .add(drawn.frame.name(), &picture),
            None if channels.is_empty() => {
                let compression = self.destination.args.png.unwrap_or_default();
                output::picture(&picture, file, compression).map(|()| true)
            }
            None => {
                let deepest = channels.iter().filter(|channel| channel.name == "Z");
                let mut deepest = deepest.flat_map(|channel| &channel.values);
                if output::ends_in(file, "png") && deepest.any(|&depth| depth > MOST_DEPTH) {
                    output::warn_once(format!(
                        "note: depths beyond {MOST_DEPTH} world units are {MOST_DEPTH} in 16 bits; .npy and .exr hold all"
                    ));
                }
                picture.save_with(file, channels).map(|()| true)
            }
        });
        Ok(saved?)
    }

    /// Reports a picture that is at its place; false where nobody wants more.
    fn report(
        &self,
        written: &mut WrittenPictures,
        one: &PictureJob<T>,
        RenderedPicture { frame, faces, .. }: RenderedPicture,
        mut is_wanted: bool,
    ) -> Result<bool, Failure> {
        if let Some(file) = &one.file {
            if is_wanted && written.files.last() != Some(file) {
                written.files.push(file.clone());
            }
            if let (Some(order), None) = (self.destination.order, &self.film) {
                order.end(one.number, file, &frame)?;
            }
        }
        if self.prints() {
            // Pictures are wanted, even if nobody reads their lines.
            is_wanted = output::json_line(&frame)? || one.file.is_some();
        }
        written.pictures.push(frame);
        written.faces.extend(faces);
        Ok(is_wanted)
    }

    /// The pictures and files, once all that were `drawn` are written. The first failure is returned.
    fn finish(self, drawn: Result<(), Failure>) -> Result<WrittenPictures, Failure> {
        let outcome = self.outcome.into_inner();
        let Outcome {
            written, failure, ..
        } = outcome.unwrap_or_else(PoisonError::into_inner);
        failure.map_or(drawn, Err)?;
        if let Some(film) = self.film {
            let film = film.into_inner().unwrap_or_else(PoisonError::into_inner);
            self.profile.span("encode", || {
                film.finish(self.destination.args.png.unwrap_or_default())
            })?;
            let first = self.planned.first().zip(written.pictures.first());
            if let (Some(order), Some((one, frame))) = (self.destination.order, first)
                && let Some(file) = &one.file
            {
                order.end(0, file, frame)?;
            }
        }
        Ok(written)
    }
}
