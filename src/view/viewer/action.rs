//! The actions of a viewer, which keys, the mouse and scripts ask for.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use glam::{DVec2, DVec3};
use rara::clip::{Lasso, numbers_of};
use rara::{Mode, Plane, Projection, Shape};

use super::viewpoint::Walk;
use rara::scene::layers::Tint;
use rara_base::value::share;
use rara_scene::direction;
use rara_scene::picture::size;

/// An action of a viewer. Its text is that of a script's step.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// Turn the view: what is in front goes right and down, degrees.
    Turn(DVec2),
    /// Move sideways: what is in the middle goes right and down, pixels.
    Shift(DVec2),
    /// Move nearer, in steps of the wheel.
    Zoom(f64),
    /// Move right, down and forward, world units.
    Go(DVec3),
    /// Orbit about the scene, or fly.
    Walk(Walk),
    /// Orbit instead of flying, or fly instead of orbiting.
    OtherWalk,
    /// Look at the scene by this projection.
    Projection(Projection),
    /// Look at it by the other projection.
    OtherProjection,
    /// Make this direction up in the picture.
    Up(DVec3),
    /// Make this axis up, or the opposite where the axis is up already.
    UpAxis(DVec3),
    /// Go back to the camera at the start.
    Reset,
    /// Take the next camera of the file.
    NextView,
    /// Take the next of the named clips that were dropped in one file.
    NextClip,
    /// Do this with the clip that is edited.
    Held(GripAction),
    /// Take back the last change of a clip.
    Undo,
    /// Go on with an outline in the picture, px.
    Draw(DVec2),
    /// Keep of what the edited clip keeps what the outline that was drawn holds, or what it does not hold.
    Drawn(bool),
    /// The same of a polygon and its holes, px.
    Lasso(Lasso),
    /// Show a layer or hide it; whichever it is not where that is not said.
    Layer(Which, Option<bool>),
    /// Draw a layer with this share of its opacity, 0 to 1; the next is 100, 50, 25 or 10 %.
    LayerOpacity(Which, Step<f32>),
    /// Mix a colour into a layer, or none; the next is one of a few.
    LayerTint(Which, Step<Option<Tint>>),
    /// Choose the clip that is edited.
    Edit(Edit),
    /// Outline the shapes that clip, or not; whichever it is not where that is not said.
    Outline(Option<bool>),
    /// Show the slice on the faces of the held shape, or not, likewise.
    Slice(Option<bool>),
    /// Draw a line around cut faces, or not, likewise.
    Edge(Option<bool>),
    /// Tint cut faces along their edges, or not, likewise.
    Rim(Option<bool>),
    /// Show the list of keys, or not, likewise.
    Keys(Option<bool>),
    /// Show the clip's numbers, or not, likewise.
    Numbers(Option<bool>),
    /// Open a file as if it were dropped on the window.
    Drop(PathBuf),
    /// Draw by this mode.
    Mode(Mode),
    /// Write a screenshot to this file, or to one of the program's choice.
    Screenshot(Option<PathBuf>),
    /// Give the window this size, px.
    Resize((u32, u32)),
    /// Minimise the window.
    Minimise,
    /// Bring a minimised window back.
    Restore,
    /// Have the program print the times of the stages, and counts.
    Timings,
    /// Have the program print what draws what is shown.
    Flags,
    /// Print the keys.
    Help,
    /// Close the window.
    Quit,
}

/// The layers that are meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Which {
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

/// A value, or the next of those that a key steps through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step<T> {
    /// The next one.
    Next,
    /// This one.
    To(T),
}

/// The clip that is edited from now on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Edit {
    /// The next one: of the layers after that of the frame.
    Next,
    /// The frame's.
    Frame,
    /// A layer's own.
    Layer(Which),
    /// The layer whose clip is edited has none of its own any more.
    Release,
}

/// The shapes that keys put into the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A plane that faces the camera.
    Plane,
    /// A box.
    Box,
    /// A sphere.
    Sphere,
}

