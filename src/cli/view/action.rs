//! The actions of a viewer, which keys, the mouse and scripts ask for.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use clap::ValueEnum;
use glam::{DVec2, DVec3};
use rara::{Mode, Plane, Projection, Shape};

use super::viewpoint::Walk;
use crate::values;

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
    Reset,
    /// Take the next camera of the file.
    NextView,
    /// Take the next of the named clips that were dropped in one file.
    NextClip,
    Held(GripAction),
    /// Show a layer or hide it; whichever it is not where that is not said.
    Layer(Which, Option<bool>),
    /// Choose the clip that is edited.
    Edit(Edit),
    /// Outline the shapes that clip, or not; whichever it is not where that is not said.
    Outline(Option<bool>),
    /// Show the list of keys, or not, likewise.
    Keys(Option<bool>),
    /// Show the clip's numbers, or not, likewise.
    Numbers(Option<bool>),
    /// Open a file as if it were dropped on the window.
    Drop(PathBuf),
    Mode(Mode),
    /// Write a screenshot to this file, or to the next free number.
    Screenshot(Option<PathBuf>),
    Resize((u32, u32)),
    Minimise,
    Restore,
    /// Print stage times and counts on stderr.
    Timings,
    /// Print the flags that draw what is shown.
    Flags,
    Help,
    Quit,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Which {
    /// The number of the layer from 1, as keys have it.
    Number(usize),
    /// The text of a script: a layer's name or, where none has it, a number from 1.
    Typed(String),
}

impl fmt::Display for Which {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(to),
            Self::Typed(text) => text.fmt(to),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Edit {
    /// The next one: of the layers after that of the frame.
    Next,
    Frame,
    /// A layer's own.
    Layer(Which),
    /// The layer whose clip is edited has none of its own any more.
    Release,
}

/// An action on the clip that is edited, or on its held shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum GripAction {
    /// Switch the clip on or off.
    On(bool),
    Toggle,
    Flip,
    Next,
    /// Turn it to an axis; a plane also goes through the middle of the scene.
    Align(DVec3),
    Set(Shape),
    /// Move it along its normal, or away from the eye, world units.
    Go(f64),
    /// The same by hundredths of the scene's radius.
    Step(f64),
    /// Let it follow the mouse, pixels.
    Drag(DVec2),
    /// Turn it: what of it points towards the eye goes right and down, degrees.
    Tilt(DVec2),
    /// Scale it by a factor.
    Scale(f64),
}

impl Action {
    /// True when the action is one on the scene that is shown.
    pub(super) fn needs_a_scene(&self) -> bool {
        !matches!(
            self,
            Self::Keys(_)
                | Self::Numbers(_)
                | Self::Drop(_)
                | Self::Resize(_)
                | Self::Minimise
                | Self::Restore
                | Self::Help
                | Self::Quit
        )
    }

    /// True when the action only changes what the next frame shows, so that it need not wait for the last frame's
    /// numbers.
    pub(super) fn moves(&self) -> bool {
        matches!(
            self,
            Self::Turn(_) | Self::Shift(_) | Self::Zoom(_) | Self::Go(_) | Self::Held(_)
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
            "clip" if rest == "next" => Self::NextClip,
            "clip" => return Err(format!("clip {rest}: next is possible")),
            "plane" | "shape" => Self::Held(held(verb, rest)?),
            "drag" => Self::Held(GripAction::Drag(pair(rest)?)),
            "tilt" => Self::Held(GripAction::Tilt(pair(rest)?)),
            "scale" => Self::Held(GripAction::Scale(factor(rest)?)),
            "layer" => layer(rest)?,
            "edit" => Self::Edit(match rest {
                "next" => Edit::Next,
                "frame" => Edit::Frame,
                "release" => Edit::Release,
                "" => return Err("edit takes next, frame, release, or a layer".into()),
                which => Edit::Layer(Which::Typed(which.into())),
            }),
            "outline" | "keys" | "numbers" => {
                let on = switch(rest);
                let on = Some(on.ok_or_else(|| format!("{verb} {rest}: on or off is possible"))?);
                match verb {
                    "outline" => Self::Outline(on),
                    "keys" => Self::Keys(on),
                    _ => Self::Numbers(on),
                }
            }
            "drop" if rest.is_empty() => return Err("drop takes a file".into()),
            "drop" => Self::Drop(rest.into()),
            "mode" => Self::Mode(
                Mode::from_str(rest, false)
                    .map_err(|_| format!("mode {rest}: none, hard, rara or exact is possible"))?,
            ),
            "screenshot" if rest.is_empty() => Self::Screenshot(None),
            "screenshot" => Self::Screenshot(Some(values::picture_path(rest.into())?)),
            "resize" => Self::Resize(values::size(rest)?),
            "minimise" | "restore" | "timings" | "flags" | "help" | "quit" if !rest.is_empty() => {
                return Err(format!("{verb} takes nothing, found {rest}"));
            }
            "minimise" => Self::Minimise,
            "restore" => Self::Restore,
            "timings" => Self::Timings,
            "flags" => Self::Flags,
            "help" => Self::Help,
            "quit" => Self::Quit,
            other => {
                return Err(format!(
                    "\"{other}\" is no action; there are turn, shift, zoom, move, camera, shape, plane, drag, tilt, \
                     scale, layer, edit, outline, keys, numbers, drop, mode, screenshot, resize, minimise, restore, \
                     timings, flags, repeat and quit"
                ));
            }
        };
        Ok(action)
    }
}

