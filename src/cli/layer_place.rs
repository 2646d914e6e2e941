//! Where a layer stands.

use glam::{DAffine3, DQuat, DVec3};
use rara::{Gaussians, Placement};

use super::output::counted;

/// Where a layer stands: its own axes are stretched, which a placement cannot say, before it is placed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub(super) placement: Placement,
    pub(super) stretch: DVec3,
}

impl Place {
    /// A place with one scale or one for each axis, of which negative ones mirror.
    ///
    /// # Errors
    /// [`rara::Error::Invalid`] for what no layer can be placed by.
    pub(super) fn new(position: DVec3, turn: DQuat, scales: &[f64]) -> rara::Result<Self> {
        let (scale, stretch) = match *scales {
            [scale] => (scale, DVec3::ONE),
            [x, y, z] if x == y && x == z && x > 0.0 => (x, DVec3::ONE),
            [x, y, z] if x * y * z != 0.0 => (1.0, DVec3::new(x, y, z)),
            _ => {
                return Err(rara::Error::Invalid(
                    "a scale is one number or one for each of the three axes, none of them 0"
                        .into(),
                ));
            }
        };
        Ok(Self {
            placement: Placement::new(position, turn, scale)?,
            stretch,
        })
    }
}

/// Stretches the Gaussians along the axes of their layer.
pub(super) fn stretch(gaussians: &mut Gaussians, by: DVec3) -> rara::Result<()> {
    if by == DVec3::ONE {
        return Ok(()); // to the bit
    }
    let lost = gaussians.transform(&DAffine3::from_scale(by)).len();
    match lost {
        0 => Ok(()),
        _ => Err(rara::Error::Invalid(format!(
            "scaled by {}, {} and {}, {} would be beyond single precision; give smaller scales",
            by.x,
            by.y,
            by.z,
            counted(lost as u64, "splat")
        ))),
    }
}
