//! `rara-lab study` and `rara-lab study-report`: the paper's user study as a web page, and what its answers say.

use std::path::PathBuf;

use clap::Args;
use rara::Mode;
use rara_cli::parts::{
    DeviceArgs, Failure, ProgressLine, counted, json, make_drivers_folder, named, one_file, say,
};
use rara_lab::study::{self, report};

/// Write a web page for a user study like the paper's
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara-lab study study
  rara-lab study study skull.ply hair.ply --method rara --cases 12

Open index.html of the folder in a browser; it needs no server and no network. Participants choose between two pictures, one cut
by centres and one cut by the method of --method. They save their answers as a file, and rara-lab study-report evaluates these
files.")]
pub(super) struct Study {
    /// Folder for the page and its pictures; created if it does not exist
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Scene files [default: eight generated scenes]
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// The method that is compared with cutting by centres
    #[arg(long, value_parser = named::<Mode>(), default_value = Mode::Rara.name())]
    method: Mode,
    /// Number of cases
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=1000))]
    cases: u32,
    /// Print what was written as JSON to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    device: DeviceArgs,
}

impl Study {
    pub(super) fn run(self) -> Result<(), Failure> {
        if !matches!(self.method, Mode::Rara | Mode::Exact) {
            return Err(Failure::Usage(
                "--method is rara or exact: these are what a study compares with hard".into(),
            ));
        }
        let options = study::StudyOptions {
            method: self.method,
            cases: self.cases as usize,
            ..study::StudyOptions::default()
        };
        make_drivers_folder();
        let mut progress = ProgressLine::new("drawing");
        let written = study::create(
            &self.folder,
            &self.scenes,
            &self.device.meant(),
            &options,
            &mut |done, total| progress.update(done as u64, total as u64),
        )?;
        drop(progress);
        if self.json {
            return Ok(json(&written)?);
        }
        say(format_args!(
            "{} of study {}: open {}",
            counted(written.cases.len() as u64, "case"),
            written.study,
            written.page.display()
        ));
        Ok(())
    }
}

/// Evaluate the answers of a user study
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  rara-lab study-report answers/*.json -o result

The folder gets report.html, which needs no other file, and also report.md, metrics.csv, answers.csv and the charts.")]
pub(super) struct StudyReport {
    /// Files that participants have saved
    #[arg(value_name = "ANSWERS", required = true)]
    answers: Vec<PathBuf>,
    /// Folder for the report; created if it does not exist
    #[arg(short, long, value_name = "DIR", value_parser = one_file(), default_value = "study-report")]
    output: PathBuf,
    /// Print the evaluation as JSON to stdout
    #[arg(long)]
    json: bool,
}

impl StudyReport {
    pub(super) fn run(self) -> Result<(), Failure> {
        let evaluation = report::create(
            &self.answers,
            &self.output,
            &report::ReportOptions::default(),
        )?;
        if self.json {
            return Ok(json(&evaluation)?);
        }
        say(format_args!(
            "the report is {}",
            self.output.join("report.html").display()
        ));
        Ok(())
    }
}
