//! Output of the numbers: lines of a CSV and tables on the terminal.

use std::fs::{File, OpenOptions, create_dir_all};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use rara::{Error, Headless, Result};

use crate::args::Section;
use crate::statistics::Summary;

const COLUMNS: &str =
    "date,commit,device,driver,section,scene,gaussians,size,variant,pass,unit,n,min,median,p90";

/// The subject of a number.
#[derive(Debug, Clone)]
pub(crate) struct Place {
    pub(crate) section: Section,
    pub(crate) scene: String,
    pub(crate) gaussians: usize,
    /// Of the picture; 0 x 0 where there is none.
    pub(crate) size: [u32; 2],
}

impl Place {
    pub(crate) fn title(&self) -> String {
        let (section, scene) = (self.section.name(), &self.scene);
        let title = format!("{section}: {scene}, {} Gaussians", grouped(self.gaussians));
        match self.size {
            [0, _] => title,
            [width, height] => format!("{title}, {width}x{height}"),
        }
    }
}

/// The file and what each of its lines begins with.
#[derive(Debug)]
pub(crate) struct Report {
    begin: String,
    csv: Option<(PathBuf, File)>,
}

impl Report {
    pub(crate) fn new(folder: Option<&Path>, headless: &Headless) -> Result<Self> {
        let here = env!("CARGO_MANIFEST_DIR");
        let commit =
            said(Command::new("git").args(["-C", here, "describe", "--always", "--dirty"]));
        let date = said(Command::new("date").args(["-u", "+%Y-%m-%dT%H:%M:%SZ"]));
        let (device, driver) = (headless.device_name(), headless.driver());
        println!("{date}, commit {commit}, {device}, {driver}");
        let texts = [&date, &commit, device, driver];
        Ok(Self {
            begin: texts.map(quoted).join(","),
            csv: folder.map(open).transpose()?,
        })
    }

    /// A line of the file.
    pub(crate) fn row(
        &mut self,
        place: &Place,
        (variant, pass, unit): (&str, &str, &str),
        s: &Summary,
    ) -> Result<()> {
        let Some((path, file)) = &mut self.csv else {
            return Ok(());
        };
        let [width, height] = place.size;
        let texts = [place.section.name(), &place.scene].map(quoted).join(",");
        let names = [variant, pass, unit].map(quoted).join(",");
        let numbers = [s.min, s.median, s.p90].map(number).join(",");
        let line = format!(
            "{},{texts},{},{width}x{height},{names},{},{numbers}\n",
            self.begin, place.gaussians, s.n
        );
        file.write_all(line.as_bytes())
            .map_err(Error::io(path.clone()))
    }

    /// Notes what cannot be measured here for lack of memory.
    pub(crate) fn no_memory(&mut self, place: &Place, why: &str) -> Result<()> {
        println!("\n{}: no memory: {why}", place.title());
        self.row(place, ("", "no memory", ""), &Summary::of(&[]))
    }
}

fn open(folder: &Path) -> Result<(PathBuf, File)> {
    create_dir_all(folder).map_err(Error::io(folder))?;
    let path = folder.join("bench.csv");
    let mut file = OpenOptions::new()
        .create(true)
        .append(true)
        .open(&path)
        .map_err(Error::io(path.clone()))?;
    if file.metadata().map_err(Error::io(path.clone()))?.len() == 0 {
        writeln!(file, "{COLUMNS}").map_err(Error::io(path.clone()))?;
    }
    Ok((path, file))
}

/// The text that a command prints.
fn said(command: &mut Command) -> String {
    let output = command
        .output()
        .ok()
        .filter(|output| output.status.success());
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    text.unwrap_or_else(|| "unknown".into())
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

fn number(value: f64) -> String {
    if value.is_nan() {
        String::new()
    } else {
        format!("{value:.6}")
    }
}

/// 1 234 567.
pub(crate) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// Prints on the terminal what is being done.
pub(crate) fn say(text: impl std::fmt::Display) {
    eprintln!("bench: {text}");
}
