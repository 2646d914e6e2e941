//! Scene files, read one by one with a sign of life.

use std::io::{self, Read};
use std::path::Path;

use super::output::{ProgressLine, STANDARD, Spinner};
use rara::scene::layers::LayerEntry;
use rara::scene::{self, LoadOptions, Property};

/// How far the reading of a scene's files has come.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "view"), allow(dead_code))]
pub(super) struct Reading<'a> {
    pub(super) path: &'a Path,
    /// Its number from 1, and how many there are.
    pub(super) file: (usize, usize),
    /// Bytes that are read, and how many there are; 0 where nobody knows.
    pub(super) bytes: (u64, u64),
}

/// Is told now and then how far the reading has come, besides the terminal.
pub(super) type Watch<'a> = &'a mut dyn FnMut(Reading<'_>);

/// Reads the file of an entry, of this number among so many.
pub(super) fn read(
    (entry, options): (&LayerEntry, LoadOptions<'_>),
    file: (usize, usize),
    watch: Watch<'_>,
) -> rara::Result<(scene::SceneFile, Vec<Property>)> {
    let path = &entry.path;
    let mut tell = |done, total| {
        let bytes = (done, total);
        watch(Reading { path, file, bytes });
    };
    tell(0, 0);
    if path != Path::new(STANDARD) {
        let mut progress = ProgressLine::new(format!("reading {}", path.display()));
        let mut tell = |done, total| {
            progress.update(done, total);
            tell(done, total);
        };
        return match entry.part {
            Some(number) => scene::load_layer(path, number, options, &mut tell),
            None => scene::load_with(path, options, &mut tell),
        };
    }
    let name = Path::new("standard input");
    let mut bytes = Vec::new();
    {
        let _sign = Spinner::new("reading standard input");
        io::stdin()
            .lock()
            .read_to_end(&mut bytes)
            .map_err(rara::Error::io(name))?;
    }
    let mut progress = ProgressLine::new("reading standard input");
    scene::load_from_with(io::Cursor::new(bytes), name, options, &mut |done, total| {
        progress.update(done, total);
        tell(done, total);
    })
}
