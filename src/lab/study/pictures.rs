//! The pictures of a study's cases, their names, and what tells studies apart.

use std::path::Path;

use glam::DVec3;
use rara::{Headless, Mode, Picture, Result, Settings};
use rara_base::fnv;
use serde::Serialize;

use crate::cases::Case;
use rara_reference::maps;

#[derive(Debug, Clone)]
pub struct StudyOptions {
    /// What is compared with hard cuts: [`Mode::Rara`] or [`Mode::Exact`].
    pub method: Mode,
    /// The number of cases, spread over scenes and cuts; all there are where those are fewer.
    pub cases: usize,
    /// The Gaussians of each generated scene; scenes from files have their own.
    pub gaussians: usize,
    /// The direction that is up in the pictures.
    pub up: DVec3,
    /// Pixels a row of the pictures, and rows.
    pub size: u32,
    /// Steps of the animation of the moving cut.
    pub frames: u32,
    /// Pixels a row of each step, and rows.
    pub frame_size: u32,
    /// What is behind the scene.
    pub background: [f32; 3],
}

impl Default for StudyOptions {
    fn default() -> Self {
        Self {
            method: Mode::Exact,
            cases: 20,
            gaussians: 20_000,
            up: DVec3::NEG_Y,
            size: 512,
            frames: 24,
            frame_size: 256,
            background: [1.0; 3],
        }
    }
}

/// The pictures of one of the two.
#[derive(Debug, Serialize)]
pub(super) struct Files {
    picture: String,
    sweep: String,
}

/// The number of steps in a row of the picture that holds them all.
pub(super) fn columns(frames: u32) -> u32 {
    (1..)
        .find(|columns| columns * columns >= frames)
        .unwrap_or(1)
}

/// Draws the pictures and keeps account of them.
pub(super) struct Drawing<'a> {
    pub(super) folder: &'a Path,
    pub(super) headless: &'a mut Headless,
    pub(super) options: &'a StudyOptions,
    pub(super) id: Id,
}

impl Drawing<'_> {
    /// Draws and saves the pictures of one of the two in files whose names begin so.
    pub(super) fn files(&mut self, case: &Case, mode: Mode, start: &str) -> Result<Files> {
        let background = Some(self.options.background);
        let settings = Settings::default().mode(mode).background(background);
        let picture = self.picture(case, &settings, self.options.size, 0.5)?;
        let sweep = self.sweep(case, &settings)?;
        Ok(Files {
            picture: self.save(&picture, format!("{start}.png"))?,
            sweep: self.save(&sweep, format!("{start}-sweep.png"))?,
        })
    }

    fn save(&mut self, picture: &Picture, name: String) -> Result<String> {
        picture.save(self.folder.join(&name))?;
        self.id.add(&picture.to_rgba8());
        Ok(name)
    }

    fn picture(
        &mut self,
        case: &Case,
        settings: &Settings,
        size: u32,
        share: f64,
    ) -> Result<Picture> {
        let camera = case.camera.resized((size, size))?;
        self.headless.render(&camera, &case.at(share)?, settings)?;
        self.headless.picture()
    }

    /// All steps of the moving cut in one picture, row by row.
    fn sweep(&mut self, case: &Case, settings: &Settings) -> Result<Picture> {
        let (frames, size) = (self.options.frames, self.options.frame_size);
        let columns = columns(frames);
        let mut all = Picture::filled(columns * size, frames.div_ceil(columns) * size, [0.0; 4]);
        for frame in 0..frames {
            let share = f64::from(frame) / f64::from(frames - 1);
            let step = self.picture(case, settings, size, share)?;
            let place = [frame % columns * size, frame / columns * size];
            maps::put(&mut all, &step, place);
        }
        Ok(all)
    }
}

/// A hash that tells studies apart and stays the same everywhere.
pub(super) struct Id(u64);

impl Id {
    pub(super) fn new() -> Self {
        Self(fnv::NOTHING)
    }

    pub(super) fn add(&mut self, bytes: &[u8]) {
        self.0 = fnv::with(self.0, bytes.iter().copied());
    }

    pub(super) fn text(&self) -> String {
        format!("{:016x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_the_published_one() {
        let mut id = Id::new();
        id.add(b"foobar");
        assert_eq!(id.text(), "85944171f73967e8");
    }

    #[test]
    fn steps_lie_in_a_nearly_square_picture() {
        assert_eq!([1, 2, 4, 5, 24, 25].map(columns), [1, 2, 2, 3, 5, 5]);
    }
}
