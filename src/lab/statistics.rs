//! The few statistics that the experiments and the user study report.

pub use rara_base::stats::median;
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

/// The lower quartile, the median and the upper quartile; between two values in proportion. `None` of nothing.
pub fn quartiles(values: &[f64]) -> Option<[f64; 3]> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)?;
    Some([0.25, 0.5, 0.75].map(|share| {
        let at = share * last as f64;
        let below = sorted[at as usize];
        let above = sorted[(at as usize + 1).min(last)];
        below + at.fract() * (above - below)
    }))
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
mod tests;
