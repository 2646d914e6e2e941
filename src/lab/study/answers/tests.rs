use super::*;
use proptest::prelude::*;

/// Answers of a participant about these cases, (case, metric, preference) each; on the left by turns.
pub(in crate::study) fn answers(
    participant: &str,
    cases: &[&str],
    given: &[(&str, Metric, i8)],
) -> Answers {
    let answer = |(number, &(case, metric, preference)): (usize, &(&str, Metric, i8))| {
        let left = [Which::Hard, Which::Method][number % 2];
        let is_left = (preference > 0) == (left == Which::Method);
        Answer {
            case: case.into(),
            metric,
            left,
            choice: if is_left { Side::Left } else { Side::Right },
            strength: preference.unsigned_abs(),
            ms: 1000 + number as u64,
            changes: 2,
            at: "2026-01-02T03:04:05.000Z".into(),
            position: number as u64 + 1,
        }
    };
    Answers {
        format: FORMAT.into(),
        version: VERSION,
        study: Study {
            id: "0123456789abcdef".into(),
            method: "exact".into(),
            cases: cases.iter().map(|&case| case.into()).collect(),
        },
        participant: participant.into(),
        group: 1,
        background: Background {
            age: "25-34".into(),
            experience: "none".into(),
        },
        begun: "2026-01-02T03:00:00.000Z".into(),
        saved: "2026-01-02T03:30:00.000Z".into(),
        answers: given.iter().enumerate().map(answer).collect(),
        questions: Questions::default(),
    }
}

fn sample() -> Answers {
    let given = [("a", Metric::Flatness, 3), ("b", Metric::Flatness, -7)];
    answers("P1", &["a", "b"], &given)
}

fn bytes(answers: &Answers) -> Vec<u8> {
    serde_json::to_vec(answers).expect("JSON")
}

#[test]
fn what_is_written_is_read_and_preferences_have_the_sign_of_the_choice() {
    let read = Answers::read(&bytes(&sample())).expect("answers");
    assert_eq!(read, sample());
    let preferences: Vec<_> = read.answers.iter().map(Answer::preference).collect();
    assert_eq!(preferences, [3.0, -7.0]);
}

#[test]
fn each_mistake_is_refused_by_the_name_of_its_element() {
    type Change = fn(&mut Answers);
    let cases: [(&str, Change); 7] = [
        ("format: ", |a| a.format = "something".into()),
        ("version: ", |a| a.version = 9),
        ("participant: ", |a| a.participant = "  ".into()),
        ("group: ", |a| a.group = 3),
        ("answers[1].strength: 8 is not 1 to 7", |a| {
            a.answers[1].strength = 8
        }),
        ("answers[0].case: ", |a| a.answers[0].case = "c".into()),
        ("answers[1].metric: ", |a| a.answers[1].case = "a".into()),
    ];
    for (expected, change) in cases {
        let mut answers = sample();
        change(&mut answers);
        let error = Answers::read(&bytes(&answers)).expect_err(expected);
        assert!(error.starts_with(expected), "{error}");
        assert!(error.contains("; use the"), "{error}");
    }
    let text = String::from_utf8(bytes(&sample())).expect("text");
    for (from, to, element) in [
        ("\"flatness\"", "\"beauty\"", "answers[0].metric: "),
        ("\"strength\":7", "\"strength\":-7", "answers[1].strength: "),
        (
            "\"strength\":7",
            "\"strength\":7.5",
            "answers[1].strength: ",
        ),
    ] {
        let error = Answers::read(text.replacen(from, to, 1).as_bytes()).expect_err(to);
        assert!(error.starts_with(element), "{error}");
    }
}

proptest! {
    #[test]
    fn no_bytes_panic(at in 0.0..1.0_f64, with in proptest::collection::vec(any::<u8>(), 0..12), cut in any::<bool>()) {
        let mut file = bytes(&sample());
        let at = (at * file.len() as f64) as usize;
        let end = if cut { file.len() } else { (at + with.len()).min(file.len()) };
        file.splice(at..end, with.iter().copied());
        let _ = Answers::read(&file);
        let _ = Answers::read(&with);
    }
}
