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
    assert_eq!(press(&mut input, "7", false), Some(Action::Slice(None)));
    assert_eq!(press(&mut input, "?", false), None);
}

#[test]
fn shift_takes_the_arrows_to_the_plane() {
    let turn = named(NamedKey::ArrowLeft, ModifiersState::empty());
    assert_eq!(turn, Some(Action::Turn(DVec2::new(-5.0, 0.0))));
    let tilt = GripAction::Tilt(DVec2::new(-5.0, 0.0));
    assert_eq!(
        named(NamedKey::ArrowLeft, ModifiersState::SHIFT),
        Some(Action::Held(tilt))
    );
}

#[test]
fn shift_takes_the_axes_to_the_view_and_capitals_alone_do_not() {
    let mut input = Input::default();
    let align = Action::Held(GripAction::Align(DVec3::Y));
    assert_eq!(press(&mut input, "Y", false), Some(align));
    input.modifiers(ModifiersState::SHIFT);
    let up = Action::UpAxis(DVec3::Y);
    assert_eq!(press(&mut input, "Y", false), Some(up));
    assert_eq!(press(&mut input, "Y", true), None);
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
    let third = || Which::Number(3);
    for (modifiers, action) in [
        (ModifiersState::empty(), Action::Layer(third(), None)),
        (
            ModifiersState::SHIFT,
            Action::LayerOpacity(third(), Step::Next),
        ),
        (
            ModifiersState::CONTROL,
            Action::LayerTint(third(), Step::Next),
        ),
    ] {
        let mut input = Input::default();
        input.modifiers(modifiers);
        let mut press = |repeat| {
            let key = Key::Named(NamedKey::F3);
            input.key(&key, PhysicalKey::Code(KeyCode::F3), Pressed, repeat)
        };
        assert_eq!(press(false), Some(action));
        assert_eq!(press(true), None);
    }
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
