//! A clip that moves: a plane across the scene, or any region to another.

use std::cell::LazyCell;

use clap::Args;
use glam::DVec3;
use rara::clip::Expression;
use rara::scene::extent_along;
use rara::scene::layers::Region;
use rara::{Bounds, Clip, ClipOp, Plane, Scene};
use rara_shots::Ease;

use super::clip::joined;
use super::failure::Failure;

/// Where a region moves.
#[derive(Debug, Args)]
pub(super) struct MovingArgs {
    /// The clip of the first picture, an expression as for --clip-expr
    ///
    /// --from and --to are given together. rara then draws a series of pictures, in which the clip of --from changes into that of
    /// --to in equal steps. --frames is the number of pictures. rara render also needs --path, which moves the camera; rara sweep
    /// does not.
    #[arg(long, value_name = "EXPRESSION", value_parser = str::parse::<Region>, allow_hyphen_values = true)]
    from: Option<Region>,
    /// The clip of the last picture; it has the same kinds of shapes in the same order as --from
    ///
    /// Points, sizes and radii are interpolated linearly, and rotations and normals along the shortest arcs.
    #[arg(long, value_name = "EXPRESSION", value_parser = str::parse::<Region>, allow_hyphen_values = true)]
    to: Option<Region>,
}

/// The most steps that are tried before the scene is read.
const MOST_TRIED: u32 = 1000;

/// A clip that moves: between regions as they were typed, or between the expressions that these are in a scene.
#[derive(Debug)]
pub(super) struct Moving<R> {
    target: Target<R>,
    /// The positions at which it begins and ends: of a plane along its normal, of a region the shares of its way.
    range: (f64, f64),
    ease: Ease,
    frames: u32,
}

#[derive(Debug)]
enum Target<R> {
    /// A plane of this unit normal, across the scene.
    Plane(DVec3),
    /// A region that moves from the first to the other.
    Region(R, R),
}

impl MovingArgs {
    /// The clip that the flags move in so many frames, if any: a plane of this normal, or a region. Flags between whose clips
    /// there is nothing are refused.
    pub(super) fn meant(
        &self,
        normal: Option<DVec3>,
        (frames, ease): (u32, Ease),
    ) -> Result<Option<Moving<Region>>, Failure> {
        let target = match (normal, &self.from, &self.to) {
            (Some(normal), ..) => {
                Target::Plane(Plane::new(normal, 0.0).map_err(Failure::usage)?.normal())
            }
            (None, Some(from), Some(to)) => Target::Region(from.clone(), to.clone()),
            _ => return Ok(None),
        };
        let moving = Moving {
            target,
            range: (0.0, 1.0),
            ease,
            frames,
        };
        let mut example = moving.map(|region| Ok(region.example().clone()))?;
        example.frames = frames.min(MOST_TRIED);
        for index in 0..example.frames {
            example.at(index).map_err(Failure::usage)?;
        }
        Ok(Some(moving))
    }
}

impl<R> Moving<R> {
    /// The same with other regions.
    fn map<T>(&self, change: impl Fn(&R) -> rara::Result<T>) -> rara::Result<Moving<T>> {
        Ok(Moving {
            target: match &self.target {
                Target::Plane(normal) => Target::Plane(*normal),
                Target::Region(from, to) => Target::Region(change(from)?, change(to)?),
            },
            range: self.range,
            ease: self.ease,
            frames: self.frames,
        })
    }

    /// The position in a frame: both ends included, the middle when there is one frame only.
    fn position(&self, index: u32) -> f64 {
        let (from, to) = self.range;
        match self.frames {
            1 => (from + to) / 2.0,
            _ => from + (to - from) * self.ease.way(f64::from(index) / f64::from(self.frames - 1)),
        }
    }
}

impl Moving<Region> {
    /// The expression of the first frame in an example of a scene.
    pub(super) fn example(&self) -> Option<Expression> {
        let example = self.map(|region| Ok(region.example().clone()));
        example.and_then(|example| example.at(0)).ok()
    }

    /// The same in a scene.
    pub(super) fn in_scene(&self, scene: &Scene<'_>) -> rara::Result<Moving<Expression>> {
        let bounds = LazyCell::new(|| Bounds::of(scene));
        let mut moving = self.map(|region| region.resolve(|| *bounds))?;
        if let Target::Plane(normal) = self.target {
            moving.range = extent_along(scene, normal);
        }
        Ok(moving)
    }
}

impl Moving<Expression> {
    /// The clip of a frame, which it makes together with shapes that stand still.
    pub(super) fn clip(
        &self,
        index: u32,
        (still, op): (&[Expression], ClipOp),
    ) -> rara::Result<Clip> {
        Ok(joined(&[still, &[self.at(index)?]].concat(), op))
    }

    fn at(&self, index: u32) -> rara::Result<Expression> {
        let position = self.position(index);
        match &self.target {
            Target::Plane(normal) => Ok(Expression::Shape(Plane::new(*normal, -position)?.into())),
            Target::Region(from, to) => from.between(to, position),
        }
    }

    /// The plane of a frame, if it is one that moves across the scene.
    pub(super) fn plane(&self, index: u32) -> rara::Result<Option<Plane>> {
        match self.target {
            Target::Plane(normal) => Plane::new(normal, -self.position(index)).map(Some),
            Target::Region(..) => Ok(None),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_equal_and_reach_both_ends() {
        let positions = |frames, ease| {
            let moving = Moving::<Region> {
                target: Target::Plane(DVec3::Z),
                range: (-1.0, 3.0),
                ease,
                frames,
            };
            (0..frames).map(|i| moving.position(i)).collect::<Vec<_>>()
        };
        assert_eq!(positions(5, Ease::None), [-1.0, 0.0, 1.0, 2.0, 3.0]);
        assert_eq!(positions(5, Ease::In), [-1.0, -0.75, 0.0, 1.25, 3.0]);
        assert_eq!(positions(1, Ease::None), [1.0]);
    }
}
