//! The few statistics that the experiments and the user study report.

use statrs::distribution::{ContinuousCDF, Normal};

pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// The standard deviation of a sample, with n - 1; `None` of fewer than two values.
pub fn standard_deviation(values: &[f64]) -> Option<f64> {
    let mean = mean(values).filter(|_| values.len() > 1)?;
    let squares = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    Some((squares / (values.len() - 1) as f64).sqrt())
}

/// The middle value, or the mean of the two in the middle; `None` of nothing.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => None,
        n if n % 2 == 1 => Some(sorted[middle]),
        _ => Some(f64::midpoint(sorted[middle - 1], sorted[middle])),
    }
}

/// The least value; infinite of nothing.
pub fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Cohen's d of one sample against 0, or of differences of pairs: the mean in standard deviations. `None` of fewer than
/// two values, and where all are the same.
pub fn cohens_d(values: &[f64]) -> Option<f64> {
    let deviation = standard_deviation(values).filter(|&s| s > 0.0)?;
    Some(mean(values)? / deviation)
}

#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Wilcoxon {
    /// The number of values that are not 0.
    pub n: usize,
    /// The smaller of the sums of ranks, of the positive values and of the negative ones.
    pub statistic: f64,
    /// The two-sided probability of a statistic at most as large if the values were symmetric about 0.
    pub p: f64,
    /// True when `p` counts every assignment of signs; otherwise it is the normal approximation.
    pub exact: bool,
}

/// The most values for which every assignment of signs is counted.
const EXACT_UP_TO: usize = 25;

/// Wilcoxon's signed-rank test against 0, two-sided. Zeros are dropped, and equal magnitudes share the mean of their
/// ranks. Up to 25 values without equal magnitudes are tested exactly, others by the normal approximation with a
/// correction for ties and one for continuity. Of nothing but zeros p is 1.
pub fn wilcoxon(values: &[f64]) -> Wilcoxon {
    let mut values: Vec<f64> = values.iter().copied().filter(|&v| v != 0.0).collect();
    values.sort_unstable_by(|a, b| a.abs().total_cmp(&b.abs()));
    let n = values.len();
    let (mut positive, mut ties) = (0.0, 0.0);
    let mut rank = 0.0;
    for equal in values.chunk_by(|a, b| a.abs() == b.abs()) {
        let size = equal.len() as f64;
        let midrank = rank + (size + 1.0) / 2.0;
        positive += midrank * equal.iter().filter(|&&v| v > 0.0).count() as f64;
        ties += size.powi(3) - size;
        rank += size;
    }
    let statistic = f64::min(positive, rank * (rank + 1.0) / 2.0 - positive);
    let exact = n <= EXACT_UP_TO && ties == 0.0;
    let p = if exact {
        2.0 * share_up_to(n, statistic as usize)
    } else {
        2.0 * approximation(rank, ties).map_or(0.5, |(mean, deviation)| {
            let normal = Normal::standard();
            normal.cdf((statistic - mean + 0.5).min(0.0) / deviation)
        })
    };
    Wilcoxon {
        n,
        statistic,
        p: p.min(1.0),
        exact,
    }
}

/// The share of the assignments of signs to the ranks 1 to n whose sum of positive ranks is at most `most`.
fn share_up_to(n: usize, most: usize) -> f64 {
    let mut ways = vec![0_u64; n * (n + 1) / 2 + 1];
    ways[0] = 1;
    for rank in 1..=n {
        for sum in (rank..ways.len()).rev() {
            ways[sum] += ways[sum - rank];
        }
    }
    ways.iter().take(most + 1).sum::<u64>() as f64 / 2_f64.powi(n as i32)
}

/// The mean and the standard deviation of the sum of positive ranks of `n` values; `ties` is the sum of t^3 - t over the
/// groups of equal magnitudes. `None` where there is no deviation.
fn approximation(n: f64, ties: f64) -> Option<(f64, f64)> {
    let variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ties / 48.0;
    (variance > 0.0).then(|| (n * (n + 1.0) / 4.0, variance.sqrt()))
}

#[cfg(test)]
mod tests {
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
}
