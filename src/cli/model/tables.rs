//! The predictions and measurements as Markdown and CSV.

use std::fmt::Write as _;
use std::path::Path;

use rara::Result;
use rara::gpu::DeviceShape;
use rara_lab::measure::gpu_model::{GAP, Gpu, PassPrediction, REACHED_BANDWIDTH, SIZE};

use super::{Device, Frame, Report, output};

/// Writes both into a folder.
pub(super) fn write(folder: &Path, report: &Report) -> Result<()> {
    output::text(&folder.join("model.md"), &markdown(report))?;
    output::text(&folder.join("model.csv"), &csv(report))
}

/// The tables for people.
pub(super) fn markdown(report: &Report) -> String {
    let mut text = format!(
        "# Predicted ms of each pass\n\nThese are predictions, not measurements: generated scenes at {}x{}, drawn by tiles \
         with the kernels for GPUs, packed spherical harmonics of degree 3. Behind each time stands what the pass waits for: \
         memory, instructions, its longest chain, or the gap between passes ({GAP} us each). Memory is taken to reach \
         {REACHED_BANDWIDTH} of its bandwidth.\n\n",
        SIZE.0, SIZE.1
    );
    text += "| GPU | GB/s | FP32 lanes | GHz | ns a dependent load |\n|---|---:|---:|---:|---:|\n";
    for gpu in report.gpus {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} |",
            gpu.name, gpu.bandwidth, gpu.lanes, gpu.clock, gpu.latency
        );
    }
    for frame in &report.frames {
        predicted(&mut text, frame, report.gpus);
    }
    if let Some(device) = &report.device {
        let _ = writeln!(
            text,
            "\n# Measured ms of each stage\n\n{} ({}), with the kernels for {}.",
            device.name,
            device.driver,
            match device.shape {
                DeviceShape::Cpu => "CPU drivers",
                _ => "GPUs",
            }
        );
        for frame in &report.frames {
            measured(&mut text, frame, device, report.gpus);
        }
    }
    text
}

fn predicted(text: &mut String, frame: &Frame, gpus: &[Gpu]) {
    let names: Vec<_> = gpus.iter().map(|gpu| gpu.name).collect();
    let _ = writeln!(
        text,
        "\n## Predicted: {}\n\n| stage | pass | times | MB | {} |\n|---|---|---:|---:|{}",
        frame.name,
        names.join(" | "),
        "---:|".repeat(gpus.len())
    );
    for (row, pass) in frame.predicted[0].iter().enumerate() {
        let cell = |of_gpu: &Vec<PassPrediction>| {
            let pass = &of_gpu[row];
            format!("{:.3} {}", pass.ms, pass.bound_by())
        };
        let cells: Vec<_> = frame.predicted.iter().map(cell).collect();
        let _ = writeln!(
            text,
            "| {} | {} | {} | {:.1} | {} |",
            pass.stage,
            pass.pass,
            pass.dispatches,
            pass.bytes as f64 / 1e6,
            cells.join(" | ")
        );
    }
    let dispatches: u32 = frame.predicted[0].iter().map(|pass| pass.dispatches).sum();
    let bytes: u64 = frame.predicted[0].iter().map(|pass| pass.bytes).sum();
    let totals = frame.predicted.iter().map(|passes| total(passes));
    let totals: Vec<_> = totals.map(|ms| format!("**{ms:.2}**")).collect();
    let _ = writeln!(
        text,
        "| **all** | | {dispatches} | {:.1} | {} |",
        bytes as f64 / 1e6,
        totals.join(" | ")
    );
}

fn total(passes: &[PassPrediction]) -> f64 {
    passes.iter().map(|pass| pass.ms).sum()
}

/// The predicted time of a stage, where it has passes that are predicted.
fn of_stage(passes: &[PassPrediction], stage: &str) -> Option<f64> {
    let of_stage = passes.iter().filter(|pass| pass.stage == stage);
    of_stage.map(|pass| pass.ms).reduce(|sum, ms| sum + ms)
}

fn measured(text: &mut String, frame: &Frame, device: &Device, gpus: &[Gpu]) {
    let Some(tiles) = frame.measured.first() else {
        return;
    };
    // Where the device is none of the model's GPUs, all of their predictions stand beside it.
    let is_compared = |gpu: &Gpu| device.gpu.is_none_or(|name| name == gpu.name);
    let compared: Vec<_> = (gpus.iter().zip(&frame.predicted))
        .filter(|(gpu, _)| is_compared(gpu))
        .collect();
    let names = compared
        .iter()
        .map(|(gpu, _)| format!(" predicted, {} |", gpu.name));
    let ways = frame
        .measured
        .iter()
        .map(|way| format!(" {} |", way.raster));
    let _ = writeln!(
        text,
        "\n## Measured: {}\n\n| stage |{}{}\n|---|{}",
        frame.name,
        ways.collect::<String>(),
        names.collect::<String>(),
        "---:|".repeat(frame.measured.len() + compared.len())
    );
    let mut stages: Vec<&str> = tiles.stages.iter().map(|(stage, _)| *stage).collect();
    let others = frame.measured.iter().flat_map(|way| &way.stages);
    for (stage, _) in others {
        if !stages.contains(stage) {
            stages.push(stage);
        }
    }
    let cell = |ms: Option<f64>| ms.map_or(" |".into(), |ms| format!(" {ms:.3} |"));
    for stage in stages {
        let ways = frame.measured.iter().map(|way| {
            let found = way.stages.iter().find(|(name, _)| *name == stage);
            cell(found.map(|(_, ms)| *ms))
        });
        let predicted = compared
            .iter()
            .map(|(_, passes)| cell(of_stage(passes, stage)));
        let cells: String = ways.chain(predicted).collect();
        let _ = writeln!(text, "| {stage} |{cells}");
    }
    let ways = frame.measured.iter().map(|way| cell(Some(way.ms)));
    let predicted = compared.iter().map(|(_, passes)| cell(Some(total(passes))));
    let _ = writeln!(
        text,
        "| **all** |{}",
        ways.chain(predicted).collect::<String>()
    );
}

/// A line for each number: what it is of, and whether it is predicted or measured.
fn csv(report: &Report) -> String {
    let mut text = String::from("source,device,gaussians,cut,raster,stage,pass,bound_by,ms\n");
    for frame in &report.frames {
        let (gaussians, is_cut) = (frame.gaussians, frame.is_cut);
        for (gpu, passes) in report.gpus.iter().zip(&frame.predicted) {
            for pass in passes {
                let _ = writeln!(
                    text,
                    "predicted,\"{}\",{gaussians},{is_cut},tiles,{},{},{},{:.6}",
                    gpu.name,
                    pass.stage,
                    pass.pass,
                    pass.bound_by(),
                    pass.ms
                );
            }
        }
        let device = report.device.as_ref().map_or("", |device| &device.name);
        for way in &frame.measured {
            for (stage, ms) in &way.stages {
                let _ = writeln!(
                    text,
                    "measured,\"{device}\",{gaussians},{is_cut},{},{stage},,,{ms:.6}",
                    way.raster
                );
            }
        }
    }
    text
}
