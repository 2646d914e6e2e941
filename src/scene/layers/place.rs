//! Where a layer stands.

use glam::{DAffine3, DQuat, DVec3};
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

use crate::gaussians::Gaussians;
use crate::placement::Placement;

/// Where a layer stands: its own axes are stretched, which a placement cannot say, before it is placed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Where the stretched layer is placed.
    pub placement: Placement,
    /// The factors by which its own axes are stretched before; negative ones mirror.
    pub stretch: DVec3,
}

impl Place {
    /// A place with one scale or one for each axis, of which negative ones mirror.
    ///
    /// # Errors
    /// [`Error::Invalid`] for what no layer can be placed by.
    pub fn new(position: DVec3, turn: DQuat, scales: &[f64]) -> Result<Self> {
        let (scale, stretch) = match *scales {
            [scale] if scale > 0.0 => (scale, DVec3::ONE),
            [scale] if scale < 0.0 => (1.0, DVec3::splat(scale)),
            [x, y, z] if x == y && x == z && x > 0.0 => (x, DVec3::ONE),
            [x, y, z] if x * y * z != 0.0 => (1.0, DVec3::new(x, y, z)),
            _ => {
                return Err(Error::Invalid(
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

/// Stretches Gaussians along the axes of their layer.
///
/// # Errors
/// [`Error::Invalid`] if single precision cannot hold the result.
pub fn stretch(gaussians: &mut Gaussians, by: DVec3) -> Result<()> {
    if by == DVec3::ONE {
        return Ok(()); // to the bit
    }
    let lost = gaussians.transform(&DAffine3::from_scale(by)).len();
    match lost {
        0 => Ok(()),
        _ => Err(Error::Invalid(format!(
            "scaled by {}, {} and {}, {} would be beyond single precision; give smaller scales",
            by.x,
            by.y,
            by.z,
            counted(lost as u64, "splat")
        ))),
    }
}
