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

/// The view with the number or name `wanted`; a name may leave out its ending.
pub(super) fn pick(views: &[View], wanted: &str, path: &Path, flag: &str) -> Result<View, Failure> {
    let count = views.len();
    let stem = |name: &str| Path::new(name).file_stem().map(|s| s.to_owned());
    let by_number = wanted.parse::<usize>().ok().filter(|n| *n < count);
    let index = by_number
        .or_else(|| views.iter().position(|v| v.name == wanted))
        .or_else(|| {
            views
                .iter()
                .position(|v| stem(&v.name).is_some_and(|s| s == wanted))
        });
    let meant = values::meant(wanted, views.iter().map(|view| view.name.as_str()));
    let found = index.and_then(|i| views.get(i).cloned());
    found.ok_or_else(|| {
        Failure::Usage(format!(
            "{flag} {wanted}: {} has {count} cameras, and none of that number (from 0) or name{meant}",
            path.display()
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_are_picked_by_number_name_or_stem() {
        let camera = Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, 50.0, (8, 8)).unwrap();
        let names = ["a.jpg", "b/7.png", "2"];
        let views = || {
            names.iter().enumerate().map(|(number, n)| View {
                number,
                name: n.to_string(),
                camera,
            })
        };
        let picked = |wanted| {
            let views: Vec<_> = views().collect();
            pick(&views, wanted, Path::new("f"), "--view")
                .map(|v| v.number)
                .ok()
        };
        assert_eq!(picked("1"), Some(1));
        assert_eq!(picked("a.jpg"), Some(0));
        assert_eq!(picked("a"), Some(0));
        assert_eq!(picked("7"), Some(1));
        assert_eq!(picked("2"), Some(2));
        assert_eq!(picked("9"), None);
    }
}
