//! Questions that shapes, prisms and meshes all answer, whichever of these an expression is.

use glam::DVec3;

use super::Expression;
use super::expression::{MESH, POLYGON};
use super::outline::Pen;
use crate::camera::Camera;

impl Expression {
    /// Returns the word of a shape, a prism or a mesh, or of what joins these.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Shape(shape) => shape.solid().name(),
            Self::Prism(_) => POLYGON,
            Self::Mesh(_) => MESH,
            Self::All(_) => "all",
            Self::Any(_) => "any",
            Self::Not(_) => "not",
        }
    }

    /// Returns the middle of a shape, a prism or a mesh, world units: for what has none, as a plane, the place of it that is nearest to
    /// `near`. The middle of several is that of the first.
    pub fn middle(&self, near: DVec3) -> DVec3 {
        match self {
            Self::Shape(shape) => shape.middle(near),
            Self::Prism(prism) => prism.middle(near),
            Self::Mesh(mesh) => mesh.middle(),
            several => several
                .leaves()
                .first()
                .map_or(near, |first| first.middle(near)),
        }
    }

    /// Returns the lines by which the region's shapes, prisms and meshes are recognised, as [`Shape::outline`](super::Shape::outline) has them.
    pub fn outline(&self, camera: &Camera, near: DVec3, reach: f64) -> Vec<[DVec3; 2]> {
        match self {
            Self::Shape(shape) => shape.outline(camera, near, reach),
            Self::Prism(prism) => {
                let height = prism.height(near);
                prism.edges([height - reach, height + reach])
            }
            Self::Mesh(mesh) => {
                let mut pen = Pen::new(camera, near, reach);
                pen.mesh(mesh.inside());
                pen.lines
            }
            several => {
                let outlines = several.leaves().into_iter();
                outlines
                    .flat_map(|leaf| leaf.outline(camera, near, reach))
                    .collect()
            }
        }
    }
}
