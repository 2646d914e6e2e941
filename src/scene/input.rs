//! What readers of scene files are given: the file, what is asked of it, and whom to tell how far it is read.

use std::io::{Read, Seek};
use std::path::Path;

/// A source that a scene is read from.
pub(super) trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// A file that is to be read, of which nothing has been read yet.
pub(super) struct Input<'a> {
    pub(super) source: &'a mut dyn Source,
    /// The name stands for the file in messages.
    pub(super) name: &'a Path,
    pub(super) options: LoadOptions<'a>,
}

/// The options of loading a file.
///
/// ```
/// # use rara_scene as rara;
/// use rara::scene::LoadOptions;
/// let options = LoadOptions::from(&["label"]).activated(true, false);
/// # assert!(options.opacities_are_activated && !options.scales_are_activated);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct LoadOptions<'a> {
    /// The properties to load: see [`load_with`](super::load_with).
    pub properties: &'a [&'a str],
    /// True if a plain `.ply` stores opacities from 0 to 1 instead of their logits. A file does not say so, but if all of its
    /// numbers are from 0 to 1, a note suggests it.
    pub opacities_are_activated: bool,
    /// True if a plain `.ply` stores scales instead of their logarithms.
    pub scales_are_activated: bool,
}

impl<'a> LoadOptions<'a> {
    /// Returns the same options for a `.ply` that stores opacities from 0 to 1 instead of logits, or scales instead of
    /// logarithms.
    #[must_use]
    pub fn activated(self, opacities: bool, scales: bool) -> Self {
        Self {
            opacities_are_activated: opacities,
            scales_are_activated: scales,
            ..self
        }
    }
}

impl<'a> From<&'a [&'a str]> for LoadOptions<'a> {
    fn from(properties: &'a [&'a str]) -> Self {
        Self {
            properties,
            ..Self::default()
        }
    }
}

impl<'a, const N: usize> From<&'a [&'a str; N]> for LoadOptions<'a> {
    fn from(properties: &'a [&'a str; N]) -> Self {
        Self::from(&properties[..])
    }
}

impl<'a> From<&'a Vec<&'a str>> for LoadOptions<'a> {
    fn from(properties: &'a Vec<&'a str>) -> Self {
        Self::from(&properties[..])
    }
}

/// The name that asks for all properties that are numbers.
pub(super) const ALL: &str = "*";

/// The caller's function that is told how far a file is read; formats say how many bytes remain.
pub(super) struct Progress<'a> {
    total: u64,
    call: &'a mut dyn FnMut(u64, u64),
}

impl<'a> Progress<'a> {
    /// The progress through a file of so many bytes.
    pub(super) fn new(total: u64, call: &'a mut dyn FnMut(u64, u64)) -> Self {
        Self { total, call }
    }

    /// The bytes of the whole file.
    pub(super) fn total(&self) -> u64 {
        self.total
    }

    /// Says that so many bytes remain.
    pub(super) fn left(&mut self, left: u64) {
        (self.call)(self.total.saturating_sub(left), self.total);
    }
}
