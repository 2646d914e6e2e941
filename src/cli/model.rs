//! `rara model`: what GPUs are predicted to take for each pass of a frame.

use std::path::PathBuf;

use clap::Args;
use rara_lab::measure::gpu_model::{self, GPUS, Gpu, ModelFrame, PassPrediction};
use rara_lab::table::Table;
use serde::Serialize;

use super::failure::Failure;
use super::output;

/// Predict what a few GPUs take for each pass of a frame
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  rara model
  rara measure model -o measured          # draws the same frames, and compares each stage

The frames are those of generated scenes of 1 M and 5 M Gaussians at 1920x1080, whole and cut in half, drawn by tiles
with the pipelines for GPUs. A pass takes the longest of what its bytes, its instructions and its longest chain of loads
take, and a gap; the guide's chapter on GPUs says what that leaves out. The folder of -o gets model.md and model.csv.")]
pub(super) struct Model {
    /// Only scenes of at most so many Gaussians
    #[arg(long, value_name = "N")]
    most: Option<usize>,
    /// Folder for the tables; made unless it is there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print everything as JSON to stdout
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Serialize)]
struct ModelReport {
    gpus: &'static [Gpu],
    frames: Vec<PredictedFrame>,
}

#[derive(Debug, Serialize)]
struct PredictedFrame {
    name: String,
    gaussians: usize,
    is_cut: bool,
    /// The passes on each GPU, in the order of `gpus`.
    predicted: [Vec<PassPrediction>; GPUS.len()],
}

impl Model {
    pub(super) fn run(self) -> Result<(), Failure> {
        let most = self.most.unwrap_or(usize::MAX);
        let mut frames = gpu_model::frames();
        frames.retain(|frame| frame.gaussians <= most);
        if frames.is_empty() {
            let message = format!(
                "no scene of the model has at most {}",
                output::counted(most as u64, "Gaussian")
            );
            return Err(Failure::Usage(message));
        }
        let tables = gpu_model::tables(&frames);
        let text = tables.iter().map(Table::markdown).collect::<Vec<_>>();
        let text = text.join("\n");
        if let Some(folder) = &self.output {
            output::make_folder(folder)?;
            output::text(&folder.join("model.md"), &text)?;
            output::text(&folder.join("model.csv"), &gpu_model::rows(&frames).csv())?;
        }
        match self.json {
            true => output::json(&ModelReport {
                gpus: &GPUS,
                frames: frames.iter().map(PredictedFrame::new).collect(),
            })?,
            false => output::answer(&text)?,
        }
        Ok(())
    }
}

impl PredictedFrame {
    fn new(frame: &ModelFrame) -> Self {
        Self {
            name: frame.name(),
            gaussians: frame.gaussians,
            is_cut: frame.is_cut,
            predicted: GPUS.map(|gpu| gpu_model::predict(&gpu, frame)),
        }
    }
}
