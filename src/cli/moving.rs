//! A clip that moves: a plane across the scene, or any region to another.

use clap::Args;
use glam::DVec3;
use rara::clip::Expression;
use rara::scene::extent_along;
use rara::scene::layers::Region;
use rara::{Bounds, Plane, Scene};
use rara_shots::Ease;

use super::failure::Failure;

/// Where a region moves.
#[derive(Debug, Args)]
pub(super) struct MovingArgs {
    /// The clip of the first frame, an expression as for --clip-expr
    #[arg(long, value_name = "EXPRESSION", value_parser = str::parse::<Region>, allow_hyphen_values = true)]
    from: Option<Region>,
    /// The clip of the last frame; it has the same kinds of shapes in the same order as --from
    ///
    /// Points, sizes and radii are interpolated linearly, and rotations and normals along the shortest arcs.
    #[arg(long, value_name = "EXPRESSION", value_parser = str::parse::<Region>, allow_hyphen_values = true)]
    to: Option<Region>,
}

/// The most steps that are tried before the scene is read.
const MOST_TRIED: u32 = 1000;

/// What moves, before the scene is known.
#[derive(Debug)]
pub(super) struct Movement {
    target: Target<Region>,
    ease: Ease,
    frames: u32,
}

/// What moves in a scene.
#[derive(Debug)]
pub(super) struct Moving {
    target: Target<Expression>,
    /// Where it begins and ends: of a plane along its normal, of a region the shares of its way.
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
    /// What the flags move in so many frames, if anything: a plane of this normal, or a region. What has nothing between its
    /// begin and its end is refused.
    pub(super) fn meant(
        &self,
        normal: Option<DVec3>,
        (frames, ease): (u32, Ease),
    ) -> Result<Option<Movement>, Failure> {
        let target = match (normal, &self.from, &self.to) {
            (Some(normal), ..) => {
                Target::Plane(Plane::new(normal, 0.0).map_err(Failure::usage)?.normal())
            }
            (None, Some(from), Some(to)) => Target::Region(from.clone(), to.clone()),
            _ => return Ok(None),
        };
        let tried = frames.min(MOST_TRIED);
        let example = Moving {
            target: target.map(|region| Ok(region.example().clone()))?,
            range: (0.0, 1.0),
            ease,
            frames: tried,
        };
        for index in 0..tried {
            example.at(index).map_err(Failure::usage)?;
        }
        Ok(Some(Movement {
            target,
            ease,
            frames,
        }))
    }
}

impl Movement {
    /// The movement in a scene.
    pub(super) fn in_scene(&self, scene: &Scene<'_>) -> rara::Result<Moving> {
        let bounds = std::cell::LazyCell::new(|| Bounds::of(scene));
        Ok(Moving {
            target: self.target.map(|region| region.resolve(|| *bounds))?,
            range: match self.target {
                Target::Plane(normal) => extent_along(scene, normal),
                Target::Region(..) => (0.0, 1.0),
            },
            ease: self.ease,
            frames: self.frames,
        })
    }
}

impl Moving {
    /// The clip of a frame.
    pub(super) fn at(&self, index: u32) -> rara::Result<Expression> {
        match (self.plane(index)?, &self.target) {
            (Some(plane), _) => Ok(Expression::Shape(plane.into())),
            (None, Target::Region(from, to)) => from.between(to, self.position(index)),
            (None, Target::Plane(_)) => unreachable!("a plane is one"),
        }
    }

    /// The plane of a frame, if it is one that moves across the scene.
    pub(super) fn plane(&self, index: u32) -> rara::Result<Option<Plane>> {
        match self.target {
            Target::Plane(normal) => Plane::new(normal, -self.position(index)).map(Some),
            Target::Region(..) => Ok(None),
        }
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

impl<R> Target<R> {
    fn map<T>(&self, change: impl Fn(&R) -> rara::Result<T>) -> rara::Result<Target<T>> {
        Ok(match self {
            Self::Plane(normal) => Target::Plane(*normal),
            Self::Region(from, to) => Target::Region(change(from)?, change(to)?),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_equal_and_reach_both_ends() {
        let positions = |frames, ease| {
            let moving = Moving {
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
