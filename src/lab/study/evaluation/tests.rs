use super::*;
use crate::study::answers::{Answers, tests::answers};

/// Files in a folder of their own, which is removed at the end.
pub(in crate::study) struct Files(pub(in crate::study) PathBuf);

impl Files {
    pub(in crate::study) fn of(name: &str, all: &[&Answers]) -> (Self, Vec<PathBuf>) {
        let folder = std::env::temp_dir().join(format!("rara-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let write = |(number, answers): (usize, &&Answers)| {
            let file = folder.join(format!("{number}.json"));
            std::fs::write(&file, serde_json::to_vec(answers).expect("JSON")).expect("a file");
            file
        };
        let files = all.iter().enumerate().map(write).collect();
        (Self(folder), files)
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

const FLAT: Metric = Metric::Flatness;

#[test]
fn statistics_are_those_computed_by_hand() {
    // Per answer 1, 2, 3, 4, 5, -6: mean 1.5, squares about it 77.5, deviation sqrt(15.5), d 0.381, W = 6 of 21:
    // 14 of 64 assignments have a sum of at most 6, so p = 28/64. Per participant 1.5, 3.5, -0.5: mean 1.5,
    // deviation 2, d 0.75, W = 1, p = 2 (2/8).
    let [p1, p2, p3] = [("P1", [1, 2]), ("p2 ", [3, 4]), ("P3", [5, -6])].map(|(code, values)| {
        answers(
            code,
            &["a", "b"],
            &[("a", FLAT, values[0]), ("b", FLAT, values[1])],
        )
    });
    let (_folder, files) = Files::of("by-hand", &[&p1, &p2, &p3]);
    let evaluation = evaluate(&files, Some("0123456789abcdef")).expect("an evaluation");
    let result = &evaluation.metrics[0];
    let sample = &result.answers;
    assert_eq!((sample.mean, sample.median), (Some(1.5), Some(2.5)));
    let close = |a: Option<f64>, b: f64| (a.expect("a number") - b).abs() < 1e-12;
    assert!(close(sample.deviation, 15.5_f64.sqrt()));
    assert!(close(sample.d, 1.5 / 15.5_f64.sqrt()));
    assert!(close(sample.positive, 5.0 / 6.0));
    assert_eq!(
        (sample.wilcoxon.statistic, sample.wilcoxon.p),
        (6.0, 28.0 / 64.0)
    );
    let sample = &result.participants;
    assert_eq!(
        (sample.mean, sample.deviation, sample.d),
        (Some(1.5), Some(2.0), Some(0.75))
    );
    assert_eq!((sample.wilcoxon.statistic, sample.wilcoxon.p), (1.0, 0.5));
    assert_eq!(evaluation.by_case[0][0], Some(3.0));
    assert_eq!(evaluation.by_case[1][0], Some(0.0));
    assert_eq!(evaluation.by_case[0][1], None);
    assert_eq!(evaluation.participants[1].code, "P2");
    assert!(
        evaluation
            .participants
            .iter()
            .all(|p| p.asked == 6 && !p.is_complete())
    );
    assert_eq!(evaluation.median_seconds, Some(1.0005));
}

#[test]
fn the_file_that_was_saved_last_replaces_the_others_of_its_participant() {
    let [mut early, mut late, same] =
        [1, 2, 3].map(|value| answers("P1", &["a"], &[("a", FLAT, value)]));
    early.saved = "2026-01-02T03:00:00.000Z".into();
    late.saved = "2026-01-02T04:00:00.000Z".into();
    let (_folder, files) = Files::of("replaced", &[&early, &late, &same]);
    let evaluation = evaluate(&files, None).expect("an evaluation");
    assert_eq!(evaluation.metrics[0].answers.values, [2.0]);
    let replaced: Vec<_> = evaluation
        .replaced
        .iter()
        .map(|r| (&r.file, &r.by))
        .collect();
    assert_eq!(replaced, [(&files[0], &files[1]), (&files[2], &files[1])]);
}

#[test]
fn other_studies_and_no_files_are_refused() {
    let one = answers("P1", &["a"], &[]);
    let mut other = answers("P2", &["a"], &[]);
    other.study.id = "ffff".into();
    let (_folder, files) = Files::of("mixed", &[&one, &other]);
    let error = evaluate(&files, None).expect_err("mixed").to_string();
    assert!(
        error.contains("1.json: study.id: ") && error.contains("0.json"),
        "{error}"
    );
    let error = evaluate(&files[..1], Some("ffff"))
        .expect_err("wrong")
        .to_string();
    assert!(error.contains("0.json: study.id: "), "{error}");
    let mut changed = one.clone();
    changed.study.cases = vec!["b".into()];
    let (_folder, files) = Files::of("changed", &[&one, &changed]);
    let error = evaluate(&files, None).expect_err("changed").to_string();
    assert!(error.contains("1.json: study: "), "{error}");
    assert!(evaluate::<PathBuf>(&[], None).is_err());
    let missing = evaluate(&["no/such.json"], None)
        .expect_err("missing")
        .to_string();
    assert!(missing.contains("no/such.json"), "{missing}");
}

#[test]
fn answers_of_nobody_have_no_statistics_but_a_report() {
    let (_folder, files) = Files::of("nobody", &[&answers("P1", &[], &[])]);
    let evaluation = evaluate(&files, None).expect("an evaluation");
    assert!(evaluation.metrics.iter().all(|m| m.answers.mean.is_none()));
    assert_eq!(evaluation.median_seconds, None);
}
