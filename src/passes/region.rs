//! What the clip keeps, as the shaders have it: what all layers' regions have in common, and the surfaces of one.

use crate::clip::{Clip, ClipOp, Plane};
use crate::error::{Error, Result};
use crate::limits;
use crate::passes::view::two_float;
use crate::settings::{Mode, Settings};
use crate::types::{self, RegionData, Surface};

/// Largest offset of a plane that is told from infinity, world units: a power of two below the end of single
/// precision's range.
const FARTHEST: f64 = (1_u128 << 126) as f64;

/// What all regions have in common that a clip in the mode of the settings makes. Without anything to clip with that is what
/// mode `none` has.
pub(super) fn region_data(clip: &Clip, settings: &Settings) -> Result<RegionData> {
    if clip.planes.len() > limits::MAX_CLIP_PLANES as usize {
        let (have, most) = (clip.planes.len(), limits::MAX_CLIP_PLANES);
        return Err(Error::Invalid(format!(
            "a clip of {have} half-spaces is beyond the {most} supported; use fewer"
        )));
    }
    let mut region: RegionData = bytemuck::Zeroable::zeroed();
    region.mode = match settings.mode {
        _ if clip.planes.is_empty() => types::MODE_NONE,
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

/// How the surfaces of a clip combine, `OP_*`.
pub(super) fn op(clip: &Clip) -> u32 {
    match clip.op {
        ClipOp::And => types::OP_AND,
        ClipOp::Or => types::OP_OR,
    }
}

/// The surfaces of a clip, which is given in the space of the layer that it cuts.
pub(super) fn surfaces(clip: &Clip) -> impl Iterator<Item = Surface> {
    distinct(&clip.planes).into_iter().map(|plane| {
        let (high, low) = two_float(plane.normal());
        // Farther away than single precision reaches: beyond every splat.
        let offset = plane.offset().clamp(-FARTHEST, FARTHEST);
        let offset_high = offset as f32;
        let offset_low = (offset - f64::from(offset_high)) as f32;
        Surface {
            high: [high[0], high[1], high[2], offset_high],
            low: [low[0], low[1], low[2], offset_low],
            kind: types::SURFACE_PLANE,
            pad: [0; 3],
        }
    })
}

/// The planes without repetitions, since cutting twice is cutting once, and in an order of their own: to the bit no
/// picture depends on the order in which planes are given.
fn distinct(planes: &[Plane]) -> Vec<Plane> {
    let key = |plane: &Plane| {
        let [x, y, z] = plane.normal().to_array();
        [x, y, z, plane.offset()]
    };
    let mut planes = planes.to_vec();
    planes.sort_by(|a, b| {
        let pairs = key(a).into_iter().zip(key(b));
        pairs.fold(std::cmp::Ordering::Equal, |order, (a, b)| {
            order.then((a + 0.0).total_cmp(&(b + 0.0))) // -0 is 0
        })
    });
    planes.dedup();
    planes
}
