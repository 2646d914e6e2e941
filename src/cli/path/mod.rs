//! `--path`: a camera that moves, as one view for each of its places.

mod orbit;
mod spline;

use std::path::PathBuf;

use clap::Args;

use super::camera::CameraArgs;
use super::failure::Failure;
use super::views::{NamedView, Orbit, Views};
use spline::Spline;

/// Where the camera moves.
#[derive(Debug, Args)]
#[command(next_help_heading = "Paths, films and panoramas")]
pub(super) struct PathArgs {
    /// Move the camera: orbit[:TURNS], spline[:VIEW,...] or cameras[:VIEW,...]
    ///
    /// Each place is a picture. orbit goes round the framed scene, or round --target from --eye, to the right.
    /// spline goes smoothly through cameras of a file, with ,closed at the end back to the first. cameras shows
    /// these themselves.
    #[arg(long, value_name = "PATH", value_parser = route, conflicts_with_all = ["camera", "view", "section"])]
    path: Option<Route>,
    /// Number of pictures of an orbit or a spline [default: 120]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    frames: Option<u32>,
}

/// Pictures of a path where nothing else is said: four seconds of a film.
const FRAMES: u32 = 120;

#[derive(Debug, Clone, PartialEq)]
enum Route {
    /// So many turns.
    Orbit(f64),
    /// Through these cameras of a file, or through all; back to the first where it is closed.
    Spline {
        views: Option<Vec<String>>,
        closed: bool,
    },
    /// These cameras of a file, or all.
    Cameras(Option<Vec<String>>),
}

fn route(text: &str) -> Result<Route, String> {
    let (kind, rest) = match text.split_once(':') {
        Some((kind, rest)) => (kind, Some(rest)),
        None => (text, None),
    };
    let listed = rest.map(|rest| rest.split(',').map(|one| one.trim().to_owned()));
    let mut views: Vec<String> = listed.into_iter().flatten().collect();
    if views.iter().any(String::is_empty) {
        return Err(format!(
            "nothing stands between two commas or behind the colon of '{text}'"
        ));
    }
    match kind {
        "orbit" => {
            let turns = rest.unwrap_or("1").trim().parse::<f64>();
            let turns = turns
                .ok()
                .filter(|turns| turns.is_finite() && *turns != 0.0);
            turns.map(Route::Orbit).ok_or_else(|| {
                "the turns of an orbit are a number, as in orbit:0.5; those below zero go to the left".into()
            })
        }
        "spline" => {
            let closed = views.last().is_some_and(|last| last == "closed");
            views.truncate(views.len() - usize::from(closed));
            let views = (!views.is_empty()).then_some(views);
            Ok(Route::Spline { views, closed })
        }
        "cameras" => Ok(Route::Cameras((!views.is_empty()).then_some(views))),
        _ => {
            Err("a path is orbit[:TURNS], spline[:VIEW,...][,closed] or cameras[:VIEW,...]".into())
        }
    }
}

impl PathArgs {
    /// True when the camera moves: a run of several frames, however many there are.
    pub(super) fn moves(&self) -> bool {
        self.path.is_some()
    }

    /// True when the cameras are those of a file, or between them.
    pub(super) fn is_of_file(&self) -> bool {
        matches!(self.path, Some(Route::Spline { .. } | Route::Cameras(_)))
    }

    /// The cameras that the flags mean, also of files beside these scenes; reads their files.
    pub(super) fn views(&self, camera: &CameraArgs, scenes: &[PathBuf]) -> Result<Views, Failure> {
        let frames = self.frames.unwrap_or(FRAMES);
        match &self.path {
            None => camera.meant(scenes),
            Some(Route::Orbit(turns)) => {
                let orbit = Orbit {
                    turns: *turns,
                    frames,
                };
                camera.without_file("--path orbit")?;
                let begin = camera.meant(scenes)?;
                Ok(match (begin, camera.pivot()) {
                    (Views::Given(views), Some(round)) => {
                        Views::Given(orbit.views(views[0].camera, round))
                    }
                    (Views::Framed(framed), _) => Views::Round(orbit, framed),
                    (other, _) => other,
                })
            }
            Some(Route::Spline { views, closed }) => {
                let keys = camera.of_file(scenes, "--path spline", views.as_deref())?;
                let spline = Spline::through(&keys, *closed).map_err(Failure::Usage)?;
                Ok(Views::Given(spline.views(frames)))
            }
            Some(Route::Cameras(views)) => {
                if self.frames.is_some() {
                    return Err(Failure::Usage(
                        "--path cameras has a picture for each camera: leave out --frames, or go through them by --path spline"
                            .into(),
                    ));
                }
                let views = camera.of_file(scenes, "--path cameras", views.as_deref())?;
                Ok(Views::Given(views))
            }
        }
    }
}

/// The views of a path's cameras, which are named for it and numbered from 0.
fn named(path: &str, cameras: impl Iterator<Item = rara::Camera>) -> Vec<NamedView> {
    let view = |(number, camera)| NamedView {
        number,
        name: format!("{path}_{number}"),
        camera,
    };
    cameras.enumerate().map(view).collect()
}

/// Where a picture stands on its path, from 0 to 1. One that is closed comes back to its begin by the picture that would be
/// next, so that a film of it repeats without a halt.
fn share(index: u32, frames: u32, closed: bool) -> f64 {
    let steps = if closed { frames } else { frames - 1 };
    f64::from(index) / f64::from(steps.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_read_as_they_are_written() {
        let views = |names: &[&str]| Some(names.iter().map(|name| name.to_string()).collect());
        assert_eq!(route("orbit"), Ok(Route::Orbit(1.0)));
        assert_eq!(route("orbit:-0.5"), Ok(Route::Orbit(-0.5)));
        for (text, names, closed) in [
            ("spline", None, false),
            ("spline:closed", None, true),
            ("spline:3,a.jpg", views(&["3", "a.jpg"]), false),
            ("spline:0,1,2,closed", views(&["0", "1", "2"]), true),
        ] {
            let views = names;
            assert_eq!(route(text), Ok(Route::Spline { views, closed }), "{text}");
        }
        assert_eq!(route("cameras:7"), Ok(Route::Cameras(views(&["7"]))));
        for wrong in [
            "",
            "circle",
            "orbit:",
            "orbit:x",
            "orbit:0",
            "orbit:inf",
            "spline:",
            "cameras:1,,2",
        ] {
            assert!(route(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn closed_paths_leave_their_begin_to_the_next_round() {
        assert_eq!(
            [0, 1, 3].map(|index| share(index, 4, true)),
            [0.0, 0.25, 0.75]
        );
        assert_eq!(
            [0, 1, 3].map(|index| share(index, 4, false)),
            [0.0, 1.0 / 3.0, 1.0]
        );
        assert_eq!((share(0, 1, true), share(0, 1, false)), (0.0, 0.0));
    }
}
