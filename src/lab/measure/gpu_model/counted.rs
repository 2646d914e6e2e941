//! What was counted for the model: the numbers and dispatches of frames, and the compiler's estimates of their kernels. The
//! files are written by `tests/gpu_cost/model.rs`.

use glam::DVec3;

use rara::scene::{Bounds, Kind, generate};
use rara::{Camera, Clip, ClipOp, Gaussians, Plane, Result};

use super::numbers::FrameNumbers;

/// The file of the frames, from the repository's root.
pub const FRAMES_FILE: &str = "src/lab/measure/gpu_model/frames.txt";
/// The file of the kernels, from the repository's root.
pub const KERNELS_FILE: &str = "src/lab/measure/gpu_model/kernels.txt";

pub const SIZE: (u32, u32) = (1920, 1080);

/// A frame of a generated scene, drawn by tiles, as it was counted.
#[derive(Debug, Clone, PartialEq, Eq)]
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

    /// The lines of the file that are about it.
    pub fn text(&self) -> String {
        let mut numbers = self.numbers;
        let numbers = numbers.named();
        let numbers: Vec<_> = numbers
            .map(|(name, value)| format!("{name}={value}"))
            .collect();
        format!(
            "frame {} {}\nnumbers {}\ndispatches {}\n",
            self.gaussians,
            how(self.is_cut),
            numbers.join(" "),
            self.dispatches.join(" ")
        )
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

/// What cuts it.
pub fn clip(is_cut: bool) -> Result<Clip> {
    Ok(match is_cut {
        true => Clip::of([Plane::new(DVec3::X, 0.0)?], ClipOp::And),
        false => Clip::default(),
    })
}

/// The estimates of RADV's compiler, for 64 invocations on a SIMD of 32 lanes of a Navi 31.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Kernel {
    pub pass: String,
    /// True of the kernel in frames that are cut.
    pub is_cut: bool,
    /// Cycles from its beginning to its end.
    pub latency: u64,
    /// Cycles for which it keeps the SIMD busy, beside others.
    pub cycles: u64,
}

impl Kernel {
    pub fn text(&self) -> String {
        let frame = how(self.is_cut);
        format!("{frame} {} {} {}\n", self.pass, self.latency, self.cycles)
    }
}

/// The frames that were counted.
pub fn frames() -> Vec<ModelFrame> {
    let mut all: Vec<ModelFrame> = Vec::new();
    for line in lines(include_str!("frames.txt")) {
        let (what, rest) = line.split_once(' ').expect("a word and more");
        if what == "frame" {
            let (gaussians, how) = rest.split_once(' ').expect(line);
            all.push(ModelFrame {
                gaussians: gaussians.parse().expect(line),
                is_cut: how == "cut",
                numbers: FrameNumbers::default(),
                dispatches: Vec::new(),
            });
            continue;
        }
        let frame = all.last_mut().expect("a frame comes first");
        match what {
            "numbers" => rest.split(' ').for_each(|field| {
                let (name, value) = field.split_once('=').expect("a name and a number");
                let mut named = frame.numbers.named();
                let (_, place) = named.find(|(known, _)| *known == name).expect(name);
                *place = value.parse().expect(field);
            }),
            "dispatches" => frame.dispatches = rest.split(' ').map(Into::into).collect(),
            _ => panic!("frames.txt: what is this line? {line}"),
        }
    }
    all
}

/// The kernels of these frames.
pub fn kernels() -> Vec<Kernel> {
    lines(include_str!("kernels.txt")).map(kernel).collect()
}

fn kernel(line: &str) -> Kernel {
    let words: Vec<&str> = line.split(' ').collect();
    let [frame, pass, latency, cycles] = words[..] else {
        panic!("kernels.txt: what is this line? {line}")
    };
    Kernel {
        pass: pass.into(),
        is_cut: frame == "cut",
        latency: latency.parse().expect(line),
        cycles: cycles.parse().expect(line),
    }
}

fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
}
