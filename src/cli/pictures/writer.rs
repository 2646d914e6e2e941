//! Pictures on their way to their places.

use std::path::PathBuf;

use super::super::failure::Failure;
use super::super::film::Film;
use super::super::output::{self, Progress};
use super::super::profile::Profile;
use super::super::report::Answer;
use super::drawn::{Drawn, Written};
use super::{Destination, Place, Planned};

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
        let _unsettled = prints.then(output::unsettled);
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
