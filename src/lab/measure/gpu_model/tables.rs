//! The predictions as tables.

use super::{GAP, GPUS, ModelFrame, PassPrediction, REACHED_BANDWIDTH, SIZE, predict};
use crate::table::{Cell, Table};

/// The GPUs and, for each frame, what its passes are predicted to take on them.
pub fn tables(frames: &[ModelFrame]) -> Vec<Table> {
    let note = format!(
        "These are predictions, not measurements: generated scenes at {}x{}, drawn by tiles with the pipelines for GPUs, packed \
         spherical harmonics of degree 3. Behind each time stands what the pass waits for: memory, instructions, its longest \
         chain, or the gap between passes ({GAP} us each). Memory is taken to reach {REACHED_BANDWIDTH} of its bandwidth.",
        SIZE.0, SIZE.1
    );
    let columns = ["GPU", "GB/s", "FP32 lanes", "GHz", "ns a dependent load"];
    let mut gpus = Table::new("Predicted ms of each pass", note, columns);
    for gpu in &GPUS {
        let numbers = [gpu.bandwidth, gpu.lanes, gpu.clock, gpu.latency];
        gpus.row([gpu.name.into()].into_iter().chain(numbers.map(Cell::from)));
    }
    let frames = frames.iter().map(frame);
    [gpus].into_iter().chain(frames).collect()
}

fn frame(frame: &ModelFrame) -> Table {
    let columns = ["stage", "pass", "times", "MB"].into_iter();
    let columns = columns.chain(GPUS.iter().map(|gpu| gpu.name));
    let mut table = Table::new(format!("Predicted: {}", frame.name()), "", columns);
    let all = GPUS.map(|gpu| predict(&gpu, frame));
    let megabytes = |bytes: u64| Cell::Fixed(bytes as f64 / 1e6, 1);
    for (row, pass) in all[0].iter().enumerate() {
        let first = [pass.stage.into(), pass.pass.into(), pass.dispatches.into()];
        let time = |pass: &PassPrediction| format!("{:.3} {}", pass.ms, pass.bound_by()).into();
        let times = all.iter().map(|passes| time(&passes[row]));
        table.row(
            first
                .into_iter()
                .chain([megabytes(pass.bytes)])
                .chain(times),
        );
    }
    let dispatches: u32 = all[0].iter().map(|pass| pass.dispatches).sum();
    let bytes = megabytes(all[0].iter().map(|pass| pass.bytes).sum());
    let total = |passes: &Vec<PassPrediction>| -> f64 { passes.iter().map(|pass| pass.ms).sum() };
    let totals = all
        .iter()
        .map(|passes| format!("{:.2}", total(passes)).into());
    table.row(
        ["all".into(), "".into(), dispatches.into(), bytes]
            .into_iter()
            .chain(totals),
    );
    table
}

pub fn rows(frames: &[ModelFrame]) -> Table {
    let columns = ["gpu", "gaussians", "cut", "stage", "pass", "bound by", "ms"];
    let mut table = Table::new("", "", columns);
    for frame in frames {
        for gpu in &GPUS {
            for pass in predict(gpu, frame) {
                table.row([
                    gpu.name.into(),
                    Cell::Count(frame.gaussians as u64),
                    frame.is_cut.to_string().into(),
                    pass.stage.into(),
                    pass.pass.into(),
                    pass.bound_by().into(),
                    pass.ms.into(),
                ]);
            }
        }
    }
    table
}
