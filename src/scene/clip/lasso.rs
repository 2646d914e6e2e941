//! Lassos: polygons that are drawn in a picture, and the regions that are seen in them.

use std::str::FromStr;

use glam::{DMat2, DVec2};

use super::{Expression, Prism, PrismBase};
use crate::camera::{Camera, Projection};
use crate::text_reader::number;
use rara_base::error::{Error, Result, shortened};

/// A polygon in a picture, with holes, whose inside or outside stays visible at every depth. The corners are in pixels from the
/// picture's top left corner, of which the first pixel's centre is (0.5, 0.5). It parses from text, as `200,300;800,250;500,800`,
/// with a `|` before the corners of each hole; a leading `!` keeps the outside.
///
/// ```
/// # use rara_scene as rara;
/// use rara::{Camera, clip::Lasso, glam::DVec3};
///
/// let camera = Camera::look_at(DVec3::NEG_Z, DVec3::ZERO, DVec3::NEG_Y, 90.0, (100, 100))?;
/// let right_half: Lasso = "50,0;100,0;100,100;50,100".parse()?;
/// let clip = right_half.expression(&camera)?.clip();
/// assert!(clip.keeps(DVec3::new(0.4, 0.0, 0.0)) && !clip.keeps(DVec3::new(-0.4, 0.0, 0.0)));
/// # Ok::<(), rara::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Lasso {
    rings: Vec<Vec<DVec2>>,
    keeps: bool,
}

impl Lasso {
    /// Makes a lasso of a polygon and its holes, each as its corners, px; `keeps` says whether the inside stays visible.
    ///
    /// # Errors
    /// The errors of [`Prism::new`].
    pub fn new(rings: Vec<Vec<DVec2>>, keeps: bool) -> Result<Self> {
        Prism::new(PrismBase::Axis("z".into()), &rings, None)?;
        Ok(Self { rings, keeps })
    }

    /// Returns the region that it keeps in the picture of a camera: the cone of all lines of sight through the polygon, or a prism
    /// along the view axis of an orthographic camera.
    ///
    /// # Errors
    /// The errors of [`Prism::new`], where numbers overflow.
    pub fn expression(&self, camera: &Camera) -> Result<Expression> {
        let prism = Expression::Prism(self.prism(camera)?);
        Ok(match self.keeps {
            true => prism,
            false => Expression::Not(Box::new(prism)),
        })
    }

    /// The prism of its inside.
    fn prism(&self, camera: &Camera) -> Result<Prism> {
        let (focal, centre) = (
            DVec2::new(camera.fx, camera.fy),
            DVec2::new(camera.cx, camera.cy),
        );
        let [right, down, forward] = [0, 1, 2].map(|row| camera.rotation.row(row));
        let mapped = |map: &dyn Fn(DVec2) -> DVec2| {
            let corner = |pixel: &DVec2| map((pixel - centre) / focal);
            let ring = |ring: &Vec<DVec2>| ring.iter().map(corner).collect();
            self.rings.iter().map(ring).collect::<Vec<Vec<DVec2>>>()
        };
        if camera.projection == Projection::Perspective {
            // If the picture is mirrored, its corners are mirrored instead.
            let sign = right.cross(down).dot(forward).signum();
            let rings = mapped(&|corner| DVec2::new(sign * corner.x, corner.y));
            let base = PrismBase::Eye {
                eye: camera.eye,
                right: sign * right,
                down,
            };
            return Prism::new(base, &rings, None);
        }
        let base = PrismBase::Direction(forward);
        let [u, v] = base.across()?;
        // The numbers of the scene's space, in the axes of the direction.
        let turn = DMat2::from_cols(
            DVec2::new(right.dot(u), right.dot(v)),
            DVec2::new(down.dot(u), down.dot(v)),
        );
        let eye = DVec2::new(camera.eye.dot(u), camera.eye.dot(v));
        Prism::new(base, &mapped(&|corner| eye + turn * corner), None)
    }
}

impl FromStr for Lasso {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let text = text.trim();
        match text.strip_prefix('!') {
            Some(corners) => Self::new(rings(corners)?, false),
            None => Self::new(rings(text)?, true),
        }
    }
}

/// Reads a polygon and its holes: corners as `0,0;2,0;2,1`, with a `|` before those of each hole.
pub(super) fn rings(text: &str) -> Result<Vec<Vec<DVec2>>> {
    let corner = |text: &str| {
        let pair = text.split_once(',').ok_or_else(|| {
            Error::Invalid(format!(
                "'{}' is not a corner; give two numbers with a comma between them, and a ; between corners",
                shortened(text)
            ))
        })?;
        Ok(DVec2::new(number(pair.0)?, number(pair.1)?))
    };
    let ring = |text: &str| text.split(';').map(corner).collect::<Result<Vec<_>>>();
    match text.trim() {
        "" => Ok(Vec::new()),
        all => all.split('|').map(ring).collect(),
    }
}

#[cfg(test)]
mod tests;
