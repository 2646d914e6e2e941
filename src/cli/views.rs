//! The cameras that flags mean, with their numbers and names.

use std::borrow::Cow;
use std::path::Path;

use glam::DVec3;
use rara::scene::Bounds;
use rara::{Camera, Scene};
use rara_shots::{Framing, Orbit, Outside, Visible, upright};

use super::failure::Failure;
use super::output::{self, grouped};
use super::values;

/// A camera and what its file calls it.
#[derive(Debug, Clone)]
pub struct NamedView {
    /// Its number in the file; it replaces `{}` in a picture's name.
    pub(super) number: usize,
    pub(super) name: String,
    pub camera: Camera,
}

#[derive(Debug)]
pub enum Views {
    /// Cameras that are known before the scene is loaded.
    Given(Vec<NamedView>),
    /// A camera that the scene will place.
    Framed(Framed),
    /// An orbit round the scene that such a camera frames.
    Round(Orbit, Framed),
}

/// A camera that the scene places, but for what flags say of it.
#[derive(Debug)]
pub struct Framed {
    pub(super) framing: Framing,
    /// What is to be said of the direction that is up.
    pub(super) note: Option<String>,
}

/// The views of a path's cameras, which are named for it and numbered from 0.
pub(super) fn numbered(path: &str, cameras: Vec<Camera>) -> Vec<NamedView> {
    let view = |(number, camera)| NamedView {
        number,
        name: format!("{path}_{number}"),
        camera,
    };
    cameras.into_iter().enumerate().map(view).collect()
}

impl Views {
    /// The numbers of the cameras in their file.
    pub(super) fn numbers(&self) -> impl Iterator<Item = usize> + '_ {
        let (given, placed) = match self {
            Self::Given(views) => (views.as_slice(), 0),
            Self::Framed(_) => (&[][..], 1),
            Self::Round(orbit, _) => (&[][..], orbit.frames() as usize),
        };
        given.iter().map(|view| view.number).chain(0..placed)
    }

    /// Refuses several cameras, where `what` needs one.
    pub fn single(self, what: &str) -> Result<Self, Failure> {
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
        self.framed().map(|framed| framed.framing.up)
    }

    /// What is to be said of it.
    pub(super) fn note(&self) -> Option<String> {
        self.framed()?.note.clone()
    }

    fn framed(&self) -> Option<&Framed> {
        match self {
            Self::Given(_) => None,
            Self::Framed(framed) | Self::Round(_, framed) => Some(framed),
        }
    }

    /// The cameras, once the scene is known; says what of the scene is not in their pictures.
    pub(super) fn in_scene(self, scene: &Scene<'_>) -> Result<Vec<NamedView>, Failure> {
        self.note().into_iter().for_each(output::say_afterwards);
        let is_free = self.framed().is_some_and(|one| one.framing.holds_all());
        let views = match self {
            Self::Given(views) => return Ok(views),
            framed => framed.showing(&Visible::of(scene))?,
        };
        let first = views.first().filter(|_| is_free);
        let outside = first.and_then(|first| outside(&Outside::of(scene, &first.camera)));
        outside.into_iter().for_each(output::say_afterwards);
        Ok(views)
    }

    /// The cameras, once what is visible is known.
    pub(super) fn showing(self, visible: &Visible) -> Result<Vec<NamedView>, Failure> {
        match self {
            Self::Given(views) => Ok(views),
            Self::Framed(framed) => {
                let camera = framed.framing.camera(visible);
                framed.one(camera.map_err(Failure::usage)?)
            }
            Self::Round(orbit, framed) => {
                let cameras = framed.framing.orbit(orbit, visible);
                let cameras = cameras.map_err(Failure::usage)?;
                let first = cameras.first();
                first.inspect(|camera| say_up(camera, framed.framing.up));
                Ok(numbered("orbit", cameras))
            }
        }
    }

    /// The camera of a command that measures; one that frames the scene holds the box around it: the figures of the guide were
    /// taken with it.
    pub fn boxed(self, scene: &Scene<'_>) -> Result<Vec<NamedView>, Failure> {
        match self {
            Self::Framed(framed) => {
                let note = framed.note.clone();
                note.into_iter().for_each(output::say_afterwards);
                framed.one(framed.framing.boxed(&Bounds::of(scene))?)
            }
            other => other.in_scene(scene),
        }
    }
}

impl Framed {
    fn one(&self, camera: Camera) -> Result<Vec<NamedView>, Failure> {
        say_up(&camera, self.framing.up);
        Ok(vec![NamedView {
            number: 0,
            name: "framing".into(),
            camera,
        }])
    }
}

/// Says what is up in the picture of a camera that looks along the direction that was to be up.
pub(super) fn say_up(camera: &Camera, up: DVec3) {
    let turned = upright(camera.rotation.row(2), up);
    if turned != up {
        output::warn_once(format!(
            "note: the camera looks along what is up; up in the picture is {}",
            if turned == DVec3::Z { "z" } else { "-y" }
        ));
    }
}

/// The note on what of a scene reaches out of a picture, if anything does.
fn outside(counted: &Outside) -> Option<String> {
    let &Outside { visible, outside } = counted;
    let share = match 100.0 * outside as f64 / visible.max(1) as f64 {
        less if less < 0.01 => Cow::from("less than 0.01 %"),
        percent => format!("{percent:.2} %").into(),
    };
    (outside > 0).then(|| {
        format!(
            "note: {share} of the visible Gaussians, {} of {}, reach out of the picture; the camera leaves out strays and backgrounds, \
             which would make everything else small; --eye or --ortho HEIGHT shows more",
            grouped(outside),
            grouped(visible)
        )
    })
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
            "{flag} {wanted}: {} has {}, counted from 0, and none is called so{meant}",
            path.display(),
            output::counted(names.len() as u64, "camera")
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
mod tests;
