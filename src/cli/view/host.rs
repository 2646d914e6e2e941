//! `rara view` does for its viewer what only a program can: it prints, reads what is dropped, and writes screenshots and the clip.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::time::Duration;

use glam::DVec3;
use rara::{FrameStats, Picture};
use rara_shots::{Framing, Lens};
use rara_view::viewer::{self, Host, Load, NamedLayer, Progress, Shown};

use super::shots::{self, Shots};
use super::{Begin, flags, timings};
use crate::camera::FOV_Y;
use crate::failure::Failure;
use crate::output::{self, STANDARD, say};
use crate::reading::Reading;
use crate::views::{Framed, Views};
use crate::{clip, scenes, up};

pub(super) struct Program {
    pub(super) shots: Shots,
    /// The file that gets the clip when the window closes.
    pub(super) save_clip: Option<PathBuf>,
}

impl Host for Program {
    fn say(&mut self, line: &dyn Display) {
        say(line);
    }

    fn warn(&mut self, failure: viewer::Failure) -> String {
        let failure = Failure::from(failure);
        output::complain(&failure);
        failure.to_string()
    }

    fn read(&mut self, files: Vec<PathBuf>, up: Option<DVec3>, size: (u32, u32)) -> Load {
        Box::new(move |watch| {
            let loaded = scenes::load_files(&files, &mut |reading| watch(progress(reading)))?;
            let (up, note) = up::up_of(up, &files);
            let framing = Framing::new(Lens::Perspective(FOV_Y), size).up(up);
            let framed = Views::Framed(Framed { framing, note });
            Ok(Begin::unclipped(framed).view(loaded, None)?)
        })
    }

    fn screenshot(
        &mut self,
        picture: &Picture,
        file: Option<&Path>,
        shown: &Shown<'_>,
    ) -> Result<PathBuf, viewer::Failure> {
        let file = file.map_or_else(|| self.shots.next(), Path::to_owned);
        shots::save(picture, &shown.camera, &file)?;
        say(shots::wrote(&file, &flags::flags(shown)));
        flags::notes(shown).for_each(say);
        Ok(file)
    }

    fn describe(&mut self, shown: &Shown<'_>) {
        say(flags::lines(shown));
    }

    fn time(&mut self, size: (u32, u32), stats: Option<&FrameStats>, intervals: &[Duration]) {
        say(timings::lines(size, stats, intervals));
    }

    /// Writes the clips that are on, but for a section's own, to a file that `--clip-file` reads.
    fn close(&mut self, shown: &Shown<'_>) -> Result<(), viewer::Failure> {
        let Some(file) = &self.save_clip else {
            return Ok(());
        };
        let frame = &shown.clips.frame;
        let all = frame.expressions()[frame.section().len()..].to_vec();
        let own = |layer: &NamedLayer| Some((layer.name.clone(), layer.clip(&[])?));
        let layers: Vec<_> = shown.clips.layers().iter().filter_map(own).collect();
        if all.is_empty() && layers.is_empty() {
            say(format_args!(
                "note: no clip is on, so that {} is not written",
                file.display()
            ));
            return Ok(());
        }
        clip::save(file, all, frame.op(), layers)?;
        say(format_args!("wrote the clip to {}", file.display()));
        Ok(())
    }
}

impl From<viewer::Failure> for Failure {
    fn from(failure: viewer::Failure) -> Self {
        match failure {
            viewer::Failure::Asked(message) => Self::Usage(message),
            viewer::Failure::Script(message) => {
                Self::Work(rara::Error::Invalid(format!("--script: {message}")))
            }
            viewer::Failure::Work(error) => Self::Work(error),
        }
    }
}

impl From<Failure> for viewer::Failure {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Usage(message) => Self::Asked(message),
            Failure::Help(help) => Self::Asked(help.to_string()),
            Failure::Work(error) => Self::Work(error),
        }
    }
}

/// How far the reading of files has come, as the window shows it: the share of all their bytes, each file counted alike.
pub(super) fn progress(reading: Reading<'_>) -> Progress {
    let Reading {
        path,
        file: (number, files),
        bytes: (done, total),
    } = reading;
    let file = path.file_name().unwrap_or(path.as_os_str());
    let mut what = match file.to_str() {
        Some(STANDARD) => "reading standard input".to_owned(),
        _ => format!("reading {}", file.to_string_lossy()),
    };
    if files > 1 {
        what += &format!(" ({number} of {files})");
    }
    let within = (total > 0).then(|| done as f64 / total as f64);
    Progress {
        share: within.map(|share| ((number - 1) as f64 + share) / files as f64),
        what,
    }
}

#[cfg(test)]
mod tests;
