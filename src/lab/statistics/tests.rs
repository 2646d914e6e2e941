use super::*;

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

#[test]
fn means_deviations_medians_and_effects_are_those_computed_by_hand() {
    let values = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0];
    assert_eq!(mean(&values), Some(5.0));
    let deviation = (32.0_f64 / 7.0).sqrt();
    assert!(close(standard_deviation(&values).expect("one"), deviation));
    assert_eq!(median(&values), Some(4.5));
    assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
    assert_eq!(quartiles(&values), Some([4.0, 4.5, 5.5]));
    assert_eq!((quartiles(&[7.0]), quartiles(&[])), (Some([7.0; 3]), None));
    assert_eq!(least(&[3.0, 1.0, 2.0]), 1.0);
    assert!(close(cohens_d(&values).expect("one"), 5.0 / deviation));
    assert_eq!((mean(&[]), median(&[])), (None, None));
    assert_eq!(standard_deviation(&[1.0]), None);
    assert_eq!(cohens_d(&[3.0, 3.0]), None);
}

#[test]
fn the_exact_test_gives_the_published_answers() {
    let all_positive = wilcoxon(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!((all_positive.statistic, all_positive.p), (0.0, 0.03125));
    // The heights of Darwin's maize, cross- against self-fertilised; SciPy documents its answer.
    let maize = [
        6., 8., 14., 16., 23., 24., 28., 29., 41., -48., 49., 56., 60., -67., 75.,
    ];
    let test = wilcoxon(&maize);
    assert_eq!((test.n, test.statistic, test.exact), (15, 24.0, true));
    assert!(close(test.p, 0.041_259_765_625), "{}", test.p);
}

#[test]
fn the_exact_test_counts_what_trying_every_assignment_counts() {
    for n in 0..=10_usize {
        let sum = |signs: u32| -> usize {
            let positive = (1..=n).filter(|rank| signs >> (rank - 1) & 1 == 1);
            positive.sum()
        };
        for most in 0..=n * (n + 1) / 2 {
            let tried = (0..1_u32 << n).filter(|&signs| sum(signs) <= most).count();
            let share = tried as f64 / f64::from(1_u32 << n);
            assert_eq!(share_up_to(n, most), share, "n = {n}, most = {most}");
        }
    }
}

#[test]
fn zeros_are_dropped_and_ties_share_their_ranks() {
    // Ranks 1.5, 1.5, 3.5, 3.5, 5; W = 1.5. Mean 7.5, variance 5*6*11/24 - 12/48 = 13.5.
    let test = wilcoxon(&[0.0, 1.0, -1.0, 2.0, 2.0, 3.0, 0.0]);
    assert_eq!((test.n, test.statistic, test.exact), (5, 1.5, false));
    let z = (1.5 - 7.5 + 0.5) / 13.5_f64.sqrt();
    assert!(close(test.p, 2.0 * Normal::standard().cdf(z)));
    // P(Z <= -1.4969) = 0.06721 by the tables.
    assert!((test.p - 0.1344).abs() < 1e-4, "{}", test.p);
}

#[test]
fn many_values_are_approximated_nearly_as_if_they_were_counted() {
    let sign = |i: i32| if i % 4 == 0 { -1.0 } else { 1.0 };
    let values: Vec<f64> = (1..=26).map(|i| f64::from(i) * sign(i)).collect();
    let test = wilcoxon(&values);
    assert!(!test.exact);
    let counted = 2.0 * share_up_to(26, test.statistic as usize);
    assert!((test.p / counted - 1.0).abs() < 0.1, "{} {counted}", test.p);
}

#[test]
fn what_says_nothing_has_p_1_and_signs_do_not_matter() {
    assert_eq!(wilcoxon(&[]).p, 1.0);
    assert_eq!(wilcoxon(&[0.0, 0.0]).p, 1.0);
    assert_eq!(wilcoxon(&[1.0, -1.0]).p, 1.0);
    let values = [3.0, -1.0, 4.0, 1.0, -5.0, 9.0];
    assert_eq!(wilcoxon(&values), wilcoxon(&values.map(|v| -v)));
}
