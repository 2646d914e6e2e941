//! Keys and mouse to actions; `KEYS` lists them for people.

use std::collections::HashSet;

use glam::{DVec2, DVec3};
use rara::Mode;
use winit::event::{ElementState, MouseButton, MouseScrollDelta};
use winit::keyboard::{Key, KeyCode, ModifiersState, NamedKey, PhysicalKey};

use super::action::{Action, Edit, GripAction, Which};

/// The text that `--help` prints and the key H shows.
pub(super) const KEYS: &str = "\
Mouse:
  left drag                    turn the view
  middle or Shift+left drag    move sideways
  wheel                        nearer, farther; in fly mode faster, slower
  right drag                   the held shape; a plane or slab along its normal
  Shift+right drag             turn the held shape about its middle
  Shift+wheel                  the held shape larger, smaller
Keys:
  Tab                          orbit about the scene, or fly
  W A S D Q E                  forward, left, back, right, down, up (Shift: slowly)
  arrows                       turn the view; with Shift the held shape
  + -                          nearer, farther
  O                            orthographic, or in perspective
  R, N                         back to the start; the next camera of --view all
  0 1 2 3                      mode none, hard, rara, exact
  P, I                         the clip on or off; the other side of the held shape
  X Y Z                        the held shape along an axis; a plane across it, through the middle
  Page Up, Page Down           the held shape along its normal or away from the eye (Shift: a tenth)
  J K                          the held shape smaller, larger
  G                            take hold of the next shape
  B                            outlines of the shapes on or off
  F1 to F9                     layer 1 to 9 on or off
  L                            edit the next layer's clip, after the last the frame's again
  U                            the edited layer has no clip of its own any more
  M                            the mode and the clip's numbers on the screen, or not
  C or F12                     screenshot
  F                            the flags that draw this, on the terminal
  T                            stage times and counts on the terminal
  H                            this list, or not
  Esc                          quit
Files dropped on the window:
  a scene                      in place of this one; several are its layers
  a clip (.json)               in place of the clip that is edited; V takes the next of several with names
  cameras (.json)              to choose from by N";

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
            Key::Named(key) => named(*key, shift)?,
            Key::Character(text) => letter(text)?,
            _ => return None,
        };
        // A key that is held down goes on moving, but does not switch to and fro.
        let repeats = action.moves()
            && !matches!(
                action,
                Action::Held(GripAction::Toggle | GripAction::Flip | GripAction::Next)
            );
        (repeats || !repeat).then_some(action)
    }

    /// Handles a mouse button that goes down or up.
    pub(super) fn button(&mut self, button: MouseButton, state: ElementState) {
        match state {
            ElementState::Pressed => self.buttons.insert(button),
            ElementState::Released => self.buttons.remove(&button),
        };
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

fn named(key: NamedKey, shift: bool) -> Option<Action> {
    let arrow = |x: f64, y: f64| {
        let degrees = ARROW * DVec2::new(x, y);
        if shift {
            Action::Held(GripAction::Tilt(degrees))
        } else {
            Action::Turn(degrees)
        }
    };
    let step = if shift { 0.1 } else { 1.0 };
    let layer = |number| Action::Layer(Which::Number(number), None);
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
        NamedKey::Escape => Action::Quit,
        _ => return None,
    })
}

