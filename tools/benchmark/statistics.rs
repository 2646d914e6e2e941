//! Summaries of several measurements. `tests/files/benchmark.rs` tests them.

/// The least, the median and the 90th percentile of some values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Summary {
    pub(crate) n: usize,
    pub(crate) min: f64,
    pub(crate) median: f64,
    pub(crate) p90: f64,
}

impl Summary {
    /// All NaN where there are no values.
    pub(crate) fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let n = sorted.len();
        let at = |index: usize| sorted.get(index).copied().unwrap_or(f64::NAN);
        Self {
            n,
            min: at(0),
            median: (at(n.saturating_sub(1) / 2) + at(n / 2)) / 2.0,
            // The smallest value that nine tenths do not exceed.
            p90: at((9 * n).div_ceil(10).saturating_sub(1)),
        }
    }
}

/// The ratios of two measurements in the same round: other work on the machine disturbs both alike.
pub(crate) fn ratios(values: &[f64], to: &[f64]) -> Vec<f64> {
    assert_eq!(values.len(), to.len(), "a ratio is of a pair");
    values.iter().zip(to).map(|(a, b)| a / b).collect()
}
