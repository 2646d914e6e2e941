//! Films: all pictures of a run in one file, or one after the other on standard output.
//!
//! Each picture goes there when it is drawn, so that no more than one is in memory.

mod apng;
mod video;

use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rara::{Error, Picture, PngCompression, Result};
use rara_base::files::PartialFile;

use super::failure::Failure;
use super::output::{self, STANDARD};
use super::pattern::is_several;
use super::sheet::Sheet;
use super::values;
use apng::Apng;
#[cfg(unix)]
pub(super) use video::abandon;
use video::{Container, Video};

/// How a film is written.
#[derive(Debug, Args)]
#[command(next_help_heading = "Paths, films and panoramas")]
pub(super) struct FilmArgs {
    /// Pictures per second of a film [default: the camera path's, or else 30]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=i64::from(MOST_FPS)))]
    fps: Option<u16>,
    /// The format that -o - writes to standard output
    ///
    /// png is for a single picture. apng is a film of all pictures. rgba is the pixels of all pictures without a header.
    #[arg(long, value_name = "FORMAT")]
    format: Option<Stream>,
    /// Keep the transparency in a .mov (PNG, lossless) or a .webm (VP9)
    ///
    /// An .apng always keeps it; .mp4 and .mkv cannot.
    #[arg(long)]
    alpha: bool,
    /// Put all pictures on one sheet, in rows, with their names
    ///
    /// The sheet is the .png or .exr file of -o. All pictures have one size, that of --size.
    #[arg(long, help_heading = None)]
    sheet: bool,
    /// Columns of the sheet [default: as many as make it about square]
    #[arg(long, value_name = "N", requires = "sheet", value_parser = clap::value_parser!(u32).range(1..), help_heading = None)]
    sheet_columns: Option<u32>,
    /// Pictures a second that a file of cameras says.
    #[arg(skip)]
    said: Option<u16>,
}

/// What goes to standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Stream {
    Png,
    Apng,
    /// 8 bits per channel, row by row from the top left, un-premultiplied.
    Rgba,
}

const FPS: u16 = 30;
const MOST_FPS: u16 = 1000;

/// The endings of films that are ffmpeg's.
pub(super) const ENDINGS: &str = ".mp4, .mov, .mkv or .webm";

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FilmFormat {
    /// An animated PNG, without loss and with alpha.
    Apng,
    /// Bytes without a header.
    Raw,
    /// Encoded by ffmpeg.
    Video(Container),
    /// All pictures on a sheet.
    Sheet,
}

/// The file name of a picture or a film; its ending says the format.
pub(super) fn film_path(path: OsString) -> std::result::Result<PathBuf, String> {
    let is_film = FilmFormat::from_path(Path::new(&path), false).is_some();
    match is_film {
        true => Ok(path.into()),
        false => values::picture_path(path)
            .map_err(|error| format!("{error}, a film's in .apng, {}", ENDINGS)),
    }
}

/// True for a file that can hold a sheet.
fn is_sheet(file: &Path) -> bool {
    output::ends_in(file, "png") || output::ends_in(file, "exr")
}

impl FilmFormat {
    /// The kind of film that a file's name stands for, with transparency or without; none for that of a picture.
    pub(super) fn from_path(path: &Path, has_alpha: bool) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "apng" => Some(Self::Apng),
            other => Container::from_extension(other, has_alpha).map(Self::Video),
        }
    }

    /// True where pixels have no alpha.
    pub(super) fn is_opaque(self) -> bool {
        matches!(self, Self::Video(container) if !container.has_alpha)
    }
}

impl FilmArgs {
    /// Takes what a file of cameras says, as a whole number.
    pub(super) fn pace(&mut self, fps: Option<f64>) {
        let whole = |fps: f64| fps.round().clamp(1.0, MOST_FPS.into());
        if let Some(fps) = fps.filter(|fps| self.fps.is_none() && whole(*fps) != *fps) {
            output::say(format_args!(
                "note: the camera path's rate of {fps} a second is taken for {}, if a film is made; --fps takes other whole \
                 numbers",
                whole(fps)
            ));
        }
        self.said = fps.map(|fps| whole(fps) as u16);
    }

    /// The kind of film that is asked for; none for pictures.
    pub(super) fn kind(
        &self,
        output: Option<&Path>,
    ) -> std::result::Result<Option<FilmFormat>, Failure> {
        let is_stream = output == Some(Path::new(STANDARD));
        let kind = match self.format {
            Some(_) if !is_stream => {
                return Err(Failure::Usage(
                    "--format is for standard output; the name of a file says its format: leave out --format, or write to standard \
                     output by -o -"
                        .into(),
                ));
            }
            Some(Stream::Apng) => Some(FilmFormat::Apng),
            Some(Stream::Rgba) => Some(FilmFormat::Raw),
            Some(Stream::Png) | None => {
                output.and_then(|path| FilmFormat::from_path(path, self.alpha))
            }
        };
        let kind = match (self.sheet, kind) {
            (false, kind) => kind,
            (true, None) if output.is_some_and(is_sheet) => Some(FilmFormat::Sheet),
            (true, _) => {
                return Err(Failure::Usage(
                    "--sheet puts all pictures on one sheet: give -o a name that ends in .png or .exr".into(),
                ));
            }
        };
        if self.alpha && kind.is_none() {
            return Err(Failure::Usage(
                "--alpha is for films in .mov and .webm, because other films have no transparency and pictures always keep theirs: leave \
                 out --alpha, or give -o a name that ends in .mov or .webm"
                    .into(),
            ));
        }
        if self.fps.is_some() && !matches!(kind, Some(FilmFormat::Apng | FilmFormat::Video(_))) {
            return Err(Failure::Usage(format!(
                "--fps is for films: leave it out, or give -o a name that ends in .apng, {ENDINGS}"
            )));
        }
        Ok(kind)
    }

