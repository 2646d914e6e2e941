//! `rara bench`: what each mode and each choice of precision costs and how far its picture is from the exact cut.

mod chart;
mod clock;
mod judge;
mod paper;
mod shapes;
mod tables;
mod variants;

use std::path::PathBuf;

use clap::Args;
use rara::{Clip, ClipOp};
use rara_lab::measure::undominated;
use serde::Serialize;

use super::camera::CameraArgs;
use super::clip::ClipArgs;
use super::demo::middle;
use super::failure::Failure;
use super::output::{self, Progress, say};
use super::scenes::SceneArgs;
use super::session::Session;
use super::settings::{DeviceArgs, LookArgs};
use clock::Times;
use judge::{Judge, Measures};
use variants::variants;

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
pareto.svg and pareto.png.")]
pub(super) struct Bench {
    /// Frames of each choice, one of each in turn
    #[arg(long, value_name = "N", default_value_t = 11, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    frames: u32,
    /// Steps of the slow sweep that popping is measured over, each a 300th of the scene
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=1000))]
    steps: u32,
    /// Only the choices of this name (repeatable), as the table has it
    #[arg(long, value_name = "NAME", value_parser = variants::names())]
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

/// Everything that was measured.
#[derive(Debug, Serialize)]
struct Report {
    scene: String,
    gaussians: usize,
    size: [u32; 2],
    device: String,
    driver: String,
    frames: u32,
    steps: u32,
    /// Share of the picture in which the way of cutting makes a difference: where the hard and the exact truth differ,
    /// and 5 px around.
    band_share: f64,
    rows: Vec<Row>,
    paper: Vec<paper::Line>,
    shapes: Vec<shapes::Line>,
    refused: Vec<String>,
}

/// The measurements of one choice.
#[derive(Debug, Serialize)]
struct Row {
    name: &'static str,
    flags: &'static str,
    #[serde(flatten)]
    measures: Measures,
    #[serde(flatten)]
    times: Times,
    /// True when no other choice is both faster and nearer to the truth.
    undominated: bool,
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
        let camera = views.of(&scene)?.remove(0).camera;
        let clip = clip.clip(&scene)?;
        let clip = if clip.is_everything() {
            Clip::of([middle(&scene, &camera)?], ClipOp::And)
        } else {
            clip
        };
        let mut all = variants(look);
        all.retain(|v| self.only.is_empty() || self.only.iter().any(|name| name == v.name));
        let mut session = Session::open(&self.device.meant(), &scene, look.precision.sh)?;

        // First which pictures are right and how far each is from the truth; then what they cost.
        let mut progress = Progress::new("measuring");
        let total = all.len() as u64 + 2;
        let judge = Judge::new(&scene, &camera, &clip, &look, self.steps)?;
        let (mut right, mut measured, mut refused) = (Vec::new(), Vec::new(), Vec::new());
        for (done, variant) in all.into_iter().enumerate() {
            progress.update(done as u64, total);
            session.reload(&scene, variant.settings.precision.sh)?;
            let measures = judge.measure(&mut session, &variant.settings)?;
            let least = variant.settings.precision.least_psnr();
            if measures.twin_psnr >= least {
                right.push(variant);
                measured.push(measures);
            } else {
                refused.push(format!(
                    "{} ({}): {:.1} dB against its own picture in double precision, where {least} is the least",
                    variant.name, variant.flags, measures.twin_psnr
                ));
            }
        }
        progress.update(total - 1, total);
        let named: Vec<_> = right.iter().map(|v| v.name).zip(&measured).collect();
        let paper = paper::lines(
            &mut session,
            &scene,
            (&camera, &clip),
            &look,
            self.steps,
            &named,
        )?;
        let settings: Vec<_> = right.iter().map(|v| (&clip, v.settings)).collect();
        let times = clock::time(&mut session, &scene, &camera, &settings, self.frames)?;
        let shapes = match self.shapes {
            true => {
                let plane = middle(&scene, &camera)?;
                shapes::lines(&mut session, &scene, &camera, plane, &look, self.frames)?
            }
            false => Vec::new(),
        };
        drop(progress);

        let mut rows: Vec<Row> = right
            .iter()
            .zip(measured)
            .zip(times)
            .map(|((variant, measures), times)| Row {
                name: variant.name,
                flags: variant.flags,
                measures,
                times,
                undominated: false,
            })
            .collect();
        // Mode `none` is left out, since it is no way of cutting.
        let point = |row: &Row| match row.name {
            "none" => [f64::NAN; 2],
            _ => [row.times.cost, row.measures.l1],
        };
        let points: Vec<_> = rows.iter().map(point).collect();
        for index in undominated(&points) {
            rows[index].undominated = true;
        }
        let (device, driver, _) = session.about();
        session.close()?;
        let names: Vec<_> = scene.layers().iter().map(|layer| layer.name()).collect();
        let report = Report {
            scene: names.join(" + "),
            gaussians: scene.gaussians(),
            size: [camera.width, camera.height],
            device,
            driver,
            frames: self.frames,
            steps: self.steps,
            band_share: judge.band_share(),
            rows,
            paper,
            shapes,
            refused,
        };
        if let Some(folder) = &self.output {
            tables::write(folder, &report)?;
            chart::write(folder, &report)?;
        }
        if self.json {
            output::json(&report)?;
        } else {
            say(tables::markdown(&report));
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
