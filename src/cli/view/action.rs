//! The actions of a viewer, which keys, the mouse and scripts ask for.

use std::path::PathBuf;
use std::str::FromStr;

use clap::ValueEnum;
use glam::{DVec2, DVec3};
use rara::{Mode, Plane, Projection};

use super::viewpoint::Walk;
use crate::cli::values;

/// An action.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Action {
    /// Turn the view: what is in front goes right and down, degrees.
    Turn(DVec2),
    /// Move sideways: what is in the middle goes right and down, pixels.
    Shift(DVec2),
    /// Move nearer, in steps of the wheel.
    Zoom(f64),
    /// Move right, down and forward, world units.
    Go(DVec3),
    Walk(Walk),
    OtherWalk,
    Projection(Projection),
    OtherProjection,
    /// Go back to the start.
    Reset,
    /// Take the next camera of the file.
    NextView,
    Plane(PlaneAction),
    Mode(Mode),
    /// Write a screenshot to this file, or to the next free number.
    Screenshot(Option<PathBuf>),
    Resize((u32, u32)),
    Minimise,
    Restore,
    /// Print stage times and counts on stderr.
    Timings,
    Help,
    Quit,
}

/// An action on the held plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum PlaneAction {
    /// Switch all planes on or off.
    On(bool),
    Toggle,
    Flip,
    Next,
    /// Put it across an axis, through the middle.
    Align(DVec3),
    Set(Plane),
    /// Move it along its normal, world units.
    Go(f64),
    /// Move it along its normal, hundredths of the scene's radius.
    Step(f64),
    /// Let it follow the mouse, pixels.
    Drag(DVec2),
    /// Turn it: its normal goes right and down, degrees.
    Tilt(DVec2),
}

impl Action {
    /// True when the action only changes what the next frame shows, so that it need not wait for the last frame's
    /// numbers.
    pub(super) fn moves(&self) -> bool {
        matches!(
            self,
            Self::Turn(_) | Self::Shift(_) | Self::Zoom(_) | Self::Go(_) | Self::Plane(_)
        )
    }
}

impl FromStr for Action {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (verb, rest) = text
            .trim()
            .split_once(char::is_whitespace)
            .unwrap_or((text.trim(), ""));
        let rest = rest.trim();
        let action = match verb {
            "turn" => Self::Turn(pair(rest)?),
            "shift" => Self::Shift(pair(rest)?),
            "zoom" => Self::Zoom(number(rest)?),
            "move" => Self::Go(values::vec3(rest)?),
            "camera" => match rest {
                "orbit" => Self::Walk(Walk::Orbit),
                "fly" => Self::Walk(Walk::Fly),
                "perspective" => Self::Projection(Projection::Perspective),
                "orthographic" => Self::Projection(Projection::Orthographic),
                "reset" => Self::Reset,
                "next" => Self::NextView,
                other => {
                    return Err(format!(
                        "camera {other}: orbit, fly, perspective, orthographic, reset or next is possible"
                    ));
                }
            },
            "plane" => Self::Plane(plane(rest)?),
            "drag" => Self::Plane(PlaneAction::Drag(pair(rest)?)),
            "tilt" => Self::Plane(PlaneAction::Tilt(pair(rest)?)),
            "mode" => Self::Mode(
                Mode::from_str(rest, false)
                    .map_err(|_| format!("mode {rest}: none, hard, rara or exact is possible"))?,
            ),
            "screenshot" if rest.is_empty() => Self::Screenshot(None),
            "screenshot" => Self::Screenshot(Some(values::picture_path(rest)?)),
            "resize" => Self::Resize(values::size(rest)?),
            "minimise" | "restore" | "timings" | "help" | "quit" if !rest.is_empty() => {
                return Err(format!("{verb} takes nothing, found {rest}"));
            }
            "minimise" => Self::Minimise,
            "restore" => Self::Restore,
            "timings" => Self::Timings,
            "help" => Self::Help,
            "quit" => Self::Quit,
            other => {
                return Err(format!(
                    "\"{other}\" is no action; there are turn, shift, zoom, move, camera, plane, drag, tilt, mode, \
                     screenshot, resize, minimise, restore, timings, repeat and quit"
                ));
            }
        };
        Ok(action)
    }
}

