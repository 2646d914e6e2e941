//! The counts that the model works with: the numbers and dispatches of frames, and the compiler's estimates of their pipelines. The
//! files are written by `tests/gpu_cost/model.rs`.

use glam::DVec3;

use rara::scene::{Bounds, Kind, generate};
use rara::{Camera, Clip, ClipOp, Gaussians, Plane, Result};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::numbers::FrameNumbers;

/// The file of the frames, from the repository's root.
pub const FRAMES_FILE: &str = "src/lab/measure/gpu_model/frames.json";
/// The file of the pipelines, from the repository's root.
pub const PIPELINES_FILE: &str = "src/lab/measure/gpu_model/pipelines.json";

pub const SIZE: (u32, u32) = (1920, 1080);

/// A frame of a generated scene, drawn by tiles, as it was counted.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ModelFrame {
    pub gaussians: usize,
    /// True when a plane cuts it exactly in half.
    pub is_cut: bool,
    pub numbers: FrameNumbers,
    /// The passes that it dispatches, in order, those without a workgroup left out.
    pub dispatches: Vec<String>,
}

impl ModelFrame {
    pub fn name(&self) -> String {
        let millions = self.gaussians as f64 / 1e6;
        format!("{millions} M Gaussians, {}", how(self.is_cut))
    }
}

fn how(is_cut: bool) -> &'static str {
    if is_cut { "cut" } else { "whole" }
}

pub fn scene(gaussians: usize) -> Gaussians {
    generate(Kind::General, gaussians, 1)
}

/// What frames its scene, as the command line's default does.
pub fn camera(scene: &Gaussians) -> Result<Camera> {
    Camera::frame(&Bounds::of(scene), -DVec3::Y, 50.0, SIZE)
}

pub fn clip(is_cut: bool) -> Result<Clip> {
    Ok(match is_cut {
        true => Clip::of([Plane::new(DVec3::X, 0.0)?], ClipOp::And),
        false => Clip::default(),
    })
}

/// The estimates of RADV's compiler, for 64 invocations on a SIMD of 32 lanes of a Navi 31.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PipelineEstimate {
    pub pass: String,
    /// True of the pipeline in frames that are cut.
    pub is_cut: bool,
    /// Cycles from its beginning to its end.
    pub latency: u64,
    /// Cycles for which it keeps the SIMD busy, beside others.
    pub cycles: u64,
}

pub fn frames() -> Vec<ModelFrame> {
    parse(include_str!("frames.json"))
}

pub fn pipelines() -> Vec<PipelineEstimate> {
    parse(include_str!("pipelines.json"))
}

pub fn parse<T: DeserializeOwned>(text: &str) -> Vec<T> {
    serde_json::from_str(text).expect("what the test has written")
}

pub fn text(all: &[impl Serialize]) -> String {
    serde_json::to_string_pretty(all).expect("numbers and names") + "\n"
}
