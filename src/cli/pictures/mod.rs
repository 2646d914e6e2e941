//! Where the pictures of a run go: files of their own, a folder, a film, or standard output.
//!
//! A command plans its pictures, and draws those that are [left](Destination::left) one by one. What is drawn goes to its
//! place, and is reported, at once.

mod drawn;
mod part;
mod writer;

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use clap::Args;
use rara::{Error, HeadlessDesc, PngCompression, Settings};
use serde_json::json;

use super::failure::Failure;
use super::film::{self, FilmArgs, FilmFormat};
use super::output::{self, STANDARD, counted_are, say};
use super::pattern::{filled, is_several};
use super::report::{Answer, FrameRecord};
use super::scenes::SceneArgs;
use super::values;
pub(super) use drawn::{Pixels, RenderedPicture};
pub(super) use part::RunPart;

/// What becomes of pictures, and of what is measured.
#[derive(Debug, Args)]
pub(super) struct PictureArgs {
    /// Divide the pictures into N parts, and draw only part K, from 1 to N
    ///
    /// The pictures keep the numbers that they have without --part. N jobs with K from 1 to N therefore draw all of them.
    #[arg(long, value_name = "K/N")]
    part: Option<RunPart>,
    /// Skip pictures whose files exist, without checking what is in the files
    ///
    /// After an interruption, the same command with this flag draws the missing pictures.
    #[arg(long)]
    skip_existing: bool,
    /// Print the statistics as JSON
    #[arg(long)]
    json: bool,
    /// Print the statistics of each picture as a line of JSON
    ///
    /// A line is printed as soon as the file of its picture is written.
    #[arg(long, conflicts_with = "json")]
    json_lines: bool,
    /// Compression of .png files; every choice is lossless [default: fast]
    #[arg(long, value_name = "HOW", value_parser = values::named::<PngCompression>())]
    png: Option<PngCompression>,
    /// Add this command to a file as a job for rara batch, and draw nothing
    #[arg(long, value_name = "FILE", value_parser = values::json_file())]
    save_job: Option<PathBuf>,
    #[command(flatten)]
    film: FilmArgs,
}

/// What a picture of counts is made of.
pub(super) const COUNTS: &str = "--show count draws numbers of splats";

/// Refuses `what` for files that do not hold it: 8 bits end at the colour white.
pub(super) fn needs_floats(output: Option<&Path>, what: &str) -> Result<(), Failure> {
    let holds = |file: &Path| output::ends_in(file, "exr") || output::ends_in(file, "npy");
    match output.is_none_or(holds) {
        true => Ok(()),
        false => Err(Failure::Usage(format!(
            "{what}, which only .exr and .npy files hold: give -o a name that ends in one of these"
        ))),
    }
}

/// The place that pictures go to, checked before any work is done.
pub(super) struct Destination<'a> {
    args: &'a PictureArgs,
    place: OutputTarget,
    order: Option<&'a dyn Order>,
}

/// A run of many commands, of which one draws some of its pictures. A film is its picture 0.
pub(super) trait Order: Sync {
    /// True for the pictures that are asked for.
    fn wants(&self, number: usize) -> bool;

    /// Asks for a picture before it is drawn; false where another process has drawn it, or is drawing it.
    fn begin(&self, number: usize, file: Option<&Path>) -> Result<bool, Failure>;

    /// Learns that a picture is there.
    fn end(&self, number: usize, file: &Path, frame: &FrameRecord) -> Result<(), Failure>;

    /// Learns which driver draws the next pictures.
    fn opened(&self, driver: &str);
}

enum OutputTarget {
    Nowhere,
    /// Files by a pattern, or standard output.
    Files(PathBuf),
    /// frame_000.png and so on.
    Folder(PathBuf),
    Film(FilmFormat, PathBuf),
}

/// A picture that is to be drawn, and its file.
pub(super) struct PictureJob<T> {
    /// The number of the picture in the whole run.
    number: usize,
    pub(super) what: T,
    pub(super) file: Option<PathBuf>,
}

/// Stands for a name that is not known yet.
const NAME: &str = "{name}";

