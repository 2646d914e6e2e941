//! The regions that the clip keeps, as the shaders read them: what all layers' regions have in common, and the surfaces of
//! one.

use std::cmp::Ordering;

use crate::clip::{Clip, ClipOp, Surface};
use crate::error::{Error, Result};
use crate::settings::{Mode, Settings};
use crate::types::{self, RegionData};

/// The largest distance of a surface that is not taken for infinity, in the layer's units. It lies beyond every splat: a power of two
/// below the end of single precision's range.
const FARTHEST: f64 = (1_u128 << 126) as f64;

/// The values that are common to all regions that these clips make in the mode of the settings. Without anything to clip
/// with, they are the same as in mode `none`.
pub(super) fn region_data<'a>(
    clips: impl Iterator<Item = &'a Clip>,
    settings: &Settings,
) -> Result<RegionData> {
    let have = clips.map(|clip| clip.surfaces.len()).max().unwrap_or(0);
    let most = Clip::MAX_SURFACES;
    if have > most {
        return Err(Error::Invalid(format!(
            "a clip of {have} surfaces is beyond the {most} supported; use fewer"
        )));
    }
    let mut region: RegionData = bytemuck::Zeroable::zeroed();
    region.mode = match settings.mode {
        _ if have == 0 => types::MODE_NONE,
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
        ClipOp::Or if !clip.surfaces.is_empty() => types::OP_OR,
        ClipOp::And | ClipOp::Or => types::OP_AND,
    }
}

/// The surfaces of a clip, which is given in the space of the layer that it cuts. There are no repetitions, since cutting
/// twice is cutting once, and the order is their own, so that no bit of a picture depends on the order in which they are
/// given.
pub(super) fn surfaces(clip: &Clip) -> impl Iterator<Item = types::SurfaceData> {
    let mut surfaces: Vec<_> = clip.surfaces.iter().map(Numbers::of).collect();
    surfaces.sort_by(Numbers::order);
    surfaces.dedup();
    surfaces.into_iter().map(Numbers::packed)
}

/// The numbers of a surface, in which it differs from others.
#[derive(Clone, Copy, PartialEq)]
struct Numbers {
    /// `SURFACE_*`.
    kind: u32,
    /// As many as a shape has; none has more so far.
    values: [f64; 4],
}

impl Numbers {
    fn of(surface: &Surface) -> Self {
        match surface {
            Surface::Plane(plane) => Self {
                kind: types::SURFACE_PLANE,
                values: plane.normal().extend(plane.offset()).to_array(),
            },
        }
    }

    fn order(&self, other: &Self) -> Ordering {
        let pairs = self.values.into_iter().zip(other.values);
        pairs.fold(self.kind.cmp(&other.kind), |order, (a, b)| {
            order.then((a + 0.0).total_cmp(&(b + 0.0))) // -0 is 0
        })
    }

    /// Stores each number as two floats.
    fn packed(self) -> types::SurfaceData {
        let values = self.values.map(|v| v.clamp(-FARTHEST, FARTHEST));
        let high = values.map(|v| v as f32);
        let low = std::array::from_fn(|i| (values[i] - f64::from(high[i])) as f32);
        types::SurfaceData {
            high,
            low,
            kind: self.kind,
            pad: [0; 3],
        }
    }
}