/// What follows `shape`, or `plane`.
fn held(verb: &str, text: &str) -> Result<GripAction, String> {
    if let Some(on) = switch(text) {
        return Ok(GripAction::On(on));
    }
    Ok(match text {
        "flip" => GripAction::Flip,
        "next" => GripAction::Next,
        "x" => GripAction::Align(DVec3::X),
        "y" => GripAction::Align(DVec3::Y),
        "z" => GripAction::Align(DVec3::Z),
        by if !by.contains(',') && by.starts_with(['+', '-']) => GripAction::Go(number(by)?),
        shape if shape.contains(':') => {
            let shape = shape.parse::<Shape>().map_err(|error| error.to_string())?;
            GripAction::Set(shape)
        }
        four if four.contains(',') => {
            let [x, y, z, d] = values::numbers::<4>(four)?;
            let plane = Plane::new(DVec3::new(x, y, z), d).map_err(|error| error.to_string())?;
            GripAction::Set(plane.into())
        }
        other => {
            return Err(format!(
                "{verb} {other}: on, off, flip, next, x, y, z, a step like +0.1, a shape like sphere:0,0,0,1, or a plane's \
                 nx,ny,nz,d is possible"
            ));
        }
    })
}

/// What follows `layer`: a name or number, and perhaps on or off.
fn layer(text: &str) -> Result<Action, String> {
    let last = text.rsplit_once(char::is_whitespace);
    let (which, visible) = match last.and_then(|(which, word)| Some((which, switch(word)?))) {
        Some((which, visible)) => (which.trim(), Some(visible)),
        None => (text, None),
    };
    match which {
        "" | "on" | "off" => {
            Err("layer takes a layer's name or its number from 1, and on or off".into())
        }
        which => Ok(Action::Layer(Which::Typed(which.into()), visible)),
    }
}

fn switch(text: &str) -> Option<bool> {
    match text {
        "on" => Some(true),
        "off" => Some(false),
        _ => None,
    }
}

fn factor(text: &str) -> Result<f64, String> {
    match number(text)? {
        factor if factor > 0.0 => Ok(factor),
        factor => Err(format!("scale {factor}: a factor above zero is possible")),
    }
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
        assert_eq!(parsed("plane +0.1"), Action::Held(GripAction::Go(0.1)));
        assert_eq!(parsed("plane -2e-3"), Action::Held(GripAction::Go(-2e-3)));
        assert_eq!(parsed("plane  off "), Action::Held(GripAction::On(false)));
        assert_eq!(
            parsed("plane -1,0,0,2"),
            Action::Held(GripAction::Set(Plane::new(-DVec3::X, 2.0).unwrap().into()))
        );
        assert_eq!(
            parsed("tilt -5,2.5"),
            Action::Held(GripAction::Tilt(DVec2::new(-5.0, 2.5)))
        );
        assert_eq!(
            parsed("shape !sphere:0,0,0,1"),
            Action::Held(GripAction::Set("!sphere:0,0,0,1".parse().unwrap()))
        );
        assert_eq!(parsed("scale 1.5"), Action::Held(GripAction::Scale(1.5)));
        let which = |text: &str| Which::Typed(text.into());
        assert_eq!(parsed("layer 2"), Action::Layer(which("2"), None));
        assert_eq!(
            parsed("layer left lung off"),
            Action::Layer(which("left lung"), Some(false))
        );
        assert_eq!(parsed("edit next"), Action::Edit(Edit::Next));
        assert_eq!(
            parsed("edit skin"),
            Action::Edit(Edit::Layer(which("skin")))
        );
        assert_eq!(parsed("outline off"), Action::Outline(Some(false)));
        assert_eq!(parsed("keys on"), Action::Keys(Some(true)));
        assert_eq!(parsed("numbers off"), Action::Numbers(Some(false)));
        assert_eq!(parsed("drop a b.ply"), Action::Drop("a b.ply".into()));
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
            ("shape up", "sphere:0,0,0,1"),
            ("shape torus:1", "not a shape"),
            ("scale 0", "above zero"),
            ("scale -2", "above zero"),
            ("layer", "number from 1"),
            ("layer  off", "number from 1"),
            ("edit", "next, frame"),
            ("outline", "on or off"),
            ("keys 1", "keys 1: on or off"),
            ("drop", "takes a file"),
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
