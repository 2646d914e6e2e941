use super::*;
use glam::DVec2;

#[test]
fn comments_empty_lines_and_repetitions() {
    let text = "# what this is for\n\nrepeat 3 turn 2,0 # a bit\n  quit\n";
    let turn = Action::Turn(DVec2::new(2.0, 0.0));
    assert_eq!(
        parse(text, "s").unwrap(),
        [turn.clone(), turn.clone(), turn, Action::Quit]
    );
    assert_eq!(parse("", "s").unwrap(), []);
}

#[test]
fn a_wrong_line_is_named() {
    for text in [
        "quit\nleap",
        "quit\nrepeat 0 quit",
        "quit\nrepeat 2",
        "quit\nrepeat x quit",
        "quit\nscreenshot a.jpg",
    ] {
        let error = parse(text, "smoke.txt").expect_err(text);
        assert!(matches!(error, Failure::Usage(_)));
        let error = error.to_string();
        assert!(error.contains("smoke.txt, line 2: "), "{error}");
    }
}
