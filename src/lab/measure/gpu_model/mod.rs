//! The time that a GPU would need for each compute pass of a frame, predicted from what is known without one. The guide's
//! chapter on GPUs says how far to trust it.
//!
//! A pass takes the longest of three times, and a gap until the next one: its bytes at the memory's bandwidth, its
//! instructions at the rate of all lanes, and the longest chain of what one invocation waits for.

mod costs;
mod counted;
mod numbers;
mod tables;

pub use costs::{COSTS, Cost};
pub use counted::{
    FRAMES_FILE, ModelFrame, PIPELINES_FILE, PipelineEstimate, SIZE, camera, clip, frames, parse,
    pipelines, scene, text,
};
pub use numbers::FrameNumbers;
pub use tables::{rows, tables};

#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Gpu {
    /// The name, which the name of its device contains.
    pub name: &'static str,
    /// Bandwidth of its memory by the data sheet, GB a second.
    pub bandwidth: f64,
    /// FP32 lanes by the data sheet; those that AMD counts twice, since they may issue two instructions at once, count once.
    pub lanes: f64,
    /// Boost clock by the data sheet, GHz.
    pub clock: f64,
    /// Latency of a load that waits for another one, ns. No data sheet has it; these are of the order of what is published
    /// of chains of pointers through memory.
    pub latency: f64,
}

pub const GPUS: [Gpu; 4] = [
    Gpu {
        name: "RTX 4090",
        bandwidth: 1008.0,
        lanes: 16384.0,
        clock: 2.52,
        latency: 550.0,
    },
    Gpu {
        name: "RX 7900 XTX",
        bandwidth: 960.0,
        lanes: 6144.0,
        clock: 2.5,
        latency: 500.0,
    },
    Gpu {
        name: "Arc A770",
        bandwidth: 560.0,
        lanes: 4096.0,
        clock: 2.1,
        latency: 800.0,
    },
    Gpu {
        name: "H200",
        bandwidth: 4800.0,
        lanes: 16896.0,
        clock: 1.98,
        latency: 650.0,
    },
];

/// The share of a data sheet's bandwidth that passes are taken to reach.
pub const REACHED_BANDWIDTH: f64 = 0.85;

/// Time between the end of a pass and the beginning of the next one, which waits for it, us. An assumption, the same for all
/// GPUs.
pub const GAP: f64 = 3.0;

const LANES_OF_ESTIMATE: f64 = 32.0;
const INVOCATIONS_OF_ESTIMATE: f64 = 64.0;

/// The predicted times of all dispatches of a pass in a frame, ms.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PassPrediction {
    pub stage: &'static str,
    pub pass: &'static str,
    pub dispatches: u32,
    pub bytes: u64,
    pub invocations: u64,
    pub memory: f64,
    pub instructions: f64,
    /// What its longest chain takes.
    pub chain: f64,
    /// The longest of the three for each dispatch, and the gaps.
    pub ms: f64,
}

impl PassPrediction {
    pub fn bound_by(&self) -> &'static str {
        let gap = f64::from(self.dispatches) * GAP / 1e3;
        let parts = [
            ("memory", self.memory),
            ("instructions", self.instructions),
            ("chain", self.chain),
            ("gap", gap),
        ];
        let longest = parts.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
        longest.map_or("", |(name, _)| name)
    }
}

/// The GPU of which a device's name says that it is one.
pub fn named(device: &str) -> Option<&'static Gpu> {
    GPUS.iter().find(|gpu| device.contains(gpu.name))
}

/// The passes of a frame on a GPU, in the order in which they first occur in each stage.
///
/// # Panics
/// If the frame has a pass without cost or pipeline, which a test excludes for those of [`frames`].
pub fn predict(gpu: &Gpu, frame: &ModelFrame) -> Vec<PassPrediction> {
    let pipelines = pipelines();
    let mut all: Vec<PassPrediction> = Vec::new();
    let mut stage = "";
    for name in &frame.dispatches {
        let cost = COSTS.iter().find(|cost| cost.name == *name);
        let cost = cost.unwrap_or_else(|| panic!("{name} has no cost"));
        let pipeline = pipelines
            .iter()
            .find(|pipeline| pipeline.pass == *name && pipeline.is_cut == frame.is_cut);
        let pipeline = pipeline.unwrap_or_else(|| panic!("{name} has no pipeline"));
        stage = stage_of(cost.name, stage);
        let once = dispatch(gpu, cost, pipeline, &frame.numbers, stage);
        match all
            .iter_mut()
            .find(|p| (p.stage, p.pass) == (once.stage, once.pass))
        {
            Some(sum) => sum.add(&once),
            None => all.push(once),
        }
    }
    all
}

/// The predicted times of passes, ms, of which those of one name are added up.
pub(crate) fn sums(
    passes: &[PassPrediction],
    name: impl Fn(&PassPrediction) -> &'static str,
) -> Vec<(&'static str, f64)> {
    let mut sums: Vec<(&str, f64)> = Vec::new();
    for pass in passes {
        match sums.iter_mut().find(|(known, _)| *known == name(pass)) {
            Some((_, ms)) => *ms += pass.ms,
            None => sums.push((name(pass), pass.ms)),
        }
    }
    sums
}

impl PassPrediction {
    fn add(&mut self, other: &Self) {
        self.dispatches += other.dispatches;
        self.bytes += other.bytes;
        self.invocations += other.invocations;
        self.memory += other.memory;
        self.instructions += other.instructions;
        self.chain += other.chain;
        self.ms += other.ms;
    }
}

fn dispatch(
    gpu: &Gpu,
    cost: &Cost,
    pipeline: &PipelineEstimate,
    numbers: &FrameNumbers,
    stage: &'static str,
) -> PassPrediction {
    let invocations = (cost.invocations)(numbers);
    let bytes = (cost.bytes)(numbers);
    let turns = (cost.turns)(numbers);
    let memory = bytes as f64 / (gpu.bandwidth * 1e9 * REACHED_BANDWIDTH) * 1e3;
    let cycles = invocations as f64 / INVOCATIONS_OF_ESTIMATE * pipeline.cycles as f64 * turns;
    let instructions = cycles / (gpu.lanes / LANES_OF_ESTIMATE) / (gpu.clock * 1e9) * 1e3;
    let loads = (cost.loads)(numbers) as f64 * gpu.latency / 1e6;
    let alone = pipeline.latency as f64 * turns / (gpu.clock * 1e9) * 1e3;
    let chain = loads.max(alone);
    PassPrediction {
        stage,
        pass: cost.name,
        dispatches: 1,
        bytes,
        invocations,
        memory,
        instructions,
        chain,
        ms: memory.max(instructions).max(chain) + GAP / 1e3,
    }
}

/// The stage of a pass, whose timer counts it. A list of blocks belongs to the stage that makes it, which is that of the pass
/// before.
fn stage_of(pass: &'static str, before: &'static str) -> &'static str {
    match pass {
        "block_list" => before,
        "clip_blocks" => "clip",
        "several_tiles" => "tiles",
        "compact_scan" => "compact",
        pass if pass.starts_with("radix_") => "sort",
        pass if ["pair_", "macro_", "batch_", "row_"]
            .iter()
            .any(|of| pass.starts_with(of)) =>
        {
            "bin"
        }
        pass => pass,
    }
}

#[cfg(test)]
mod tests;