/// An action on the clip that is edited, or on its held shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GripAction {
    /// Switch the clip on or off.
    On(bool),
    /// Switch it on or off, whichever it is not.
    Toggle,
    /// Keep the other side of the held shape.
    Flip,
    /// Hold the next shape.
    Next,
    /// Turn it to an axis; a plane also goes through the middle of the scene.
    Align(DVec3),
    /// Put this shape in its place.
    Set(Shape),
    /// Put a shape of this kind in its place, where it is, as large as half the scene.
    Become(Kind),
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
            "move" => Self::Go(numbers(rest).map(DVec3::from_array)?),
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
            "up" => Self::Up(direction(rest).map_err(|error| {
                format!("up {rest}: {error}; x, -x, y, -y, z, -z or X,Y,Z is possible")
            })?),
            "lasso" => Self::Lasso(
                rest.parse()
                    .map_err(|error| format!("lasso {rest}: {error}"))?,
            ),
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
            "outline" | "slice" | "edge" | "rim" | "keys" | "numbers" => {
                let on = switch(rest);
                let on = Some(on.ok_or_else(|| format!("{verb} {rest}: on or off is possible"))?);
                match verb {
                    "outline" => Self::Outline(on),
                    "slice" => Self::Slice(on),
                    "edge" => Self::Edge(on),
                    "rim" => Self::Rim(on),
                    "keys" => Self::Keys(on),
                    _ => Self::Numbers(on),
                }
            }
            "drop" if rest.is_empty() => return Err("drop takes a file".into()),
            "drop" => Self::Drop(rest.into()),
            "mode" => {
                let mode = rest.parse::<Mode>();
                Self::Mode(mode.map_err(|error| error.to_string())?)
            }
            "screenshot" if rest.is_empty() => Self::Screenshot(None),
            "screenshot" => Self::Screenshot(Some(rest.into())),
            "resize" => Self::Resize(size(rest)?),
            "minimise" | "restore" | "timings" | "flags" | "help" | "undo" | "quit"
                if !rest.is_empty() =>
            {
                return Err(format!("{verb} takes nothing, found {rest}"));
            }
            "minimise" => Self::Minimise,
            "restore" => Self::Restore,
            "timings" => Self::Timings,
            "flags" => Self::Flags,
            "help" => Self::Help,
            "undo" => Self::Undo,
            "quit" => Self::Quit,
            other => {
                return Err(format!(
                    "\"{other}\" is not an action; there are turn, shift, zoom, move, camera, clip, up, shape, plane, drag, tilt, \
                     scale, lasso, undo, layer, edit, outline, slice, edge, rim, keys, numbers, drop, mode, screenshot, resize, minimise, \
                     restore, timings, flags, repeat and quit"
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
        "plane" => GripAction::Become(Kind::Plane),
        "box" => GripAction::Become(Kind::Box),
        "sphere" => GripAction::Become(Kind::Sphere),
        by if !by.contains(',') && by.starts_with(['+', '-']) => GripAction::Go(number(by)?),
        shape if shape.contains(':') => {
            let shape = shape.parse::<Shape>().map_err(|error| error.to_string())?;
            GripAction::Set(shape)
        }
        four if four.contains(',') => {
            let [x, y, z, d] = numbers::<4>(four)?;
            let plane = Plane::new(DVec3::new(x, y, z), d).map_err(|error| error.to_string())?;
            GripAction::Set(plane.into())
        }
        other => {
            return Err(format!(
                "{verb} {other}: on, off, flip, next, x, y, z, plane, box, sphere, a step like +0.1, a shape like sphere:0,0,0,1, or a plane's \
                 nx,ny,nz,d is possible"
            ));
        }
    })
}

/// The layers that follow `layer`.
fn which(text: &str) -> Result<Which, String> {
    match text.trim() {
        "" | "on" | "off" => Err(
            "layer takes a layer's name or its number from 1, and on, off, a share such as 40%, or tint and a colour".into(),
        ),
        which => Ok(Which::Typed(which.into())),
    }
}

/// What follows `layer`: a name or number, and perhaps what becomes of it.
fn layer(text: &str) -> Result<Action, String> {
    let Some((before, word)) = text.rsplit_once(char::is_whitespace) else {
        return Ok(Action::Layer(which(text)?, None));
    };
    if let Some(visible) = switch(word) {
        return Ok(Action::Layer(which(before)?, Some(visible)));
    }
    if let Some((before, "tint")) = before.trim_end().rsplit_once(char::is_whitespace) {
        let tint = match word {
            "none" => None,
            colour => {
                let tint = colour.parse::<Tint>();
                Some(tint.map_err(|error| format!("layer {text}: {error}"))?)
            }
        };
        return Ok(Action::LayerTint(which(before)?, Step::To(tint)));
    }
    if word.ends_with('%') {
        let opacity = share(word).map_err(|error| format!("layer {text}: {error}"))?;
        return Ok(Action::LayerOpacity(
            which(before)?,
            Step::To(opacity as f32),
        ));
    }
    Ok(Action::Layer(which(text)?, None))
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

/// `COUNT` numbers between commas.
fn numbers<const COUNT: usize>(text: &str) -> Result<[f64; COUNT], String> {
    numbers_of(text).map_err(|error| error.to_string())
}

fn number(text: &str) -> Result<f64, String> {
    numbers::<1>(text).map(|[number]| number)
}

fn pair(text: &str) -> Result<DVec2, String> {
    numbers::<2>(text).map(DVec2::from_array)
}

#[cfg(test)]
mod tests;
