//! Few values that stand for many: codebooks of numbers, and sets of spherical harmonics.

/// Numbers in a codebook.
const NUMBERS: usize = 256;
/// Times that the numbers are moved to the middle of what they stand for.
const ROUNDS: usize = 12;

/// A codebook, ascending.
pub(super) struct Codebook(pub(super) Vec<f64>);

impl Codebook {
    /// A codebook for these values: between numbers that begin at equal shares of the values, half at equal steps of
    /// their range, each value belongs to the nearest, and each number moves to the mean of its values.
    pub(super) fn from_values(values: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else {
            return Self(vec![0.0; NUMBERS]);
        };
        let sums: Vec<f64> = std::iter::once(0.0)
            .chain(sorted.iter().scan(0.0, |sum, value| {
                *sum += value;
                Some(*sum)
            }))
            .collect();
        let half = NUMBERS / 2;
        let by_share = (0..half).map(|at| sorted[(2 * at + 1) * sorted.len() / NUMBERS]);
        let by_step = (0..half).map(|at| low + (high - low) * at as f64 / (half - 1) as f64);
        let mut numbers: Vec<f64> = by_share.chain(by_step).collect();
        for _ in 0..ROUNDS {
            numbers.sort_unstable_by(f64::total_cmp);
            let mut first = 0;
            for at in 0..NUMBERS {
                let border = numbers.get(at + 1).map(|next| (numbers[at] + next) / 2.0);
                let end = border.map_or(sorted.len(), |border| {
                    sorted.partition_point(|value| *value < border)
                });
                let end = end.max(first);
                if end > first {
                    numbers[at] = (sums[end] - sums[first]) / (end - first) as f64;
                }
                first = end;
            }
        }
        numbers.sort_unstable_by(f64::total_cmp);
        Self(numbers)
    }

    /// The place of the number that is nearest to a value.
    pub(super) fn nearest(&self, value: f64) -> u8 {
        let after = self
            .0
            .partition_point(|number| *number < value)
            .min(NUMBERS - 1);
        let before = after.saturating_sub(1);
        let is_before = value - self.0[before] < self.0[after] - value;
        (if is_before { before } else { after }) as u8
    }
}

/// Divides vectors of `size` numbers into at most `most` sets of neighbours, and gives each vector its set's number and the
/// sets' means. Sets are halved where they are widest, so that all have about as many vectors.
pub(super) fn sets(vectors: &[f32], size: usize, most: usize) -> (Vec<u16>, Vec<f32>) {
    let count = vectors.len() / size;
    if count <= most {
        return (
            (0..count).map(|number| number as u16).collect(),
            vectors.to_vec(),
        );
    }
    let mut order: Vec<u32> = (0..count as u32).collect();
    let mut parts: Vec<&mut [u32]> = vec![&mut order];
    while 2 * parts.len() <= most {
        parts = parts
            .into_iter()
            .flat_map(|part| halves(part, vectors, size))
            .collect();
    }
    let mut labels = vec![0; count];
    let mut means = Vec::with_capacity(parts.len() * size);
    for (number, part) in parts.iter().enumerate() {
        let mut sum = vec![0.0_f64; size];
        for &at in part.iter() {
            labels[at as usize] = number as u16;
            let own = &vectors[at as usize * size..][..size];
            sum.iter_mut()
                .zip(own)
                .for_each(|(sum, value)| *sum += f64::from(*value));
        }
        means.extend(
            sum.iter()
                .map(|sum| (sum / part.len().max(1) as f64) as f32),
        );
    }
    (labels, means)
}

fn halves<'a>(part: &'a mut [u32], vectors: &[f32], size: usize) -> [&'a mut [u32]; 2] {
    let value = |at: u32, axis: usize| vectors[at as usize * size + axis];
    let spread = |axis: usize| {
        let count = part.len().max(1) as f64;
        let all = part.iter().map(|&at| f64::from(value(at, axis)));
        let mean = all.clone().sum::<f64>() / count;
        all.map(|value| (value - mean).powi(2)).sum::<f64>()
    };
    let spreads: Vec<f64> = (0..size).map(spread).collect();
    let widest = (0..size)
        .max_by(|a, b| spreads[*a].total_cmp(&spreads[*b]))
        .unwrap_or(0);
    let middle = part.len() / 2;
    if middle > 0 {
        part.select_nth_unstable_by(middle, |a, b| {
            value(*a, widest)
                .total_cmp(&value(*b, widest))
                .then(a.cmp(b))
        });
    }
    let (low, high) = part.split_at_mut(middle);
    [low, high]
}

#[cfg(test)]
mod tests;
