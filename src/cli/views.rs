//! The cameras that flags mean, with their numbers and names.

use std::path::Path;

use glam::DVec3;
use rara::Camera;
use rara::scene::Bounds;

use super::failure::Failure;
use super::lens::{Depths, Lens, UP};
use super::values;

/// A camera and what its file calls it.
#[derive(Debug, Clone)]
pub(super) struct NamedView {
    /// Its number in the file; it replaces `{}` in a picture's name.
    pub(super) number: usize,
    pub(super) name: String,
    pub(super) camera: Camera,
}

#[derive(Debug)]
pub(super) enum Views {
    /// Cameras that are known before the scene is loaded.
    Given(Vec<NamedView>),
    /// A camera that the scene will place.
    Framed(Framing),
    /// An orbit round the scene that such a camera frames.
    Round(Orbit, Framing),
}

/// So many pictures on the way round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Orbit {
    /// Turns; the camera goes to its right, and where they are below zero to its left.
    pub(super) turns: f64,
    pub(super) frames: u32,
}

/// A camera that the scene places, but for what flags say of it.
#[derive(Debug, Clone)]
pub(super) struct Framing {
    pub(super) up: DVec3,
    pub(super) lens: Lens,
    pub(super) size: (u32, u32),
    pub(super) depths: Depths,
    /// It stands here, and looks at the middle of what is framed.
    pub(super) eye: Option<DVec3>,
    /// It looks at this, from the side and the distance from which it would look at the middle.
    pub(super) target: Option<DVec3>,
    /// What is to be said of the direction that is up.
    pub(super) note: Option<String>,
}

impl Framing {
    /// The camera with its lens and its axes: it looks at the middle of what is framed from the eye, if that is said, and
    /// otherwise from the front, the right and above, with its eye anywhere.
    pub(super) fn turned(&self, middle: DVec3) -> Result<Camera, Failure> {
        let unit = Bounds {
            min: DVec3::NEG_ONE,
            max: DVec3::ONE,
        };
        match self.eye {
            Some(eye) => self.lens.look((eye, middle), self.up, self.size),
            None => {
                let camera = self.lens.frame(&unit, self.up, self.size);
                camera.map_err(Failure::usage)
            }
        }
    }

    /// The camera that looks at the middle from where it stands, moved so that it looks at the target likewise.
    pub(super) fn aimed(&self, camera: Camera, middle: DVec3) -> Camera {
        let forward = camera.rotation.row(2);
        match self.target {
            Some(target) => camera.eye(target - forward * forward.dot(middle - camera.eye)),
            None => camera,
        }
    }

    /// The camera that holds a box.
    pub(super) fn boxed(&self, bounds: &Bounds) -> Result<Camera, Failure> {
        let camera = match self.eye {
            Some(_) => self.turned(bounds.centre())?,
            None => self.lens.frame(bounds, self.up, self.size)?,
        };
        self.depths.camera(self.aimed(camera, bounds.centre()))
    }

    /// Finds errors that do not depend on the scene before it is read.
    pub(super) fn checked(self) -> Result<Self, Failure> {
        let eye = self.eye.unwrap_or_default();
        let aside = self.up.normalize_or(UP).any_orthonormal_vector();
        self.depths
            .camera(self.turned(eye + aside * (1.0 + eye.length()))?)?;
        Ok(self)
    }
}

impl Views {
    /// The numbers of the cameras in their file.
    pub(super) fn numbers(&self) -> impl Iterator<Item = usize> + '_ {
        let (given, placed) = match self {
            Self::Given(views) => (views.as_slice(), 0),
            Self::Framed(_) => (&[][..], 1),
            Self::Round(orbit, _) => (&[][..], orbit.frames as usize),
        };
        given.iter().map(|view| view.number).chain(0..placed)
    }

    /// Refuses several cameras, where `what` needs one.
    pub(super) fn single(self, what: &str) -> Result<Self, Failure> {
        match self.numbers().count() {
            1 => Ok(self),
            count => Err(Failure::Usage(format!(
                "{what} has one camera, and these are {count}: give --view a number or a name"
            ))),
        }
    }

    /// The direction that is up in the world, where the scene places the camera.
    #[cfg(feature = "view")]
    pub(super) fn up(&self) -> Option<DVec3> {
        self.framed().map(|framed| framed.up)
    }

    /// What is to be said of it.
    pub(super) fn note(&self) -> Option<String> {
        self.framed()?.note.clone()
    }

    fn framed(&self) -> Option<&Framing> {
        match self {
            Self::Given(_) => None,
            Self::Framed(framed) | Self::Round(_, framed) => Some(framed),
        }
    }
}

/// The numbers of the cameras with these names that `wanted` means: a number from 0, a name that may leave out its ending, a range
/// of numbers with both ends, as 3..6, or several of these with commas between them. A name goes before what else could be meant.
pub(super) fn picked(
    names: &[&str],
    wanted: &str,
    path: &Path,
    flag: &str,
) -> Result<Vec<usize>, Failure> {
    let whole = found(names, wanted);
    if whole.is_none() && wanted.contains(',') {
        let parts = wanted
            .split(',')
            .map(|part| picked(names, part.trim(), path, flag));
        let parts = parts.collect::<Result<Vec<_>, _>>()?;
        return Ok(parts.concat());
    }
    let number = |text: &str| text.trim().parse().ok().filter(|n| *n < names.len());
    let range = || -> Option<Vec<usize>> {
        let (first, last) = wanted.split_once("..")?;
        let (first, last): (usize, usize) = (number(first)?, number(last)?);
        Some(match last < first {
            false => (first..=last).collect(),
            true => (last..=first).rev().collect(),
        })
    };
    let picked = whole.map(|number| vec![number]);
    picked.or_else(range).ok_or_else(|| {
        let meant = values::meant(wanted, names.iter().copied());
        Failure::Usage(format!(
            "{flag} {wanted}: {} has {}, and none of that number (from 0) or name{meant}",
            path.display(),
            super::output::counted(names.len() as u64, "camera")
        ))
    })
}

/// The number of the camera with the number or name `wanted`.
fn found(names: &[&str], wanted: &str) -> Option<usize> {
    let stem = |name: &str| Path::new(name).file_stem().map(|s| s.to_owned());
    let by_number = wanted.parse::<usize>().ok().filter(|n| *n < names.len());
    by_number
        .or_else(|| names.iter().position(|name| *name == wanted))
        .or_else(|| {
            names
                .iter()
                .position(|name| stem(name).is_some_and(|s| s == wanted))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_are_picked_by_number_name_stem_or_range() {
        let names = ["a.jpg", "b/7.png", "2", "0..1", "x,y"];
        let numbers = |wanted| picked(&names, wanted, Path::new("f"), "--view");
        for (wanted, meant) in [
            ("1", &[1][..]),
            ("a.jpg", &[0]),
            ("a", &[0]),
            ("7", &[1]),
            ("2", &[2]),
            ("1..3", &[1, 2, 3]),
            ("3..1", &[3, 2, 1]),
            ("2 .. 2", &[2]),
            ("2,1..2, a", &[2, 1, 2, 0]),
            // These are names.
            ("0..1", &[3]),
            ("x,y", &[4]),
        ] {
            assert_eq!(numbers(wanted).ok().as_deref(), Some(meant), "{wanted}");
        }
        for none in ["9", "3..5", "..2", "1..", "1,", "0,b", "a..7"] {
            let failure = numbers(none).expect_err(none).to_string();
            assert!(failure.contains("f has 5 cameras"), "{none}: {failure}");
        }
    }
}
