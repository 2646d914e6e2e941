//! `rara bench`: what each mode and each choice of precision costs and how far its picture is from the exact cut.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use rara::{Clip, ClipOp};
use rara_lab::bench::{self, BenchOptions};
use rara_lab::table::Table;

use super::camera::CameraArgs;
use super::clip::ClipArgs;
use super::demo::middle;
use super::failure::Failure;
use super::framing;
use super::output::{self, ProgressLine, say};
use super::scenes::SceneArgs;
use super::settings::{DeviceArgs, LookArgs};

/// Time every mode, law, preset and precision, and measure their errors
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara bench scene.ply -o bench
  rara bench scene.ply --clip plane:0,0,1,-2 --size 512x512 --frames 21 --json
  rara bench scene.ply --shapes --only exact

Without --clip a plane cuts the scene through its middle. Errors are against mode exact with the depth law, each splat
in the form that is exact in perspective, in double precision. What is not within its own bound of its own picture in
double precision is not timed, and exit status 1 says so. The folder of -o gets bench.md, bench.csv, bench.json and
pareto.svg.")]
pub(super) struct Bench {
    /// Frames of each choice, one of each in turn
    #[arg(long, value_name = "N", default_value_t = 11, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    frames: u32,
    /// Steps of the slow sweep that popping is measured over, each a 300th of the scene
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=1000))]
    steps: u32,
    /// Only the choices of this name (repeatable), as the table has it
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::from(bench::names()))]
    only: Vec<String>,
    /// Also every shape, and combinations of them, beside a plane through the same point
    #[arg(long)]
    shapes: bool,
    /// Folder for the tables and the plot; made unless it is there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print everything as JSON to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    clip: ClipArgs,
    #[command(flatten)]
    look: LookArgs,
    #[command(flatten)]
    device: DeviceArgs,
    #[command(flatten)]
    scenes: SceneArgs,
}

impl Bench {
    pub(super) fn run(self) -> Result<(), Failure> {
        let look = self.look.meant()?;
        let (clip, views) = (
            self.clip.meant()?,
            self.camera
                .meant(&self.scenes.places())?
                .single("a bench")?,
        );
        if let Some(folder) = &self.output {
            output::make_folder(folder)?;
        }
        let mut loaded = self.scenes.load()?;
        clip.settle(&mut loaded)?;
        let scene = loaded.scene();
        let camera = framing::boxed_views(views, &scene)?.remove(0).camera;
        let clip = clip.clip(&scene)?;
        let clip = if clip.is_everything() {
            Clip::of([middle(&scene, &camera)?], ClipOp::And)
        } else {
            clip
        };
        let options = BenchOptions {
            frames: self.frames,
            steps: self.steps,
            only: self.only,
            shapes: self.shapes.then(|| middle(&scene, &camera)).transpose()?,
        };
        let mut headless = self.device.headless()?;
        let mut progress = ProgressLine::new("measuring");
        let report = bench::bench(
            &mut headless,
            (&scene, &camera, &clip),
            &look,
            &options,
            &mut |done, total| progress.update(done, total),
        )?;
        drop(progress);
        headless.close()?;
        if let Some(folder) = &self.output {
            let file = |name: &str, text: &str| output::text(&folder.join(name), text);
            file("bench.md", &report.markdown())?;
            file(
                "bench.csv",
                &report.tables().first().map_or(String::new(), Table::csv),
            )?;
            let json = serde_json::to_string_pretty(&report).expect("it has string keys only");
            file("bench.json", &(json + "\n"))?;
            file("pareto.svg", &report.chart().svg())?;
        }
        if self.json {
            output::json(&report)?;
        } else {
            say(report.markdown());
        }
        match report.refused.first() {
            None => Ok(()),
            Some(first) => Err(rara::Error::Invalid(format!(
                "not timed, because the picture is wrong: {}; {first}",
                output::counted(report.refused.len() as u64, "choice")
            ))
            .into()),
        }
    }
}
