//! Writes the page that participants see: pictures, data, and the files of this folder.

use std::fs;
use std::path::{Path, PathBuf};

use rara::{Camera, Error, Headless, HeadlessDesc, Mode, Result};
use rara_base::files::write_atomically;
use serde::Serialize;

use super::metric::Metric;
use super::pictures::{Drawing, Files, Id, StudyOptions, columns};
use crate::cases::{Case, Source, cases, names, sources};

#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct StudyPage {
    pub page: PathBuf,
    /// The study, as the answers name it.
    pub study: String,
    pub cases: Vec<String>,
}

/// Writes a user study about scenes from files, or about eight generated ones without any, into a folder. `progress` is
/// called with the number of cases that are drawn and that there are.
///
/// # Errors
/// If a scene cannot be read or drawn, an option makes no sense, or the folder holds something else or cannot be written.
pub fn create(
    folder: &Path,
    scenes: &[PathBuf],
    device: &HeadlessDesc,
    options: &StudyOptions,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<StudyPage> {
    check(folder, options)?;
    let sources = sources(scenes, options.gaussians)?;
    let all = cases(&sources, options.up, (options.size, options.size))?;
    let count = options.cases.min(all.len());
    let spread = (0..count).map(|i| all[i * all.len() / count].clone());
    let mut headless = Headless::new(device)?;
    let cases: Vec<_> = spread.collect();
    let written = write(folder, &mut headless, &sources, &cases, options, progress)?;
    headless.close()?;
    Ok(written)
}

/// Fails where the options make no sense, or the folder holds something that is no study.
fn check(folder: &Path, options: &StudyOptions) -> Result<()> {
    let invalid = |message: &str| Err(Error::Invalid(message.into()));
    if !matches!(options.method, Mode::Rara | Mode::Exact) {
        return invalid(
            "a study compares hard cuts with the mode rara or exact; choose one of them",
        );
    }
    let size = |pixels: u32| (1..=4096).contains(&pixels);
    if !size(options.size) || !size(options.frame_size) {
        return invalid("the pictures of a study have 1 to 4096 pixels a row; choose such a size");
    }
    if !(2..=200).contains(&options.frames) {
        return invalid("the moving cut of a study has 2 to 200 steps; choose such a number");
    }
    if columns(options.frames) * options.frame_size > Camera::MAX_SIZE {
        return invalid(
            "all steps of a moving cut are one picture, which is too large; choose fewer or smaller steps",
        );
    }
    if options.cases == 0 {
        return invalid("a study without a case asks nothing; choose at least one");
    }
    let is_empty = fs::read_dir(folder).map_or(true, |mut entries| entries.next().is_none());
    if !is_empty && !folder.join(DATA).is_file() {
        let message = "the folder holds something else than a study; name a new one";
        return Err(Error::format(folder, message));
    }
    Ok(())
}

const DATA: &str = "data.js";
/// The files of the page that are the same for every study.
const FILES: [(&str, &str); 7] = [
    ("index.html", include_str!("page/index.html")),
    ("style.css", include_str!("page/style.css")),
    ("plan.js", include_str!("page/plan.js")),
    ("record.js", include_str!("page/record.js")),
    ("sweep.js", include_str!("page/sweep.js")),
    ("screens.js", include_str!("page/screens.js")),
    ("main.js", include_str!("page/main.js")),
];
const PICTURES: &str = "pictures";

#[derive(Debug, Serialize)]
struct Data {
    format: &'static str,
    version: u32,
    id: String,
    method: &'static str,
    size: u32,
    sweep: SweepPictures,
    groups: Vec<Vec<Question>>,
    cases: Vec<CasePictures>,
}

/// How the steps of a moving cut lie in their picture.
#[derive(Debug, Serialize)]
struct SweepPictures {
    frames: u32,
    columns: u32,
    size: u32,
}

#[derive(Debug, Serialize)]
struct Question {
    key: Metric,
    name: &'static str,
    definition: &'static str,
    /// True where the animations matter more than the pictures.
    moves: bool,
}

#[derive(Debug, Serialize)]
struct CasePictures {
    name: String,
    hard: Files,
    method: Files,
}

/// Writes a user study about these cases of these scenes into a folder. As [`create`] otherwise, which chooses them.
pub fn write(
    folder: &Path,
    headless: &mut Headless,
    sources: &[Source],
    cases: &[Case],
    options: &StudyOptions,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<StudyPage> {
    check(folder, options)?;
    let pictures = folder.join(PICTURES);
    fs::create_dir_all(&pictures).map_err(Error::io(&pictures))?;
    let mut drawing = Drawing {
        folder,
        headless,
        options,
        id: Id::new(),
    };
    let names = names(sources, cases);
    let mut shown = Vec::new();
    let mut loaded = None;
    for (number, (case, name)) in cases.iter().zip(&names).enumerate() {
        progress(number, cases.len());
        if loaded != Some(case.scene) {
            drawing.headless.load(sources[case.scene].scene())?;
            loaded = Some(case.scene);
        }
        drawing.id.add(name.as_bytes());
        // File names do not tell which of the two is which.
        let start = format!("{PICTURES}/case-{:02}", number + 1);
        shown.push(CasePictures {
            name: name.clone(),
            hard: drawing.files(case, Mode::Hard, &format!("{start}-1"))?,
            method: drawing.files(case, options.method, &format!("{start}-2"))?,
        });
    }
    progress(cases.len(), cases.len());
    let data = Data::new(options, drawing.id, shown);
    data.write(folder)?;
    Ok(StudyPage {
        page: folder.join("index.html"),
        study: data.id,
        cases: names,
    })
}

impl Data {
    fn new(options: &StudyOptions, mut id: Id, cases: Vec<CasePictures>) -> Self {
        let method = if options.method == Mode::Rara {
            "rara"
        } else {
            "exact"
        };
        id.add(method.as_bytes());
        let groups = Metric::ALL.chunks(3);
        Self {
            format: super::answers::FORMAT,
            version: super::answers::VERSION,
            id: id.text(),
            method,
            size: options.size,
            sweep: SweepPictures {
                frames: options.frames,
                columns: columns(options.frames),
                size: options.frame_size,
            },
            groups: groups
                .map(|group| group.iter().map(asked).collect())
                .collect(),
            cases,
        }
    }

    /// Writes everything but the pictures.
    fn write(&self, folder: &Path) -> Result<()> {
        let json = serde_json::to_string_pretty(self);
        let json = json.map_err(|error| Error::Invalid(error.to_string()))?;
        let data_js = format!("\"use strict\";\n\nconst STUDY = {json};\n");
        for (name, content) in FILES.into_iter().chain([(DATA, data_js.as_str())]) {
            write_atomically(&folder.join(name), |file| {
                file.write_all(content.as_bytes())
            })?;
        }
        Ok(())
    }
}

fn asked(metric: &Metric) -> Question {
    Question {
        key: *metric,
        name: metric.name(),
        definition: metric.definition(),
        moves: *metric == Metric::TemporalStability,
    }
}

#[cfg(test)]
mod tests;