/// Bytes of a Gaussian in a file of degree 3; other files are counted as if they were such.
const BYTES: f64 = 248.0;

/// What a run of many commands knows of one before it draws.
pub(super) struct Plan {
    /// The numbers of its pictures, and what their files are called where names are left open. A film is number 0.
    pub(super) pictures: Vec<(usize, String)>,
    /// An estimate of the work of one, in Gaussians that are drawn.
    pub(super) work: f64,
    /// The scene's flags, so that commands of one scene follow each other.
    pub(super) scene: String,
    pub(super) device: HeadlessDesc,
}

impl PictureArgs {
    pub(super) fn answer(&self) -> Answer {
        match (self.json, self.json_lines) {
            (true, _) => Answer::Document,
            (_, true) => Answer::Lines,
            _ => Answer::Table,
        }
    }

    /// Refuses channels beside the colours for what has no place for them.
    pub(super) fn check_takes_channels(&self, output: Option<&Path>) -> Result<(), Failure> {
        let is_stream = output == Some(Path::new(STANDARD));
        match is_stream || self.film.kind(output)?.is_some() {
            false => Ok(()),
            true => Err(Failure::Usage(
                "--aov makes channels, which films, sheets and standard output do not hold: give -o a name that ends in .exr, \
                 .png or .npy"
                    .into(),
            )),
        }
    }

    /// Gives a film so many pictures a second, if there are any and no flag says otherwise.
    pub(super) fn pace(&mut self, fps: Option<f64>) {
        self.film.pace(fps);
    }

    /// The place that pictures of these numbers go to. `several` is what makes more than one of them, if anything does.
    pub(super) fn destination<'a>(
        &'a self,
        output: Option<&Path>,
        (numbers, several): (&[usize], Option<&str>),
        order: Option<&'a dyn Order>,
    ) -> Result<Destination<'a>, Failure> {
        let place = self.place(output, several.is_some())?;
        self.check(&place, several.is_some())?;
        match &place {
            OutputTarget::Nowhere => {}
            OutputTarget::Folder(folder) => output::make_folder(folder)?,
            OutputTarget::Files(pattern) => check_pattern(pattern, numbers, several)?,
            OutputTarget::Film(kind, file) => {
                self.film.check(*kind, file)?;
                if several.is_none() && *kind != FilmFormat::Sheet {
                    output::warn_once(
                        "note: this is a film of one picture, because nothing moves; --path orbit moves the camera, and rara sweep \
                         moves a clip"
                            .into(),
                    );
                }
            }
        }
        Ok(Destination {
            args: self,
            place,
            order,
        })
    }

    fn place(&self, output: Option<&Path>, several: bool) -> Result<OutputTarget, Failure> {
        let Some(output) = output else {
            return Ok(OutputTarget::Nowhere);
        };
        let is_folder = values::is_folder(output);
        match film::film_path(output.into()) {
            Ok(file) if !is_folder => {
                let kind = self.film.kind(Some(output))?;
                return Ok(match kind {
                    Some(kind) => OutputTarget::Film(kind, file),
                    None => OutputTarget::Files(file),
                });
            }
            Err(why) if !(is_folder || several && may_be_a_folder(output)) => {
                return Err(Failure::Usage(format!("{}: {why}", output.display())));
            }
            _ => {}
        }
        self.film.kind(None)?;
        if !several {
            let error = Error::format(output, "this is a folder; name a file in it");
            return Err(error.into());
        }
        Ok(OutputTarget::Folder(output.to_owned()))
    }

    /// Refuses flags that have no meaning there.
    fn check(&self, place: &OutputTarget, several: bool) -> Result<(), Failure> {
        let flags = [
            ("--part", self.part.is_some()),
            ("--skip-existing", self.skip_existing),
            ("--json-lines", self.json_lines),
            ("--json", self.json),
        ];
        let is_given = |wanted: &[&str]| {
            let given = flags
                .iter()
                .find(|(flag, is_given)| *is_given && wanted.contains(flag));
            given.map(|(flag, _)| *flag)
        };
        let is_stream = match place {
            OutputTarget::Files(file) | OutputTarget::Film(_, file) => file == Path::new(STANDARD),
            OutputTarget::Nowhere | OutputTarget::Folder(_) => false,
        };
        if let Some(flag) = is_given(&["--json", "--json-lines"]).filter(|_| is_stream) {
            return Err(Failure::Usage(format!(
                "-o - and {flag} both take standard output: name a file for the picture"
            )));
        }
        let whole = is_given(&["--part", "--skip-existing", "--json-lines"]);
        if let (OutputTarget::Film(..), Some(flag)) = (place, whole) {
            return Err(Failure::Usage(format!(
                "{flag} is for pictures in files of their own, and not for a film or a sheet: leave out {flag}, or name numbered \
                 pictures, as in -o frame_{{:04}}.png"
            )));
        }
        let is_png = match place {
            OutputTarget::Folder(_) => true,
            OutputTarget::Files(file) => is_stream || output::ends_in(file, "png"),
            OutputTarget::Film(FilmFormat::Sheet, file) => output::ends_in(file, "png"),
            OutputTarget::Nowhere | OutputTarget::Film(..) => false,
        };
        if self.png.is_some() && !is_png {
            return Err(Failure::Usage(
                "--png is for .png files: leave out --png, or give -o a name that ends in .png"
                    .into(),
            ));
        }
        if is_stream && self.skip_existing {
            return Err(Failure::Usage(
                "--skip-existing looks for files, and -o - writes none: leave out one of them"
                    .into(),
            ));
        }
        if self.part.is_some() && !several {
            return Err(Failure::Usage(
                "--part divides several pictures, but this command draws one: leave out --part, or draw more by --path, --view all or \
                 --section"
                    .into(),
            ));
        }
        Ok(())
    }
}

