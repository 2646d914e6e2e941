//! Sections: planes that the camera faces square on, and what it sees of the scene behind them.

use glam::DVec3;
use rara::clip::Expression;
use rara::scene::{Axis, Bounds};
use rara::{Camera, Plane, Result};
use rara_base::setters;

use super::framing::Visible;
use super::lens::upright;

setters! {
    /// The options of sections. Sections have no perspective, and all sections across one axis have the same scale.
    #[derive(Debug, Clone, Copy)]
    #[non_exhaustive]
    pub struct Sections {
        /// The picture's width and height, pixels.
        pub size: (u32, u32),
        /// The direction that is up in the picture. Default: the up direction of the axis. For a plane that is not across an
        /// axis it is -y, or z if the normal of the plane is nearly parallel to y.
        pub up: Option<DVec3>,
        /// World units per pixel. Default: everything visible fits into the picture.
        pub scale: Option<f64>,
        /// The thickness of the slab that is kept, in world units. Default: everything behind the plane is kept.
        pub thickness: Option<f64>,
    }
}

/// A section: its camera, and the planes that cut the scene.
#[derive(Debug, Clone, Copy)]
pub struct Section {
    /// The camera, which looks along the plane's normal from the side that is cut away.
    pub camera: Camera,
    /// The plane of the section, which keeps what is behind it.
    pub plane: Plane,
    /// The plane at the back of a section with a thickness, which keeps what is in front of it.
    pub back: Option<Plane>,
}

impl Section {
    /// Returns the shapes that cut: the plane, and the plane at the back if there is one.
    pub fn shapes(&self) -> Vec<Expression> {
        let planes = [self.plane].into_iter().chain(self.back);
        planes
            .map(|plane| Expression::Shape(plane.into()))
            .collect()
    }
}

impl Sections {
    /// Makes the options of sections with pictures of this size.
    pub fn new(size: (u32, u32)) -> Self {
        Self {
            size,
            up: None,
            scale: None,
            thickness: None,
        }
    }

    /// Returns the section across an axis, at a share from 0 to 1 of the extent of the scene's robust bounds.
    ///
    /// # Errors
    /// The errors of [`at`](Self::at).
    pub fn across(
        &self,
        (axis, share): (&Axis, f64),
        bounds: &Bounds,
        visible: &Visible,
    ) -> Result<Section> {
        let at = bounds.min.lerp(bounds.max, share).dot(axis.along);
        self.across_at((axis, at), visible)
    }

    /// Returns the section across an axis, at a position along it in world units.
    ///
    /// # Errors
    /// The errors of [`at`](Self::at).
    pub fn across_at(&self, (axis, at): (&Axis, f64), visible: &Visible) -> Result<Section> {
        let plane = Plane::new(axis.forward, -axis.forward.dot(axis.along) * at)?;
        self.facing(plane, axis.up, visible)
    }

    /// Returns the section at a plane. Use [`Visible::nearly_all_of`] a scene for `visible`.
    ///
    /// # Errors
    /// [`Error::Invalid`](rara::Error::Invalid) if the plane or the picture is not possible.
    pub fn at(&self, plane: Plane, visible: &Visible) -> Result<Section> {
        let up = match plane.normal().y.abs() < 0.99 {
            true => DVec3::NEG_Y,
            false => DVec3::Z,
        };
        self.facing(plane, up, visible)
    }

    fn facing(&self, plane: Plane, up: DVec3, visible: &Visible) -> Result<Section> {
        let up = self.up.map_or(up, |up| upright(plane.normal(), up));
        let mut camera = visible.facing(&plane, up, self.size)?;
        if let Some(scale) = self.scale {
            camera = camera.fx(1.0 / scale).fy(1.0 / scale);
        }
        let back = |thickness: f64| Plane::new(-plane.normal(), thickness - plane.offset());
        Ok(Section {
            camera,
            plane,
            back: self.thickness.map(back).transpose()?,
        })
    }
}
