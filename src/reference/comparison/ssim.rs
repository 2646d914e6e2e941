use rara_scene::picture::Picture;

/// Half the window's width, pixels.
const RADIUS: usize = 5;
/// The window's standard deviation, pixels.
const SIGMA: f64 = 1.5;
/// (0.01)^2 and (0.03)^2: what keeps the two quotients finite where nothing is to be seen.
const STABILISERS: [f64; 2] = [1e-4, 9e-4];

/// Adds the structural similarity of one channel of two pictures of the same size to each pixel's sum.
pub(super) fn add_channel(a: &Picture, b: &Picture, channel: usize, sums: &mut [f64]) {
    let (width, height) = (a.width as usize, a.height as usize);
    assert_eq!(sums.len(), width * height);
    let (across, down) = (windows(width), windows(height));
    // The window is a product of two one-dimensional ones: blur each row's moments, then down the columns.
    let mut rows = Vec::with_capacity(width * height);
    for (a, b) in a
        .pixels
        .chunks_exact(width)
        .zip(b.pixels.chunks_exact(width))
    {
        let moments = a.iter().zip(b).map(|(a, b)| {
            let (a, b) = (f64::from(a[channel]), f64::from(b[channel]));
            [a, b, a * a, b * b, a * b]
        });
        let moments: Vec<_> = moments.collect();
        rows.extend(across.iter().map(|window| window.mean(|x| moments[x])));
    }
    for (window, sums) in down.iter().zip(sums.chunks_exact_mut(width)) {
        for (x, sum) in sums.iter_mut().enumerate() {
            *sum += similarity(window.mean(|y| rows[y * width + x]));
        }
    }
}

/// Positions and weights of the window about one position of an axis; the weights add up to 1 at the edges too.
struct Window {
    start: usize,
    weights: Vec<f64>,
}

impl Window {
    /// Weighted mean of five values at each position.
    fn mean(&self, values: impl Fn(usize) -> [f64; 5]) -> [f64; 5] {
        let mut mean = [0.0; 5];
        for (position, weight) in (self.start..).zip(&self.weights) {
            mean.iter_mut()
                .zip(values(position))
                .for_each(|(mean, value)| *mean += weight * value);
        }
        mean
    }
}

fn windows(size: usize) -> Vec<Window> {
    let about = |centre: usize| {
        let start = centre.saturating_sub(RADIUS);
        let range = start..(centre + RADIUS + 1).min(size);
        let weights = range.map(|i| (-0.5 * ((i as f64 - centre as f64) / SIGMA).powi(2)).exp());
        let weights: Vec<f64> = weights.collect();
        let total: f64 = weights.iter().sum();
        Window {
            start,
            weights: weights.iter().map(|weight| weight / total).collect(),
        }
    };
    (0..size).map(about).collect()
}

fn similarity([a, b, aa, bb, ab]: [f64; 5]) -> f64 {
    let [c1, c2] = STABILISERS;
    let (variance_a, variance_b, covariance) = (aa - a * a, bb - b * b, ab - a * b);
    (2.0 * a * b + c1) * (2.0 * covariance + c2)
        / ((a * a + b * b + c1) * (variance_a + variance_b + c2))
}