/// True for a name that stands neither for several files nor for a file of another kind: its ending, if any, is a part of a number.
fn may_be_a_folder(output: &Path) -> bool {
    let ending = output.extension().unwrap_or_default().as_encoded_bytes();
    !is_several(output) && !ending.first().is_some_and(u8::is_ascii_alphabetic)
}

/// Fails where several pictures would be one file, or the first one could not be written.
fn check_pattern(pattern: &Path, numbers: &[usize], several: Option<&str>) -> Result<(), Failure> {
    if let Some(what) = several.filter(|_| !is_several(pattern)) {
        let remedy = match pattern == Path::new(STANDARD) {
            true => "name a file with {} where their number goes, or give --format apng or rgba",
            false => {
                "put {} where their number goes, as in -o view_{}.png, put all on one sheet by --sheet, or name a film, as film.apng"
            }
        };
        return Err(Failure::Usage(format!("{what} several pictures: {remedy}")));
    }
    // Folders whose names have a slot are made when all names are known.
    if pattern.parent().is_some_and(is_several) {
        return Ok(());
    }
    let first = numbers.first().copied().unwrap_or(0);
    Ok(output::check_file(&filled(pattern, first, "x"))?)
}

impl Destination<'_> {
    /// The settings for pictures that go there: on black where nothing else is said and they can have no transparency.
    pub(super) fn settings(&self, settings: Settings) -> Settings {
        match &self.place {
            OutputTarget::Film(kind, _) if kind.is_opaque() && settings.background.is_none() => {
                film::say_opaque();
                settings.background(Some([0.0; 3]))
            }
            _ => settings,
        }
    }

    fn file(&self, number: usize, name: &str) -> Option<PathBuf> {
        match &self.place {
            OutputTarget::Nowhere => None,
            OutputTarget::Files(pattern) => Some(filled(pattern, number, name)),
            OutputTarget::Folder(folder) => Some(folder.join(format!("frame_{number:03}.png"))),
            OutputTarget::Film(_, file) => Some(file.clone()),
        }
    }

    /// The run of many commands that asks for single pictures, if one does.
    pub(super) fn order(&self) -> Option<&dyn Order> {
        self.order
    }

    /// What a run of many commands knows of this one, whose pictures have a size.
    pub(super) fn plan(
        &self,
        (scenes, device): (&SceneArgs, HeadlessDesc),
        numbers: &[usize],
        (width, height): (u32, u32),
    ) -> Plan {
        let (frames, numbers) = match self.place {
            OutputTarget::Film(..) => (numbers.len(), &[0][..]),
            _ => (1, numbers),
        };
        let called = |&number: &usize| {
            let file = self.file(number, NAME).unwrap_or_default();
            let text = file.to_string_lossy();
            let is_open = text.contains(NAME);
            let number_too = format!("{text}, {number}");
            (number, if is_open { number_too } else { text.into() })
        };
        let bytes = scenes.places().into_iter().map(|place| {
            let length = std::fs::metadata(place).map_or(0, |about| about.len());
            length as f64
        });
        let gaussians = bytes.sum::<f64>() / BYTES;
        let pixels = f64::from(width) * f64::from(height);
        Plan {
            pictures: numbers.iter().map(called).collect(),
            work: frames as f64 * (gaussians + 0.5 * pixels),
            scene: format!("{scenes:?}"),
            device,
        }
    }

    /// The files of pictures of these numbers that have no names.
    pub(super) fn files(&self, numbers: &[usize]) -> Vec<PathBuf> {
        let files = numbers.iter().filter_map(|number| self.file(*number, ""));
        files.collect()
    }

    /// The pictures that are left to draw, with their files, whose folders are there from now on: those of --part, and of
    /// these the ones that --skip-existing does not leave out. None where that are none, which is then said. `called` is
    /// the number and the name of one.
    pub(super) fn left<T>(
        &self,
        all: Vec<T>,
        called: impl Fn(&T) -> (usize, String),
    ) -> Result<Option<Vec<PictureJob<T>>>, Failure> {
        let of_one = |what| {
            let (number, name) = called(&what);
            let file = self.file(number, &name);
            PictureJob { number, what, file }
        };
        let mut planned: Vec<_> = all.into_iter().map(of_one).collect();
        if !matches!(self.place, OutputTarget::Film(..)) {
            check_distinct(&planned, called)?;
        }
        let whole = planned.len();
        if let Some(part) = self.args.part {
            planned = part.take_from(planned);
            if planned.is_empty() {
                say(format_args!(
                    "note: part {part} has no picture, because there are fewer pictures ({whole}) than parts"
                ));
            }
        }
        if let (Some(order), false) = (self.order, matches!(self.place, OutputTarget::Film(..))) {
            planned.retain(|one| order.wants(one.number));
        }
        let before = planned.len();
        if self.args.skip_existing {
            let is_there = |file: &PathBuf| file.is_file();
            planned.retain(|one| !one.file.as_ref().is_some_and(is_there));
            say(format_args!(
                "note: {} of {} there and left out",
                before - planned.len(),
                counted_are(before as u64, "picture")
            ));
        }
        let files = planned.iter().filter_map(|one| one.file.as_deref());
        let mut folders = HashSet::new();
        for file in files {
            if folders.insert(file.parent()) {
                output::check_file(file)?;
            }
        }
        if planned.is_empty() && whole > 0 {
            if self.args.json {
                output::json(&json!({ "frames": [] }))?;
            }
            return Ok(None);
        }
        Ok(Some(planned))
    }

    /// The size that is reported of pictures of these sizes; those of a film have one.
    pub(super) fn size(
        &self,
        mut sizes: impl Iterator<Item = (u32, u32)>,
    ) -> Result<(u32, u32), Failure> {
        match self.place {
            OutputTarget::Film(..) => film::one_size(sizes),
            _ => Ok(sizes.next().unwrap_or((0, 0))),
        }
    }
}

fn check_distinct<T>(
    planned: &[PictureJob<T>],
    called: impl Fn(&T) -> (usize, String),
) -> Result<(), Failure> {
    let mut files = HashMap::new();
    for PictureJob { what, file, .. } in planned {
        let Some(file) = file else {
            return Ok(());
        };
        if let Some(other) = files.insert(file, what) {
            let [other, one] = [other, what].map(|what| called(what).1);
            return Err(Failure::Usage(format!(
                "the pictures of {other} and {one} would be one file: put {{}} where their number goes"
            )));
        }
    }
    Ok(())
}
