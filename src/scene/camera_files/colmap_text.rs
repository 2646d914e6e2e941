//! `cameras.txt`, `images.txt` and `points3D.txt`.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::str::SplitAsciiWhitespace;

use glam::{DQuat, DVec3};

use super::colmap_model::{ColmapImage, Lens, Lenses, MODELS};
use rara_base::error::{Error, Result};

/// The line of a picture's points has some 30 bytes for each, and no picture has so many.
const MAX_LINE: u64 = 64 << 20;

struct Lines<'a, R> {
    path: &'a Path,
    reader: BufReader<R>,
    number: u64,
    line: Vec<u8>,
}

pub(super) fn lenses<R: Read>(source: R, path: &Path) -> Result<Lenses> {
    let mut lines = Lines::new(source, path);
    let mut lenses = Vec::new();
    while lines.next_data()? {
        let lens = lines.parse(|words| {
            let id = word(words)?;
            let name = words.next()?;
            let model = MODELS.iter().find(|model| model.name == name);
            let (width, height) = (word(words)?, word(words)?);
            let parameters = (0..model.map_or(0, |model| model.parameters)).map(|_| word(words));
            Some(Lens {
                id,
                width,
                height,
                parameters: parameters.collect::<Option<_>>()?,
                model: model.ok_or_else(|| name.to_owned()),
            })
        });
        lenses.push(lens.ok_or_else(|| {
            lines.error(
                "this is not `CAMERA_ID MODEL WIDTH HEIGHT PARAMETERS`; export the model again",
            )
        })?);
    }
    Ok(Lenses { lenses, rest: None })
}

pub(super) fn images<R: Read>(source: R, path: &Path) -> Result<Vec<ColmapImage>> {
    let mut lines = Lines::new(source, path);
    let mut images = Vec::new();
    // A picture's points are a line, which some programs leave out and others leave empty.
    let mut points_may_follow = false;
    while lines.next_data()? {
        if points_may_follow && lines.is_points() {
            points_may_follow = false;
            continue;
        }
        let image = lines.parse(|words| {
            let _id: u32 = word(words)?;
            let [w, x, y, z] = [word(words)?, word(words)?, word(words)?, word(words)?];
            let translation = DVec3::new(word(words)?, word(words)?, word(words)?);
            let lens = word(words)?;
            // Names may hold blanks.
            let name = words.collect::<Vec<_>>().join(" ");
            (!name.is_empty()).then_some(ColmapImage {
                name,
                lens,
                rotation: DQuat::from_xyzw(x, y, z, w),
                translation,
            })
        });
        images.push(image.ok_or_else(|| {
            lines.error(
                "this is neither `IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME` nor the `X Y POINT3D_ID`s of the picture before \
                 it; export the model again",
            )
        })?);
        points_may_follow = true;
    }
    Ok(images)
}

/// The positions of the model's points.
pub(super) fn points<R: Read>(source: R, path: &Path) -> Result<Vec<DVec3>> {
    let mut lines = Lines::new(source, path);
    let mut points = Vec::new();
    while lines.next_data()? {
        let point = lines.parse(|words| {
            let _id: u64 = word(words)?;
            Some(DVec3::new(word(words)?, word(words)?, word(words)?))
        });
        points.push(point.ok_or_else(|| {
            lines.error("this is not `POINT3D_ID X Y Z R G B ERROR TRACK`; export the model again")
        })?);
    }
    Ok(points)
}

fn word<T: std::str::FromStr>(words: &mut SplitAsciiWhitespace<'_>) -> Option<T> {
    words.next()?.parse().ok()
}

impl<'a, R: Read> Lines<'a, R> {
    fn new(source: R, path: &'a Path) -> Self {
        Self {
            path,
            reader: BufReader::new(source),
            number: 0,
            line: Vec::new(),
        }
    }

    fn error(&self, message: &str) -> Error {
        Error::format(self.path, format!("line {}: {message}", self.number))
    }

    /// Reads a line; `false` at the end of the file.
    fn next(&mut self) -> Result<bool> {
        self.line.clear();
        self.number += 1;
        let mut limited = (&mut self.reader).take(MAX_LINE);
        let read = limited
            .read_until(b'\n', &mut self.line)
            .map_err(Error::io(self.path))?;
        if read as u64 == MAX_LINE {
            return Err(self.error("the line is too long; this is not a COLMAP model"));
        }
        Ok(read > 0)
    }

    /// Reads on to a line that is neither blank nor a comment; `false` at the end of the file.
    fn next_data(&mut self) -> Result<bool> {
        while self.next()? {
            let line = self.line.trim_ascii();
            if !line.is_empty() && line[0] != b'#' {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// True for threes of numbers, which no line of a picture is: its name stands behind nine.
    fn is_points(&self) -> bool {
        let line = String::from_utf8_lossy(&self.line);
        let is_number = |word: &str| word.parse::<f64>().is_ok();
        let (mut count, mut last) = (0, "");
        for word in line.split_ascii_whitespace() {
            (count, last) = (count + 1, word);
        }
        count % 3 == 0 && is_number(last) && line.split_ascii_whitespace().take(9).all(is_number)
    }

    fn parse<T>(
        &self,
        parse: impl FnOnce(&mut SplitAsciiWhitespace<'_>) -> Option<T>,
    ) -> Option<T> {
        parse(&mut String::from_utf8_lossy(&self.line).split_ascii_whitespace())
    }
}
