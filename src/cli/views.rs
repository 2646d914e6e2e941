//! The cameras that flags mean, with their numbers and names.

use std::path::Path;

use glam::DVec3;
use rara::scene::Bounds;
use rara::{Camera, Scene};

use super::failure::Failure;
use super::lens::{Depths, Lens};
use super::path::Orbit;
use super::{framing, values};

/// A camera and what its file calls it.
#[derive(Debug, Clone)]
pub(super) struct View {
    /// Its number in the file; it replaces `{}` in a picture's name.
    pub(super) number: usize,
    pub(super) name: String,
    pub(super) camera: Camera,
}

/// The cameras that the flags mean.
#[derive(Debug)]
pub(super) enum Views {
    /// Cameras that are known before the scene is loaded.
    Given(Vec<View>),
    /// A camera that the scene's bounds will place.
    Framed {
        up: DVec3,
        lens: Lens,
        size: (u32, u32),
        depths: Depths,
    },
    /// An orbit round the scene that such a camera frames.
    Round(Orbit, Box<Views>),
}

impl Views {
    /// The numbers of the cameras in their file.
    pub(super) fn numbers(&self) -> impl Iterator<Item = usize> + '_ {
        let (given, placed) = match self {
            Self::Given(views) => (views.as_slice(), 0),
            Self::Framed { .. } => (&[][..], 1),
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
}

impl Views {
    /// The cameras, once the scene is known; one that frames it holds the box around it. [`framing::views`] are nearer.
    pub(super) fn of(self, scene: &Scene<'_>) -> Result<Vec<View>, Failure> {
        match self {
            Self::Given(views) => Ok(views),
            Self::Framed {
                up,
                lens,
                size,
                depths,
            } => {
                let camera = depths.of(lens.frame(&Bounds::of(scene), up, size)?)?;
                Ok(vec![View {
                    number: 0,
                    name: "framing".into(),
                    camera,
                }])
            }
            Self::Round(orbit, framed) => match *framed {
                Self::Framed {
                    up,
                    lens,
                    size,
                    depths,
                } => {
                    let camera = depths.of(lens.frame(&Bounds::of(scene), up, size)?)?;
                    Ok(framing::round(orbit, camera, (lens, up), scene))
                }
                given => given.of(scene),
            },
        }
    }
}

/// The views that `wanted` means: a number from 0, a name that may leave out its ending, a range of numbers with both ends, as
/// 3..6, or several of these with commas between them. A name goes before what else could be meant.
pub(super) fn picked(
    views: &[View],
    wanted: &str,
    path: &Path,
    flag: &str,
) -> Result<Vec<View>, Failure> {
    let whole = found(views, wanted);
    if whole.is_none() && wanted.contains(',') {
        let parts = wanted
            .split(',')
            .map(|part| picked(views, part.trim(), path, flag));
        let parts = parts.collect::<Result<Vec<_>, _>>()?;
        return Ok(parts.concat());
    }
    let range = || {
        let (first, last) = wanted.split_once("..")?;
        let number = |text: &str| {
            text.trim()
                .parse::<usize>()
                .ok()
                .filter(|n| *n < views.len())
        };
        let (first, last) = (number(first)?, number(last)?);
        let numbers = first.min(last)..=first.max(last);
        let mut views = views[numbers].to_vec();
        if last < first {
            views.reverse();
        }
        Some(views)
    };
    let picked = whole.map(|index| vec![views[index].clone()]);
    picked.or_else(range).ok_or_else(|| {
        let meant = values::meant(wanted, views.iter().map(|view| view.name.as_str()));
        Failure::Usage(format!(
            "{flag} {wanted}: {} has {} cameras, and none of that number (from 0) or name{meant}",
            path.display(),
            views.len()
        ))
    })
}

/// Where the view with the number or name `wanted` is.
fn found(views: &[View], wanted: &str) -> Option<usize> {
    let stem = |name: &str| Path::new(name).file_stem().map(|s| s.to_owned());
    let by_number = wanted.parse::<usize>().ok().filter(|n| *n < views.len());
    by_number
        .or_else(|| views.iter().position(|v| v.name == wanted))
        .or_else(|| {
            views
                .iter()
                .position(|v| stem(&v.name).is_some_and(|s| s == wanted))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_are_picked_by_number_name_stem_or_range() {
        let camera = Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, 50.0, (8, 8)).unwrap();
        let names = ["a.jpg", "b/7.png", "2", "0..1", "x,y"];
        let views = || {
            names.iter().enumerate().map(|(number, n)| View {
                number,
                name: n.to_string(),
                camera,
            })
        };
        let views: Vec<_> = views().collect();
        let numbers = |wanted| {
            let picked = picked(&views, wanted, Path::new("f"), "--view");
            picked.map(|picked| picked.iter().map(|view| view.number).collect::<Vec<_>>())
        };
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
