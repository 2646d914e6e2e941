//! Keys and mouse to actions; `KEYS` lists them for people.

use std::collections::HashSet;

use glam::{DVec2, DVec3};
use rara::Mode;
use winit::event::{ElementState, MouseButton, MouseScrollDelta};
use winit::keyboard::{Key, KeyCode, ModifiersState, NamedKey, PhysicalKey};

use super::action::{Action, Edit, GripAction, Kind, Step, Which};

/// The list of keys, which the key H shows.
pub const KEYS: &str = "\
Mouse:
  left drag                    turn the view
  middle or Shift+left drag    move sideways
  wheel                        nearer, farther; in fly mode faster, slower
  right drag                   move the held shape; a plane or slab moves along its normal
  Shift+right drag             turn the held shape about its middle
  Shift+wheel, J, K            make the held shape smaller or larger
  Ctrl+left drag               keep what the outline holds; with Shift what it does not hold
Keys:
  Tab                          orbit about the scene, or fly
  W A S D Q E                  forward, left, back, right, down, up (Shift: slowly)
  G                            take hold of the next shape
  arrows                       turn the view; with Shift the held shape
  +, -                         nearer, farther
  O                            orthographic, or in perspective
  Shift+X, Shift+Y, Shift+Z    let this axis point up in the picture; once more, down
  R, N                         back to the start; the next camera of --view all
  0 1 2 3                      mode none, hard, rara, exact
  P, I                         turn the clip on or off; keep the other side of the held shape
  X, Y, Z                      turn the held shape to this axis; a plane also moves to mid-scene
  Page Up, Page Down           move the held shape along its normal or from the eye (Shift: a tenth)
  4 5 6                        put a plane, a box or a sphere in the held shape's place
  7, 8, 9                      a slice on the held shape's faces; a line, a tint along all cut faces
  Backspace or Ctrl+Z          take back the last change of a clip
  B                            outlines of the shapes on or off
  F1 to F9                     layer 1 to 9 on or off (Shift: next opacity; Ctrl: next tint)
  L                            edit the next layer's own clip; after the last, the clip of all
  U                            remove the edited layer's own clip
  M                            show or hide the mode and the clip's numbers
  C or F12                     screenshot
  F, T                         print the flags that draw this picture; times and counts of the stages
  H, Esc                       show or hide this list; quit
Files dropped on the window:
  a scene                      in place of this one; several are its layers
  a clip (.json)               replaces the edited clip; V: the next named clip of the file
  cameras (.json)              the key N chooses the next one";

/// How many degrees an arrow key turns.
const ARROW: f64 = 5.0;
/// How much larger a shape becomes by a step of the wheel, or by a key.
const LARGER: f64 = 1.05;

/// The keys and buttons that are held down, and where the mouse is.
#[derive(Debug, Default)]
pub(super) struct Input {
    modifiers: ModifiersState,
    buttons: HashSet<MouseButton>,
    cursor: Option<DVec2>,
    /// Keys that move for as long as they are held.
    held: HashSet<KeyCode>,
    /// True while an outline is drawn.
    draws: bool,
}

impl Input {
    pub(super) fn modifiers(&mut self, modifiers: ModifiersState) {
        self.modifiers = modifiers;
    }

    /// Handles a key that goes down, or up, or repeats.
    pub(super) fn key(
        &mut self,
        logical: &Key,
        physical: PhysicalKey,
        state: ElementState,
        repeat: bool,
    ) -> Option<Action> {
        if let PhysicalKey::Code(code) = physical
            && direction(code) != DVec3::ZERO
        {
            // The place of the key counts, not its label.
            match state {
                ElementState::Pressed if !self.modifiers.control_key() => self.held.insert(code),
                _ => self.held.remove(&code),
            };
            return None;
        }
        if state == ElementState::Released {
            return None;
        }
        let shift = self.modifiers.shift_key();
        let action = match logical {
            Key::Named(key) => named(*key, self.modifiers)?,
            Key::Character(text) if self.modifiers.control_key() => {
                match &text.to_lowercase()[..] {
                    "z" => Action::Undo,
                    _ => return None,
                }
            }
            Key::Character(text) => letter(text, shift)?,
            _ => return None,
        };
        // A key that is held down goes on moving, but does not switch to and fro.
        let repeats = action.moves()
            && !matches!(
                action,
                Action::Held(
                    GripAction::Toggle
                        | GripAction::Flip
                        | GripAction::Next
                        | GripAction::Become(_)
                )
            );
        (repeats || !repeat).then_some(action)
    }

    /// Handles a mouse button that goes down or up.
    pub(super) fn button(&mut self, button: MouseButton, state: ElementState) -> Option<Action> {
        match state {
            ElementState::Pressed => self.buttons.insert(button),
            ElementState::Released => self.buttons.remove(&button),
        };
        let ends = button == MouseButton::Left && std::mem::take(&mut self.draws);
        ends.then(|| Action::Drawn(!self.modifiers.shift_key()))
    }

    /// Handles a move of the mouse, in a window of this height.
    pub(super) fn cursor(&mut self, to: DVec2, height: u32) -> Option<Action> {
        let by = to - self.cursor.replace(to)?;
        // A drag over the whole window is half a turn.
        let degrees = by * 180.0 / f64::from(height.max(1));
        let down = |button| self.buttons.contains(&button);
        let shift = self.modifiers.shift_key();
        if down(MouseButton::Right) {
            let action = if shift {
                GripAction::Tilt(degrees)
            } else {
                GripAction::Drag(by)
            };
            return Some(Action::Held(action));
        }
        if down(MouseButton::Left) && (self.draws || self.modifiers.control_key()) {
            self.draws = true;
            return Some(Action::Draw(to));
        }
        if down(MouseButton::Middle) || down(MouseButton::Left) && shift {
            return Some(Action::Shift(by));
        }
        down(MouseButton::Left).then_some(Action::Turn(degrees))
    }