fn plane(text: &str) -> Result<PlaneAction, String> {
    Ok(match text {
        "on" => PlaneAction::On(true),
        "off" => PlaneAction::On(false),
        "flip" => PlaneAction::Flip,
        "next" => PlaneAction::Next,
        "x" => PlaneAction::Align(DVec3::X),
        "y" => PlaneAction::Align(DVec3::Y),
        "z" => PlaneAction::Align(DVec3::Z),
        by if !by.contains(',') && by.starts_with(['+', '-']) => PlaneAction::Go(number(by)?),
        four if four.contains(',') => {
            let [x, y, z, d] = values::numbers::<4>(four)?;
            let plane = Plane::new(DVec3::new(x, y, z), d).map_err(|error| error.to_string())?;
            PlaneAction::Set(plane)
        }
        other => {
            return Err(format!(
                "plane {other}: on, off, flip, next, x, y, z, a step like +0.1, or nx,ny,nz,d is possible"
            ));
        }
    })
}

fn number(text: &str) -> Result<f64, String> {
    values::numbers::<1>(text).map(|[number]| number)
}

fn pair(text: &str) -> Result<DVec2, String> {
    values::numbers::<2>(text).map(DVec2::from_array)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Action {
        text.parse()
            .unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    #[test]
    fn what_is_written_is_what_is_done() {
        assert_eq!(parsed("plane +0.1"), Action::Plane(PlaneAction::Go(0.1)));
        assert_eq!(parsed("plane -2e-3"), Action::Plane(PlaneAction::Go(-2e-3)));
        assert_eq!(parsed("plane  off "), Action::Plane(PlaneAction::On(false)));
        assert_eq!(
            parsed("plane -1,0,0,2"),
            Action::Plane(PlaneAction::Set(Plane::new(-DVec3::X, 2.0).unwrap()))
        );
        assert_eq!(
            parsed("tilt -5,2.5"),
            Action::Plane(PlaneAction::Tilt(DVec2::new(-5.0, 2.5)))
        );
        assert_eq!(parsed("mode hard"), Action::Mode(Mode::Hard));
        assert_eq!(parsed("camera fly"), Action::Walk(Walk::Fly));
        assert_eq!(
            parsed("move 1,0,-2"),
            Action::Go(DVec3::new(1.0, 0.0, -2.0))
        );
        assert_eq!(parsed("screenshot"), Action::Screenshot(None));
        assert_eq!(
            parsed("screenshot a b.png"),
            Action::Screenshot(Some("a b.png".into()))
        );
        assert_eq!(parsed("resize 640x480"), Action::Resize((640, 480)));
        assert_eq!(parsed("\tquit"), Action::Quit);
    }

    #[test]
    fn what_means_nothing_is_refused_with_what_would() {
        for (text, says) in [
            ("jump", "there are turn"),
            ("plane 0.1", "a step like +0.1"),
            ("plane up", "on, off"),
            ("plane 0,0,0,1", "non-zero normal"),
            ("plane +", "'+' is not a finite number"),
            ("turn 5", "expected 2 numbers"),
            ("mode soft", "none, hard"),
            ("screenshot a.jpg", ".png"),
            ("resize 640", "like 1024x768"),
            ("quit now", "takes nothing"),
            ("", "is no action"),
        ] {
            let error = text.parse::<Action>().expect_err(text);
            assert!(error.contains(says), "{text}: {error}");
        }
    }

    #[test]
    fn only_moves_follow_each_other_without_waiting() {
        assert!(parsed("turn 1,1").moves() && parsed("plane +1").moves());
        assert!(!parsed("screenshot").moves() && !parsed("timings").moves());
    }
}
