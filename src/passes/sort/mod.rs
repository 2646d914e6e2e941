//! Stage `sort`: a stable sort of the splats by linear view depth, ties by their number in the scene.
//!
//! It is given as many keys as there are splats, in `depth_keys`. `order` holds nothing yet:
//! the splats are numbered like their keys, from 0. It leaves the sorted keys and their splats in the pair of `keys`
//! and `order` that [`EyePlan::sorted`] names, on which all later stages rely, and the others to the stages that follow
//! ([`spare`]). The plan says which pipelines do it: each set has a file here, and shaders of its own.

mod keys;
mod radix;
mod runs;

use crate::passes::eye_plan::EyePlan;
use crate::passes::recording::Recording;
use crate::passes::stage::Stage;
use rara_gpu::DeviceShape;

pub(super) use keys::{order, spare};

pub(crate) static STAGE: Stage<EyePlan> =
    Stage::when_finding_view("sort", &[keys::STORAGES], record);

fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    match recording.plan.cut.shape {
        DeviceShape::Cpu => runs::record(recording),
        DeviceShape::Gpu { .. } => radix::record(recording),
    }
}
