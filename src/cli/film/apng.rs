//! Animated PNGs, picture by picture.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use png::{BitDepth, BlendOp, ColorType, Compression, Encoder, EncodingError, Writer};
use rara::{Error, Result};

use super::{FilmTarget, wanted};

pub(in super::super) struct Apng {
    encoder: Writer<SharedWriter>,
    place: SharedWriter,
    /// What it becomes, for messages.
    file: PathBuf,
}

/// The place that the encoder writes to, which outlives it.
#[derive(Clone)]
struct SharedWriter(Arc<Mutex<FilmTarget>>);

impl Write for SharedWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut place = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        place.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        let mut place = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        place.flush()
    }
}

impl Apng {
    /// Begins a film of so many pictures, which repeats without an end.
    pub(super) fn begin(
        place: FilmTarget,
        file: &Path,
        (width, height): (u32, u32),
        frames: usize,
        fps: u16,
    ) -> Result<Self> {
        let place = SharedWriter(Arc::new(Mutex::new(place)));
        let begin = || {
            let mut encoder = Encoder::new(place.clone(), width, height);
            encoder.set_color(ColorType::Rgba);
            encoder.set_depth(BitDepth::Eight);
            encoder.set_compression(Compression::Balanced);
            encoder.set_animated(u32::try_from(frames).unwrap_or(u32::MAX), 0)?;
            encoder.set_frame_delay(1, fps)?;
            // Each picture takes the place of the one before, transparency and all.
            encoder.set_blend_op(BlendOp::Source)?;
            encoder.write_header()
        };
        let encoder = begin().map_err(|error| Error::io(file)(io_error(error)))?;
        Ok(Self {
            encoder,
            place,
            file: file.to_owned(),
        })
    }

    /// Writes the next picture; false when its reader wants no more of them.
    pub(super) fn add(&mut self, bytes: &[u8]) -> Result<bool> {
        let written = self.encoder.write_image_data(bytes).map_err(io_error);
        wanted(written, &self.file)
    }

    pub(super) fn finish(self) -> Result<()> {
        let Self {
            encoder,
            place,
            file,
        } = self;
        if !wanted(encoder.finish().map_err(io_error), &file)? {
            return Ok(());
        }
        match Arc::try_unwrap(place.0) {
            Ok(place) => (place.into_inner().unwrap_or_else(PoisonError::into_inner)).finish(),
            Err(_) => unreachable!("the encoder is gone"),
        }
    }
}

/// What a stream of the operating system says, or the encoder itself.
fn io_error(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
