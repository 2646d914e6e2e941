//! The regions that the clip keeps, as the shaders read them: what all layers' regions have in common, and the surfaces of
//! one.

use glam::{DMat3, DVec3};

use crate::passes::meshes::Meshes;
use crate::types::{self, RegionData};
use rara_base::error::Result;
use rara_base::limits;
use rara_gpu::DeviceShape;
use rara_scene::clip::postfix::postfix;
use rara_scene::clip::{Clip, ClipOp, Inside, Plane, Quadric, Surface};
use rara_scene::settings::{Mode, Settings};

/// The largest distance of a surface that is not taken for infinity, in the layer's units. It lies beyond every splat: a power of two
/// below the end of single precision's range.
const FARTHEST: f64 = (1_u128 << 126) as f64;

/// The surfaces of a region from which blocks have shortlists.
pub(crate) fn shortlist_from(shape: DeviceShape) -> u32 {
    match shape {
        DeviceShape::Cpu => limits::SHORTLIST_FROM_ON_CPU,
        DeviceShape::Gpu { .. } => limits::SHORTLIST_FROM,
    }
}

/// The values that are common to all regions that these clips make in the mode of the settings. Without anything to clip
/// with, they are the same as in mode `none`.
pub(super) fn region_data<'a>(
    clips: impl Iterator<Item = &'a Clip>,
    settings: &Settings,
) -> Result<RegionData> {
    let mut clipped = false;
    for clip in clips {
        clip.check()?;
        clipped |= !clip.is_everything();
    }
    let mut region: RegionData = bytemuck::Zeroable::zeroed();
    region.mode = match settings.mode {
        _ if !clipped => types::MODE_NONE,
        Mode::None => types::MODE_NONE,
        Mode::Hard => types::MODE_HARD,
        Mode::Rara => types::MODE_RARA,
        Mode::Exact => types::MODE_EXACT,
    };
    if region.mode != types::MODE_NONE {
        region.trace_all = settings.trace_all.into();
    }
    if region.mode == types::MODE_RARA {
        region.sigma = settings.sigma;
    }
    Ok(region)
}

/// How the surfaces of a clip combine, `OP_*`. A clip without any keeps everything, as an intersection of none does.
pub(super) fn op(clip: &Clip) -> u32 {
    match clip.op {
        _ if !clip.is_flat() => types::OP_PARTS,
        ClipOp::Or if !clip.surfaces.is_empty() => types::OP_OR,
        ClipOp::And | ClipOp::Or => types::OP_AND,
    }
}

/// The surfaces of a clip, which is given in the space of the layer that it cuts, whose centres lie between two corners.
/// There are no repetitions, since cutting twice is cutting once, and the order is their own, so that no bit of a picture
/// depends on the order in which they are given.
pub(super) fn surfaces(
    clip: &Clip,
    corners: [DVec3; 2],
    meshes: &mut Meshes,
) -> Vec<types::SurfaceData> {
    let steps = postfix(clip);
    steps
        .iter()
        .map(|step| packed(&step.surface, &step.operators, corners, meshes))
        .collect()
}

fn packed(
    surface: &Surface,
    operators: &[ClipOp],
    corners: [DVec3; 2],
    meshes: &mut Meshes,
) -> types::SurfaceData {
    let mut data = match surface {
        Surface::Plane(plane) => plane_data(plane),
        Surface::Quadric(quadric) => quadric_data(quadric, corners),
        Surface::Inside(inside) => mesh_data(inside, meshes.place(inside.mesh()) as u32),
    };
    data.operators = operators.len() as u32;
    for (place, op) in operators.iter().enumerate() {
        data.operators |= u32::from(*op == ClipOp::Or) << (types::OPERATOR_SHIFT as usize + place);
    }
    data
}

fn plane_data(plane: &Plane) -> types::SurfaceData {
    let [high, low] = halves(plane.normal().extend(plane.offset()).to_array());
    types::SurfaceData {
        high,
        low,
        kind: types::SURFACE_PLANE,
        ..bytemuck::Zeroable::zeroed()
    }
}

/// The quadric about a point near the splats that it can cut: its own centre where that lies among them, else the nearest
/// point of the box around their centres. There its terms are of the size of the distances that count.
fn quadric_data(quadric: &Quadric, [low, high]: [DVec3; 2]) -> types::SurfaceData {
    let anchor = match low.cmple(high).all() {
        true => quadric.anchor().clamp(low, high),
        false => quadric.anchor(),
    };
    let near = quadric.anchored(anchor);
    let [high, low] = halves(near.linear().extend(near.constant()).to_array());
    let [anchor, anchor_low] = halves(anchor.extend(0.0).to_array());
    let [x, y, z] = near.matrix().to_cols_array_2d();
    let [diagonal, _] = halves([x[0], y[1], z[2], 0.0]);
    let [across, _] = halves([x[1], x[2], y[2], 0.0]);
    types::SurfaceData {
        high,
        low,
        anchor,
        anchor_low,
        diagonal,
        across,
        kind: types::SURFACE_QUADRIC,
        ..bytemuck::Zeroable::zeroed()
    }
}

/// The inside of a mesh, or its outside: the map to its own space, whose middle is where it is zero.
fn mesh_data(inside: &Inside, first: u32) -> types::SurfaceData {
    let (mesh, placement) = (inside.mesh(), inside.placement());
    let middle = placement.to_world(mesh.centre());
    let turn = DMat3::from_quat(placement.rotation()).transpose();
    let rows = turn * (1.0 / (placement.scale() * mesh.scale()));
    let [high, low] = halves(middle.extend(0.0).to_array());
    let row = |at: usize| rows.row(at).extend(0.0).as_vec4().to_array();
    let hash = mesh.content_hash();
    types::SurfaceData {
        high,
        low,
        anchor: row(0),
        anchor_low: row(1),
        diagonal: row(2),
        // The hash is there so that two that differ are told apart.
        across: [hash as u32, (hash >> 32) as u32, 0, 0].map(f32::from_bits),
        kind: types::SURFACE_MESH,
        mesh: first,
        keeps_outside: inside.keeps_outside().into(),
        ..bytemuck::Zeroable::zeroed()
    }
}

/// Each number as two floats.
fn halves(values: [f64; 4]) -> [[f32; 4]; 2] {
    let values = values.map(|v| v.clamp(-FARTHEST, FARTHEST));
    let high = values.map(|v| v as f32);
    let low = std::array::from_fn(|i| (values[i] - f64::from(high[i])) as f32);
    [high, low]
}
