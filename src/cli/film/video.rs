//! Films that ffmpeg encodes, from bytes on its standard input.

use std::ffi::OsString;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

use rara::{Error, Result};
use rara_base::files::PartialFile;

/// The kinds of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) struct Container {
    format: &'static str,
    /// The encoder, and how good it is: hardly a difference to be seen.
    flags: &'static [&'static str],
    /// What becomes of the pictures before.
    filter: &'static [&'static str],
    pub(super) has_alpha: bool,
}

const H264: &[&str] = &["-c:v", "libx264", "-crf", "17", "-movflags", "+faststart"];
/// The flags of VP9, and more.
macro_rules! vp9 {
    ($($more:literal),*) => {
        &["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1" $(, $more)*]
    };
}
const VP9: &[&str] = vp9!();
/// Transparency is a film of its own, and frames that are not shown are not for such.
const VP9_ALPHA: &[&str] = vp9!("-auto-alt-ref", "0");

/// Halved colours need even sides. Films of this size are BT.709 for those who play them.
macro_rules! halved {
    ($format:literal) => {
        &[
            "-vf",
            concat!(
                "crop=trunc(iw/2)*2:trunc(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=",
                $format,
                ",setparams=range=tv:color_primaries=bt709:color_trc=bt709:colorspace=bt709"
            ),
            "-colorspace",
            "bt709",
            "-color_primaries",
            "bt709",
            "-color_trc",
            "bt709",
            "-color_range",
            "tv",
        ]
    };
}

impl Container {
    /// The kind that a name with this ending stands for, with transparency or without.
    pub(super) fn from_extension(ending: &str, has_alpha: bool) -> Option<Self> {
        let (format, flags, filter): (_, &[&str], &[&str]) = match (ending, has_alpha) {
            ("mov", true) => ("mov", &["-c:v", "png"], &["-pix_fmt", "rgba"]),
            ("webm", true) => ("webm", VP9_ALPHA, halved!("yuva420p")),
            ("mp4", false) => ("mp4", H264, halved!("yuv420p")),
            ("mov", false) => ("mov", H264, halved!("yuv420p")),
            ("mkv", false) => ("matroska", &H264[..4], halved!("yuv420p")),
            ("webm", false) => ("webm", VP9, halved!("yuv420p")),
            _ => return None,
        };
        Some(Self {
            format,
            flags,
            filter,
            has_alpha,
        })
    }
}

/// The encoder that runs.
static RUNNING: Mutex<Option<Child>> = Mutex::new(None);

fn running() -> MutexGuard<'static, Option<Child>> {
    RUNNING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends the encoder, and lets nobody begin another: for a process that is told to end.
#[cfg(unix)]
pub(in super::super) fn abandon() {
    let mut encoder = running();
    if let Some(child) = encoder.as_mut() {
        let _ = child.kill();
        let _ = child.wait();
    }
    std::mem::forget(encoder); // who waits for it, waits for the end
}

pub(super) fn encoder(file: &Path) -> Result<PathBuf> {
    let name = format!("ffmpeg{}", std::env::consts::EXE_SUFFIX);
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&folders).map(|folder| folder.join(&name));
    found.into_iter().find(|place| place.is_file()).ok_or_else(|| {
        Error::format(
            file,
            "such a film is encoded by ffmpeg, which is not on the PATH; install it, or write an .apng or numbered pictures \
             (-o frame_{:04}.png)",
        )
    })
}

pub(in super::super) struct Video {
    /// The pipe to ffmpeg; none when it has got everything.
    pictures: Option<ChildStdin>,
    /// What it complains of.
    complaint: Option<JoinHandle<String>>,
    place: Option<PartialFile>,
    file: PathBuf,
}

impl Video {
    pub(super) fn begin(
        place: PartialFile,
        file: &Path,
        container: Container,
        ((width, height), fps): ((u32, u32), u16),
    ) -> Result<Self> {
        let mut command = Command::new(encoder(file)?);
        command
            .args(["-nostdin", "-hide_banner", "-loglevel", "error"])
            .args(["-f", "rawvideo", "-pixel_format", "rgba"])
            .args(["-video_size", &format!("{width}x{height}")])
            .args(["-framerate", &fps.to_string(), "-i", "pipe:0", "-an"])
            .args(container.filter)
            .args(container.flags)
            .args(["-f", container.format, "-y"]);
        let mut written = OsString::from("file:");
        written.push(place.place());
        command
            .arg(written)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        // An interrupt from the keyboard is for rara, which ends the encoder.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut encoder = running();
        let mut child = command.spawn().map_err(|error| {
            Error::format(
                file,
                format!("ffmpeg cannot be started: {error}; see whether `ffmpeg -version` runs"),
            )
        })?;
        let pictures = child.stdin.take();
        let complaint = child.stderr.take().map(|stderr| {
            // Read beside the work, since what waits to be read would hold up the encoder.
            thread::spawn(move || {
                let mut text = Vec::new();
                let mut stderr = stderr;
                let _ = stderr.by_ref().take(1 << 16).read_to_end(&mut text);
                let _ = std::io::copy(&mut stderr, &mut std::io::sink());
                String::from_utf8_lossy(&text).into_owned()
            })
        });
        *encoder = Some(child);
        drop(encoder);
        Ok(Self {
            pictures,
            complaint,
            place: Some(place),
            file: file.to_owned(),
        })
    }

    pub(super) fn add(&mut self, bytes: &[u8]) -> Result<()> {
        let written = self
            .pictures
            .as_mut()
            .map(|pictures| pictures.write_all(bytes));
        match written {
            Some(Ok(())) => Ok(()),
            // It has ended, and says why.
            _ => Err(self.end().err().unwrap_or_else(|| {
                Error::format(
                    &self.file,
                    "ffmpeg ended before it had all pictures; see whether it runs by itself",
                )
            })),
        }
    }

    pub(super) fn finish(mut self) -> Result<()> {
        self.end()?;
        let place = self.place.take();
        place.map_or(Ok(()), PartialFile::finish)
    }

    /// Waits for the encoder; fails where it did.
    fn end(&mut self) -> Result<()> {
        self.pictures = None;
        // Its messages end with it.
        let complaint = self
            .complaint
            .take()
            .and_then(|complaint| complaint.join().ok());
        let child = running().take();
        let Some(mut child) = child else {
            return Ok(());
        };
        let status = child.wait().map_err(Error::io(&self.file))?;
        if status.success() {
            return Ok(());
        }
        let complaint = complaint.unwrap_or_default();
        let lines: Vec<&str> = complaint
            .lines()
            .map(str::trim)
            .filter(|line| !line.is_empty())
            .collect();
        let why = match lines.first() {
            Some(first) => first.chars().take(300).collect(),
            None => status.to_string(),
        };
        Err(Error::format(
            &self.file,
            format!(
                "ffmpeg could not encode the film ({}); write an .apng or numbered pictures (-o frame_{{:04}}.png), or see what \
                 its own encoders are by `ffmpeg -encoders`",
                why.trim_end_matches('.')
            ),
        ))
    }
}

/// What is not finished has no reader: the encoder ends before its file is removed.
impl Drop for Video {
    fn drop(&mut self) {
        self.pictures = None;
        if self.place.is_some()
            && let Some(mut child) = running().take()
        {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
