//! `rara model`: what GPUs are predicted to take for each pass of a frame, and what this device takes for each stage.

mod tables;

use std::path::PathBuf;

use clap::Args;
use rara::gpu::DeviceShape;
use rara::{Camera, Clip, Error, FrameStats, Mode, Raster, Scene, Settings, ShFormat};
use rara_lab::measure::gpu_model::{self, GPUS, Gpu, ModelFrame, PassPrediction};
use serde::Serialize;

use super::failure::Failure;
use super::output::{self, Progress};
use super::session::Session;
use super::settings::DeviceArgs;

/// Predict what a few GPUs take for each pass of a frame
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara model
  rara model --measure -o model          # draws the same frames, and compares each stage

The frames are those of generated scenes of 1 M and 5 M Gaussians at 1920x1080, whole and cut in half, drawn by tiles
with the kernels for GPUs. A pass takes the longest of what its bytes, its instructions and its longest chain of loads
take, and a gap; the guide's chapter on GPUs says what that leaves out. The folder of -o gets model.md and model.csv.")]
pub(super) struct Model {
    /// Draw the frames on this device too, and compare what each stage takes
    #[arg(long)]
    measure: bool,
    /// Only scenes of at most so many Gaussians
    #[arg(long, value_name = "N")]
    most: Option<usize>,
    /// Frames of which the median of each stage counts
    #[arg(long, value_name = "N", default_value_t = 15, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    repeat: u32,
    /// Folder for the tables; made unless it is there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print everything as JSON to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Everything that was predicted and measured.
#[derive(Debug, Serialize)]
struct Report {
    gpus: &'static [Gpu],
    device: Option<Device>,
    frames: Vec<Frame>,
}

/// What was measured on.
#[derive(Debug, Serialize)]
struct Device {
    name: String,
    driver: String,
    /// The kind of device that its kernels are for.
    shape: DeviceShape,
    /// The GPU of the model that it is.
    gpu: Option<&'static str>,
}

/// A frame.
#[derive(Debug, Serialize)]
struct Frame {
    name: String,
    gaussians: usize,
    is_cut: bool,
    /// In the order of `gpus`.
    predicted: Vec<Vec<PassPrediction>>,
    /// By each way of drawing that the device has.
    measured: Vec<Measured>,
}

/// The stages of a frame that was drawn, and all of it, ms.
#[derive(Debug, Serialize)]
struct Measured {
    raster: &'static str,
    stages: Vec<(&'static str, f64)>,
    ms: f64,
}

impl Model {
    pub(super) fn run(self) -> Result<(), Failure> {
        if let Some(folder) = &self.output {
            output::make_folder(folder)?;
        }
        let most = self.most.unwrap_or(usize::MAX);
        let mut counted = gpu_model::frames();
        counted.retain(|frame| frame.gaussians <= most);
        if counted.is_empty() {
            let message = format!(
                "no scene of the model has at most {}",
                output::counted(most as u64, "Gaussian")
            );
            return Err(Failure::Usage(message));
        }
        let mut report = Report {
            gpus: &GPUS,
            device: None,
            frames: counted.iter().map(predicted).collect(),
        };
        if self.measure {
            self.measure(&mut report)?;
        }
        if let Some(folder) = &self.output {
            tables::write(folder, &report)?;
        }
        if self.json {
            output::json(&report)?;
        } else {
            output::answer(&tables::markdown(&report))?;
        }
        Ok(())
    }

    /// Draws the frames, each in every way that the device has.
    fn measure(&self, report: &mut Report) -> Result<(), Failure> {
        let mut progress = Progress::new("measuring");
        let total = report
            .frames
            .chunk_by(|a, b| a.gaussians == b.gaussians)
            .count() as u64;
        let mut session: Option<Session> = None;
        let scenes = report
            .frames
            .chunk_by_mut(|a, b| a.gaussians == b.gaussians);
        for (done, frames) in (0..).zip(scenes) {
            progress.update(done, total);
            let gaussians = gpu_model::scene(frames[0].gaussians);
            let camera = gpu_model::camera(&gaussians)?;
            let scene = Scene::from(&gaussians);
            if let Some(session) = &mut session {
                session.reload(&scene, ShFormat::Packed)?;
            }
            let session = match &mut session {
                Some(session) => session,
                none => none.insert(Session::open(
                    &self.device.meant(),
                    &scene,
                    ShFormat::Packed,
                )?),
            };
            for frame in frames {
                let clip = gpu_model::clip(frame.is_cut)?;
                frame.measured = self.ways(session, &camera, &clip)?;
            }
        }
        drop(progress);
        if let Some(session) = session {
            let (name, driver, _) = session.about();
            report.device = Some(Device {
                gpu: gpu_model::named(&name).map(|gpu| gpu.name),
                name,
                driver,
                shape: session.shape().0,
            });
            session.close()?;
        }
        Ok(())
    }

    fn ways(
        &self,
        session: &mut Session,
        camera: &Camera,
        clip: &Clip,
    ) -> Result<Vec<Measured>, Failure> {
        let mut ways = Vec::new();
        for (raster, name) in RASTERS {
            let settings = Settings::default().mode(Mode::Exact).raster(raster);
            // The first frame makes pipelines and finds how many pairs there are.
            let drawn = session
                .frame(camera, clip, &settings, 1)
                .and_then(|_| session.frame(camera, clip, &settings, self.repeat));
            match drawn {
                Ok(stats) => ways.push(measured(name, &stats.stats)),
                // A device may have no mesh shaders.
                Err(Error::Device(_)) if raster == Raster::Mesh => {}
                Err(error) => return Err(error.into()),
            }
        }
        Ok(ways)
    }
}

/// The ways of drawing, of which the model predicts the first.
const RASTERS: [(Raster, &str); 3] = [
    (Raster::Tiles, "tiles"),
    (Raster::Mesh, "mesh"),
    (Raster::Quad, "quad"),
];

fn predicted(counted: &ModelFrame) -> Frame {
    let of = |gpu: &Gpu| gpu_model::predict(gpu, counted);
    Frame {
        name: counted.name(),
        gaussians: counted.gaussians,
        is_cut: counted.is_cut,
        predicted: GPUS.iter().map(of).collect(),
        measured: Vec::new(),
    }
}

fn measured(raster: &'static str, stats: &FrameStats) -> Measured {
    let stages = stats.passes.iter();
    Measured {
        raster,
        stages: stages.map(|pass| (pass.name, pass.ms)).collect(),
        ms: stats.gpu_ms.unwrap_or_default(),
    }
}