fn letter(text: &str) -> Option<Action> {
    let held = Action::Held;
    Some(match text.to_lowercase().as_str() {
        "0" => Action::Mode(Mode::None),
        "1" => Action::Mode(Mode::Hard),
        "2" => Action::Mode(Mode::Rara),
        "3" => Action::Mode(Mode::Exact),
        "+" | "=" => Action::Zoom(1.0),
        "-" => Action::Zoom(-1.0),
        "p" => held(GripAction::Toggle),
        "i" => held(GripAction::Flip),
        "g" => held(GripAction::Next),
        "x" => held(GripAction::Align(DVec3::X)),
        "y" => held(GripAction::Align(DVec3::Y)),
        "z" => held(GripAction::Align(DVec3::Z)),
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
mod tests {
    use super::*;
    use ElementState::{Pressed, Released};

    fn press(input: &mut Input, text: &str, repeat: bool) -> Option<Action> {
        let key = Key::Character(text.into());
        input.key(&key, PhysicalKey::Code(KeyCode::F20), Pressed, repeat)
    }

    #[test]
    fn drags_mean_what_button_and_modifier_say() {
        let at = |x, y| DVec2::new(x, y);
        let mut input = Input::default();
        assert_eq!(input.cursor(at(10.0, 10.0), 360), None);
        assert_eq!(input.cursor(at(20.0, 10.0), 360), None, "no button");
        input.button(MouseButton::Left, Pressed);
        let turn = Action::Turn(at(5.0, -2.5));
        assert_eq!(input.cursor(at(30.0, 5.0), 360), Some(turn));
        input.modifiers(ModifiersState::SHIFT);
        assert_eq!(
            input.cursor(at(31.0, 5.0), 360),
            Some(Action::Shift(at(1.0, 0.0)))
        );
        input.button(MouseButton::Left, Released);
        input.button(MouseButton::Right, Pressed);
        let tilt = Action::Held(GripAction::Tilt(at(0.0, 1.0)));
        assert_eq!(input.cursor(at(31.0, 7.0), 360), Some(tilt));
        input.modifiers(ModifiersState::empty());
        let drag = Action::Held(GripAction::Drag(at(0.0, -3.0)));
        assert_eq!(input.cursor(at(31.0, 4.0), 360), Some(drag));
    }

    #[test]
    fn switches_do_not_repeat_but_moves_do() {
        let mut input = Input::default();
        let toggle = Some(Action::Held(GripAction::Toggle));
        assert_eq!(press(&mut input, "p", false), toggle);
        assert_eq!(press(&mut input, "P", true), None);
        assert_eq!(press(&mut input, "c", true), None);
        assert_eq!(press(&mut input, "+", true), Some(Action::Zoom(1.0)));
        assert_eq!(
            press(&mut input, "2", false),
            Some(Action::Mode(Mode::Rara))
        );
        assert_eq!(press(&mut input, "?", false), None);
    }

    #[test]
    fn shift_takes_the_arrows_to_the_plane() {
        let turn = named(NamedKey::ArrowLeft, false);
        assert_eq!(turn, Some(Action::Turn(DVec2::new(-5.0, 0.0))));
        let tilt = GripAction::Tilt(DVec2::new(-5.0, 0.0));
        assert_eq!(named(NamedKey::ArrowLeft, true), Some(Action::Held(tilt)));
    }

    #[test]
    fn shift_takes_the_wheel_to_the_shape() {
        let mut input = Input::default();
        let up = MouseScrollDelta::LineDelta(0.0, 2.0);
        assert_eq!(input.wheel(up), Action::Zoom(2.0));
        input.modifiers(ModifiersState::SHIFT);
        let larger = Action::Held(GripAction::Scale(LARGER * LARGER));
        assert_eq!(input.wheel(up), larger);
        assert_eq!(input.wheel(MouseScrollDelta::LineDelta(2.0, 0.0)), larger);
    }

    #[test]
    fn function_keys_switch_layers_once() {
        let mut input = Input::default();
        let mut press = |repeat| {
            let key = Key::Named(NamedKey::F3);
            input.key(&key, PhysicalKey::Code(KeyCode::F3), Pressed, repeat)
        };
        let third = Action::Layer(Which::Number(3), None);
        assert_eq!(press(false), Some(third));
        assert_eq!(press(true), None);
    }

    #[test]
    fn held_keys_lead_somewhere_until_they_are_let_go() {
        let mut input = Input::default();
        let mut key = |code, state| {
            let key = Key::Character("?".into());
            let none = input.key(&key, PhysicalKey::Code(code), state, false);
            assert_eq!(none, None);
            input.direction()
        };
        assert_eq!(key(KeyCode::KeyW, Pressed), DVec3::Z);
        let both = key(KeyCode::KeyD, Pressed);
        assert!((both - DVec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-12);
        assert_eq!(key(KeyCode::KeyW, Released), DVec3::X);
        input.release();
        assert_eq!(input.direction(), DVec3::ZERO);
    }
}