    pub(super) fn wheel(&self, delta: MouseScrollDelta) -> Action {
        let (across, lines) = match delta {
            MouseScrollDelta::LineDelta(across, lines) => (across.into(), lines.into()),
            // A touchpad reports pixels, about so many for a line of text.
            MouseScrollDelta::PixelDelta(pixels) => (pixels.x / 20.0, pixels.y / 20.0),
        };
        if self.modifiers.shift_key() {
            // Some systems turn the wheel with Shift into one that goes sideways.
            let steps = if lines == 0.0 { across } else { lines };
            return Action::Held(GripAction::Scale(LARGER.powf(steps)));
        }
        Action::Zoom(lines)
    }

    /// Releases everything, since another window has the keyboard.
    pub(super) fn release(&mut self) {
        *self = Self::default();
    }

    /// The direction that the held keys give: right, down, forward.
    pub(super) fn direction(&self) -> DVec3 {
        let sum: DVec3 = self.held.iter().map(|code| direction(*code)).sum();
        let slowly = if self.modifiers.shift_key() { 0.2 } else { 1.0 };
        sum.normalize_or_zero() * slowly
    }
}

fn direction(code: KeyCode) -> DVec3 {
    match code {
        KeyCode::KeyW => DVec3::Z,
        KeyCode::KeyS => DVec3::NEG_Z,
        KeyCode::KeyD => DVec3::X,
        KeyCode::KeyA => DVec3::NEG_X,
        KeyCode::KeyQ => DVec3::Y,
        KeyCode::KeyE => DVec3::NEG_Y,
        _ => DVec3::ZERO,
    }
}

fn named(key: NamedKey, modifiers: ModifiersState) -> Option<Action> {
    let shift = modifiers.shift_key();
    let arrow = |x: f64, y: f64| {
        let degrees = ARROW * DVec2::new(x, y);
        if shift {
            Action::Held(GripAction::Tilt(degrees))
        } else {
            Action::Turn(degrees)
        }
    };
    let step = if shift { 0.1 } else { 1.0 };
    let layer = |number| {
        let which = Which::Number(number);
        match (modifiers.control_key(), shift) {
            (true, _) => Action::LayerTint(which, Step::Next),
            (false, true) => Action::LayerOpacity(which, Step::Next),
            (false, false) => Action::Layer(which, None),
        }
    };
    Some(match key {
        NamedKey::ArrowLeft => arrow(-1.0, 0.0),
        NamedKey::ArrowRight => arrow(1.0, 0.0),
        NamedKey::ArrowUp => arrow(0.0, -1.0),
        NamedKey::ArrowDown => arrow(0.0, 1.0),
        NamedKey::PageUp => Action::Held(GripAction::Step(step)),
        NamedKey::PageDown => Action::Held(GripAction::Step(-step)),
        NamedKey::Tab => Action::OtherWalk,
        NamedKey::F1 => layer(1),
        NamedKey::F2 => layer(2),
        NamedKey::F3 => layer(3),
        NamedKey::F4 => layer(4),
        NamedKey::F5 => layer(5),
        NamedKey::F6 => layer(6),
        NamedKey::F7 => layer(7),
        NamedKey::F8 => layer(8),
        NamedKey::F9 => layer(9),
        NamedKey::F12 => Action::Screenshot(None),
        NamedKey::Backspace => Action::Undo,
        NamedKey::Escape => Action::Quit,
        _ => return None,
    })
}

fn letter(text: &str, shift: bool) -> Option<Action> {
    let held = Action::Held;
    let axis = |axis| match shift {
        true => Action::UpAxis(axis),
        false => held(GripAction::Align(axis)),
    };
    Some(match text.to_lowercase().as_str() {
        "0" => Action::Mode(Mode::None),
        "1" => Action::Mode(Mode::Hard),
        "2" => Action::Mode(Mode::Rara),
        "3" => Action::Mode(Mode::Exact),
        "4" => held(GripAction::Become(Kind::Plane)),
        "5" => held(GripAction::Become(Kind::Box)),
        "6" => held(GripAction::Become(Kind::Sphere)),
        "7" => Action::Slice(None),
        "8" => Action::Edge(None),
        "9" => Action::Rim(None),
        "+" | "=" => Action::Zoom(1.0),
        "-" => Action::Zoom(-1.0),
        "p" => held(GripAction::Toggle),
        "i" => held(GripAction::Flip),
        "g" => held(GripAction::Next),
        "x" => axis(DVec3::X),
        "y" => axis(DVec3::Y),
        "z" => axis(DVec3::Z),
        "j" => held(GripAction::Scale(1.0 / LARGER)),
        "k" => held(GripAction::Scale(LARGER)),
        "b" => Action::Outline(None),
        "m" => Action::Numbers(None),
        "l" => Action::Edit(Edit::Next),
        "u" => Action::Edit(Edit::Release),
        "f" => Action::Flags,
        "o" => Action::OtherProjection,
        "r" => Action::Reset,
        "n" => Action::NextView,
        "v" => Action::NextClip,
        "c" => Action::Screenshot(None),
        "t" => Action::Timings,
        "h" => Action::Keys(None),
        _ => return None,
    })
}

#[cfg(test)]
mod tests;
