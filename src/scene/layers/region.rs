//! Clips and predicates whose planes and slabs may lie at shares of the scene.

use std::str::FromStr;

use glam::DVec3;

use rara_base::error::{Error, Result};

use crate::bounds::Bounds;
use crate::clip::Expression;
use crate::text_reader::ShapeTree;

/// The bounds of an example of a scene.
const EXAMPLE: Bounds = Bounds {
    min: DVec3::ZERO,
    max: DVec3::ONE,
};

/// A clip, or another thing with shapes in it, as it was typed.
#[derive(Debug, Clone, PartialEq)]
pub enum Region<T = Expression> {
    /// One that says itself where it lies.
    Fixed(T),
    /// One that lies at shares of the scene: its text, and what that means in an example of a scene.
    Relative(String, T),
}

impl Region {
    /// The text of one shape, prism or mesh.
    ///
    /// # Errors
    /// [`Error::Invalid`](rara_base::error::Error::Invalid) for other text.
    pub fn shape(text: &str) -> Result<Self> {
        let (shape, at_shares) = Expression::read_leaf(text, Some(EXAMPLE))?;
        Ok(Self::new(text, shape, at_shares))
    }
}

impl<T: ShapeTree> FromStr for Region<T> {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        // What is wrong with it is found before the scene is read.
        let (example, has_shares) = T::read(text, Some(EXAMPLE))?;
        Ok(Self::new(text, example, has_shares))
    }
}

impl<T> Region<T> {
    fn new(text: &str, example: T, has_shares: bool) -> Self {
        match has_shares {
            true => Self::Relative(text.into(), example),
            false => Self::Fixed(example),
        }
    }

    /// What it is in some scene: in all but the places at shares it is that in every scene.
    pub fn example(&self) -> &T {
        let (Self::Fixed(one) | Self::Relative(_, one)) = self;
        one
    }
}

impl<T: ShapeTree + Clone> Region<T> {
    /// What it is in a scene, whose bounds are asked for if it lies at shares of them: those of a large one take a while.
    ///
    /// # Errors
    /// [`Error::Invalid`] if it is not possible within these bounds.
    pub fn resolve(&self, bounds: impl FnOnce() -> Bounds) -> Result<T> {
        match self {
            Self::Fixed(one) => Ok(one.clone()),
            Self::Relative(text, _) => T::read(text, Some(bounds())).map(|(read, _)| read),
        }
    }
}

#[cfg(test)]
mod tests;
