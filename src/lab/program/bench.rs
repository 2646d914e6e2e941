//! `rara-lab bench`: what each mode and each choice of precision costs and how far its picture is from the exact cut.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use rara::{Clip, ClipOp};
use rara_cli::parts::{
    CameraArgs, ClipArgs, DeviceArgs, Failure, LookArgs, ProgressLine, SceneArgs, counted, json,
    make_folder, middle, one_file, say, text,
};
use rara_lab::bench::{self, BenchOptions};
use rara_lab::table::Table;

/// Time every mode, law, preset and precision, and measure their errors
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara-lab bench scene.ply -o bench
  rara-lab bench scene.ply --clip plane:0,0,1,-2 --size 512x512 --frames 21 --json
  rara-lab bench scene.ply --shapes --only exact

Without --clip, a plane cuts the scene through its middle. The reference for errors is a picture in double precision, in mode
exact with the depth law, whose splat weights are exact in perspective. Each choice is also compared with a picture of the same
choice in double precision. If the difference is above the choice's error bound, the choice is not timed, and the exit status is
1. The command writes bench.md, bench.csv, bench.json and pareto.svg to the folder of -o.")]
pub(super) struct Bench {
    /// Number of frames of each choice; the choices take turns after each frame
    #[arg(long, value_name = "N", default_value_t = 11, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    frames: u32,
    /// Number of steps of the sweep that measures popping; a step is a 300th of the scene
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=1000))]
    steps: u32,
    /// Measure only the choices with this name in the table (repeatable)
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::from(bench::names()))]
    only: Vec<String>,
    /// Also measure all shapes and combinations, against a plane through the same point
    #[arg(long)]
    shapes: bool,
    /// Folder for the tables and the plot; created if it does not exist
    #[arg(short, long, value_name = "DIR", value_parser = one_file())]
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
        let look = self.look.meant();
        let (clip, views) = (
            self.clip.meant()?,
            self.camera
                .meant(&self.scenes.places())?
                .single("a bench")?,
        );
        if let Some(folder) = &self.output {
            make_folder(folder)?;
        }
        let mut loaded = self.scenes.load()?;
        clip.settle(&mut loaded)?;
        let scene = loaded.scene();
        let camera = views.boxed(&scene)?.remove(0).camera;
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
            let file = |name: &str, content: &str| text(&folder.join(name), content);
            file("bench.md", &report.markdown())?;
            file(
                "bench.csv",
                &report.tables().first().map_or(String::new(), Table::csv),
            )?;
            let document = serde_json::to_string_pretty(&report).expect("it has string keys only");
            file("bench.json", &(document + "\n"))?;
            file("pareto.svg", &report.chart().svg())?;
        }
        if self.json {
            json(&report)?;
        } else {
            say(report.markdown());
        }
        match report.refused.first() {
            None => Ok(()),
            Some(first) => Err(rara::Error::Invalid(format!(
                "not timed, because the picture is wrong: {}; {first}",
                counted(report.refused.len() as u64, "choice")
            ))
            .into()),
        }
    }
}
