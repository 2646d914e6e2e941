//! `--path`: a camera that moves, as one view for each of its places.

use std::path::PathBuf;

use clap::Args;

use super::camera::CameraArgs;
use super::failure::Failure;
use super::values;
use super::views::{Views, numbered};
use rara_shots::{Ease, Orbit, Spline};

/// Where the camera moves.
#[derive(Debug, Args)]
#[command(next_help_heading = "Paths, films and panoramas")]
pub(super) struct PathArgs {
    /// Move the camera: orbit[:TURNS], spline[:VIEW,...] or cameras[:VIEW,...]
    ///
    /// rara draws a picture for each position of the camera. orbit moves the camera to the right around the scene. If --eye
    /// and --target are given, it starts at --eye and goes around --target. spline moves the camera smoothly through cameras
    /// of a file; with ,closed at the end it returns to the first one. cameras draws the cameras of a file and none between
    /// them.
    #[arg(long, value_name = "PATH", value_parser = route, conflicts_with_all = ["camera", "view"])]
    path: Option<Route>,
    /// Number of pictures [default: 120; of a sweep 30]
    ///
    /// --path cameras has one for each camera.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: Option<u32>,
    /// Let the movement begin slowly (in), end slowly (out), or both
    ///
    /// The movement is that of the camera along --path, and that of a clip.
    #[arg(long, value_name = "HOW", value_parser = values::named::<Ease>(), default_value_t)]
    ease: Ease,
}

/// The most pictures of an orbit or a spline.
const MOST: u32 = 100_000;

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
            "the list of cameras in '{text}' has an empty place: write a camera between two commas and after the colon"
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

    /// True when each picture is of a camera of a file, as that has them.
    pub(super) fn is_as_in_file(&self) -> bool {
        matches!(self.path, None | Some(Route::Cameras(_)))
    }

    /// True when the cameras are those of a file, or between them.
    pub(super) fn is_of_file(&self) -> bool {
        matches!(self.path, Some(Route::Spline { .. } | Route::Cameras(_)))
    }

    /// The number of pictures that is asked for, if any is.
    pub(super) fn frames(&self) -> Option<u32> {
        self.frames
    }

    /// How what moves begins and ends.
    pub(super) fn ease(&self) -> Ease {
        self.ease
    }

    /// The cameras that the flags mean, so many of an orbit or a spline, also of files beside these scenes; reads their files.
    pub(super) fn views(
        &self,
        camera: &CameraArgs,
        scenes: &[PathBuf],
        frames: u32,
    ) -> Result<Views, Failure> {
        if matches!(self.path, Some(Route::Orbit(_) | Route::Spline { .. })) && frames > MOST {
            return Err(Failure::Usage(format!(
                "--frames {frames}: an orbit or a spline has {MOST} pictures at most"
            )));
        }
        match &self.path {
            None => camera.meant(scenes),
            Some(Route::Orbit(turns)) => {
                let orbit = Orbit::new(*turns, frames).ease(self.ease);
                camera.without_file("--path orbit")?;
                let begin = camera.meant(scenes)?;
                Ok(match (begin, camera.pivot()) {
                    (Views::Given(views), Some(round)) => {
                        let cameras = orbit.cameras(views[0].camera, round);
                        Views::Given(numbered("orbit", cameras))
                    }
                    (Views::Framed(framed), _) => Views::Round(orbit, framed),
                    (other, _) => other,
                })
            }
            Some(Route::Spline { views, closed }) => {
                let keys = camera.of_file(scenes, "--path spline", views.as_deref())?;
                let keys: Vec<_> = keys.iter().map(|view| view.camera).collect();
                let spline = Spline::through(&keys, *closed).map_err(|error| {
                    Failure::Usage(format!(
                        "--path spline: {error}; --size gives all pictures one size, and spline:0,3,5 chooses cameras"
                    ))
                })?;
                let cameras = spline.ease(self.ease).cameras(frames);
                Ok(Views::Given(numbered("spline", cameras)))
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

#[cfg(test)]
mod tests;