    /// Fails early where such a film could not be written to `file`.
    pub(super) fn check(&self, kind: FilmFormat, file: &Path) -> std::result::Result<(), Failure> {
        if is_several(file) {
            return Err(Failure::Usage(
                "a film or a sheet is one file: leave the braces out of its name, or name numbered pictures, as frame_{:04}.png"
                    .into(),
            ));
        }
        if matches!(kind, FilmFormat::Video(_)) {
            video::encoder(file)?;
        }
        Ok(output::check_file(file)?)
    }

    /// Begins a film of so many pictures, all of one size.
    pub(super) fn begin(
        &self,
        kind: FilmFormat,
        file: &Path,
        size: (u32, u32),
        frames: usize,
    ) -> Result<Film> {
        let fps = self.fps.or(self.said).unwrap_or(FPS);
        if kind == FilmFormat::Sheet {
            let columns = self.sheet_columns.unwrap_or(0);
            let sheet = Sheet::new(size, frames as u32, columns)?;
            return Ok(Film::Sheet(sheet, file.into()));
        }
        let place = match file == Path::new(STANDARD) {
            true => FilmTarget::Stdout,
            false => FilmTarget::File(PartialFile::begin(file)?),
        };
        Ok(match (kind, place) {
            (FilmFormat::Apng, place) => Film::Apng(Apng::begin(place, file, size, frames, fps)?),
            (FilmFormat::Video(container), FilmTarget::File(place)) => {
                Film::Video(Video::begin(place, file, container, (size, fps))?)
            }
            (_, place) => Film::Raw(place),
        })
    }
}

pub(super) enum Film {
    Apng(Apng),
    Raw(FilmTarget),
    Video(Video),
    /// A sheet, and its file.
    Sheet(Sheet, PathBuf),
}

impl Film {
    /// Writes the next picture, which has a name; false when its reader wants no more of them.
    pub(super) fn add(&mut self, name: &str, picture: &Picture) -> Result<bool> {
        match self {
            Self::Sheet(sheet, _) => sheet.add(name, picture),
            Self::Apng(film) => return film.add(&picture.to_rgba8()),
            Self::Raw(place) => {
                return wanted(place.write_all(&picture.to_rgba8()), Path::new("stdout"));
            }
            Self::Video(film) => film.add(&picture.to_rgba8())?,
        }
        Ok(true)
    }

    /// Ends the film and gives its file its name.
    pub(super) fn finish(self, compression: PngCompression) -> Result<()> {
        match self {
            Self::Sheet(sheet, file) => output::picture(sheet.picture(), &file, compression),
            Self::Apng(film) => film.finish(),
            Self::Raw(place) => place.finish(),
            Self::Video(film) => film.finish(),
        }
    }
}

/// The file or the stream that a film's bytes go to.
#[derive(Debug)]
pub(super) enum FilmTarget {
    Stdout,
    File(PartialFile),
}

impl FilmTarget {
    fn finish(self) -> Result<()> {
        match self {
            Self::Stdout => wanted(io::stdout().flush(), Path::new("stdout")).map(|_| ()),
            Self::File(file) => file.finish(),
        }
    }
}

impl Write for FilmTarget {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Stdout => io::stdout().write(bytes),
            Self::File(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Stdout => io::stdout().flush(),
            Self::File(file) => file.flush(),
        }
    }
}

/// True for what was written, and false where a reader has stopped reading, which is no failure.
fn wanted(written: io::Result<()>, place: &Path) -> Result<bool> {
    match written {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(Error::io(place)(error)),
    }
}

/// Fails unless all pictures have one size, which is returned.
pub(super) fn one_size(
    sizes: impl IntoIterator<Item = (u32, u32)>,
) -> std::result::Result<(u32, u32), Failure> {
    let mut sizes = sizes.into_iter();
    let first = sizes.next().unwrap_or((1, 1));
    match sizes.find(|size| *size != first) {
        None => Ok(first),
        Some(other) => Err(Failure::Usage(format!(
            "the pictures of a film or a sheet have one size, and these are {}x{} and {}x{}: give --size",
            first.0, first.1, other.0, other.1
        ))),
    }
}

/// Says once what becomes of transparency where a film has none.
pub(super) fn say_opaque() {
    output::say(
        "note: this kind of film has no transparency, so it is drawn on black; --background chooses another colour, and --alpha \
         keeps the transparency of a .mov or .webm",
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_what_is_a_film() {
        let kind = |name: &str| FilmFormat::from_path(Path::new(name), false);
        let clear = |name: &str| FilmFormat::from_path(Path::new(name), true);
        assert!(clear("a.mov").is_some_and(|kind| !kind.is_opaque()));
        assert!(clear("a.WEBM").is_some_and(|kind| !kind.is_opaque()));
        assert_eq!((clear("a.mp4"), clear("a.mkv")), (None, None));
        assert_eq!(kind("a.APNG"), Some(FilmFormat::Apng));
        assert!(kind("a.mp4").is_some_and(FilmFormat::is_opaque));
        assert!(kind("a.webm").is_some() && kind("a.mov").is_some() && kind("a.mkv").is_some());
        for picture in ["a.png", "a.exr", "-", "mp4", "a.gif"] {
            assert_eq!(kind(picture), None, "{picture}");
        }
        assert!(one_size([(4, 3), (4, 3)]).is_ok() && one_size([(4, 3), (3, 4)]).is_err());
    }
}
