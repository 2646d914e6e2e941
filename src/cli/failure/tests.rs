use super::*;

#[test]
fn clap_messages_become_one_line() {
    let message = "error: unexpected argument '--mod' found\n\n  tip: a similar argument exists: '--mode'\n\nUsage: rara render --mode <MODE>\n\nFor more information, try '--help'.\n";
    assert_eq!(
        one_line(message),
        "unexpected argument '--mod' found; tip: a similar argument exists: '--mode'"
    );
}

#[test]
fn each_validation_message_is_a_line_of_its_own() {
    let messages = vec!["in pass sort: buffer splats:\n a hazard".into(), "b".into()];
    let failure = Failure::from(rara::Error::Validation(messages));
    let lines: Vec<_> = failure.details().collect();
    assert_eq!(
        lines,
        [
            "validation: in pass sort: buffer splats: a hazard",
            "validation: b"
        ]
    );
    assert!(failure.to_string().contains("2 times"));
    assert_eq!(Failure::Usage("no".into()).details().count(), 0);
}

#[test]
fn a_quoted_cause_is_not_repeated() {
    let error = rara::Error::io("scene.ply")(std::io::Error::other("the disk is gone"));
    assert_eq!(chain(&error), "scene.ply: the disk is gone");
}
