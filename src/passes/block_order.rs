//! The order of the Gaussians on the device: along a space-filling curve, so that neighbours share a block, and the
//! bounds of those blocks. Large Gaussians and those too faint to be sure of a pixel have blocks of their own: a single
//! one would widen, or leave undecided, the block of its neighbours.

use std::thread;

use glam::Vec3;

use crate::types::Block;
use rara_base::limits;
use rara_base::parallel::{in_parallel, threads};
use rara_scene::{Gaussians, Training};

/// Bits of the places that a curve distinguishes along each axis: those of three axes and the kind are a key of 32.
const BITS: u32 = 10;
/// Kinds of Gaussians, from the lowest key up; each has its own curve.
const SMALL: u32 = 0;
const MIDDLE: u32 = 1;
const LARGE: u32 = 2;
const FAINT: u32 = 3;
/// Reach, as a share of the scene's size, from which a Gaussian is no longer small and from which it is large.
const MIDDLE_REACH: f32 = 1.0 / 128.0;
const LARGE_REACH: f32 = 1.0 / 16.0;
/// Gaussians that the scene's extent is estimated from, and the share of their centres beyond each end.
const SAMPLES: usize = 1 << 14;
const OUTLIERS: usize = 100;
/// Gaussians that a thread takes at a time; whole blocks.
const CHUNK: usize = 64 * limits::BLOCK_SIZE as usize;

/// The numbers of the Gaussians in the order of the device.
pub(super) fn order(scene: &Gaussians) -> Vec<u32> {
    let count = scene.len() as u32;
    if count <= limits::BLOCK_SIZE {
        return (0..count).collect(); // one block, whatever the order
    }
    let [low, high] = extent(scene.positions());
    let size = (high - low).max(Vec3::splat(f32::MIN_POSITIVE));
    let most = most_spanning_scale(scene);
    let key = |number: u32| {
        let splat = Splat::of(scene, number);
        let reach = splat.reach() / size.max_element();
        let class = if !splat.is_spanning() || splat.spanning_scale() > most {
            FAINT
        } else if reach < MIDDLE_REACH {
            SMALL
        } else if reach < LARGE_REACH {
            MIDDLE
        } else {
            LARGE
        };
        // Outliers go to the ends, and a share that is no number to the beginning.
        let share = ((splat.position - low) / size).clamp(Vec3::ZERO, Vec3::ONE);
        let cell = share * ((1 << BITS) - 1) as f32;
        class << (3 * BITS) | morton(cell.x as u32, cell.y as u32, cell.z as u32)
    };
    let mut keys = vec![0; scene.len()];
    let parts = (0..).step_by(CHUNK).zip(keys.chunks_mut(CHUNK));
    in_parallel(parts, |(first, keys)| {
        for (number, to) in (first..).zip(keys) {
            *to = u64::from(key(number)) << 32 | u64::from(number);
        }
    });
    sort(&mut keys, threads());
    keys.into_iter().map(|key| key as u32).collect()
}

/// Sorts on so many threads. No two keys are equal, so that their number changes nothing.
fn sort(keys: &mut [u64], threads: usize) {
    if threads < 2 || keys.len() < CHUNK {
        return keys.sort_unstable();
    }
    let (low, _, high) = keys.select_nth_unstable(keys.len() / 2);
    thread::scope(|scope| {
        scope.spawn(|| sort(low, threads / 2));
        sort(high, threads - threads / 2);
    });
}

/// The bounds of a block that holds nothing.
pub(super) const EMPTY: Block = Block {
    low_reach: [f32::MAX, f32::MAX, f32::MAX, -1.0],
    high_sigma: [f32::MIN, f32::MIN, f32::MIN, 0.0],
    spanning_scale: 0.0,
    pad: [0; 3],
};

/// The blocks of an order.
pub(super) fn blocks(scene: &Gaussians, order: &[u32]) -> Vec<Block> {
    let blocks = in_parallel(order.chunks(CHUNK), |numbers| {
        let blocks = numbers.chunks(limits::BLOCK_SIZE as usize);
        blocks.map(|numbers| block(scene, numbers)).collect()
    });
    let blocks: Vec<Vec<Block>> = blocks;
    blocks.concat()
}

fn block(scene: &Gaussians, numbers: &[u32]) -> Block {
    let (mut low, mut high) = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
    let (mut farthest, mut sigma, mut spanning) = (-1.0_f32, 0.0_f32, true);
    let mut spanning_scale = 0.0_f32;
    // All of them first, so that the processor waits for several at a time: they lie anywhere in memory.
    let splats: Vec<_> = numbers.iter().map(|&n| Splat::of(scene, n)).collect();
    for splat in splats {
        spanning &= splat.is_spanning();
        if splat.opacity < limits::ALPHA_MIN {
            continue; // nowhere visible, wherever it is
        }
        let position = splat.position;
        let reach = splat.reach();
        if !(position.is_finite() && reach.is_finite()) {
            // It must be looked at, wherever the others are.
            farthest = f32::INFINITY;
            spanning = false;
            continue;
        }
        low = low.min(position);
        high = high.max(position);
        farthest = farthest.max(reach);
        sigma = sigma.max(splat.scale.max_element());
        spanning_scale = spanning_scale.max(splat.spanning_scale());
    }
    let sigma = if spanning {
        sigma
    } else {
        -sigma.max(f32::MIN_POSITIVE)
    };
    Block {
        low_reach: low.extend(farthest).into(),
        high_sigma: high.extend(sigma).into(),
        spanning_scale,
        pad: [0; 3],
    }
}

/// The [`Splat::spanning_scale`] beyond which a Gaussian counts as faint: as close as the eye has to be for that, it will seldom be.
fn most_spanning_scale(scene: &Gaussians) -> f32 {
    let sample = (0..scene.len()).step_by(scene.len().div_ceil(SAMPLES));
    let mut scales: Vec<_> = sample
        .map(|n| Splat::of(scene, n as u32).spanning_scale())
        .collect();
    let middle = scales.len() / 2;
    2.0 * *scales.select_nth_unstable_by(middle, f32::total_cmp).1
}

/// A Gaussian, as far as its place in the order and its block depend on it.
struct Splat {
    position: Vec3,
    scale: Vec3,
    opacity: f32,
    training: Training,
}

impl Splat {
    fn of(scene: &Gaussians, number: u32) -> Self {
        let index = number as usize;
        Self {
            position: scene.positions()[index],
            scale: scene.scales()[index],
            opacity: scene.opacities()[index],
            training: scene.training(),
        }
    }

    /// Pixels a unit of the layer from which an antialiased splat keeps an [`opacity_spanning`], whatever direction it is
    /// seen from; infinite where none is enough, and zero of splats that are not antialiased. With the middle and the least
    /// deviation a and b and `x` the square of the scale, its opacity is multiplied by at least the root of
    /// `a²x / (a²x + L) · b²x / (b²x + L)` (glsl/block_view.glsl). That this is the share that is needed is a quadratic equation in x.
    fn spanning_scale(&self) -> f32 {
        if !self.training.antialiased {
            return 0.0;
        }
        let share = (f64::from(least_opacity(self.training)) / f64::from(self.opacity)).powi(2);
        let mut deviations = self.scale.to_array();
        deviations.sort_unstable_by(f32::total_cmp);
        let [b, a, _] = deviations.map(|deviation| f64::from(deviation).powi(2));
        let low_pass = f64::from(self.training.low_pass);
        let half = 0.5 * share * low_pass * (a + b);
        let rest = (1.0 - share) * a * b;
        let square = (half + (half * half + rest * share * low_pass * low_pass).sqrt()) / rest;
        match square >= 0.0 {
            true => square.sqrt() as f32,
            false => f32::INFINITY, // fainter than that itself, flat, or no number
        }
    }

    /// How far from its centre a splat's contour of 1/255 can lie, the layer's units.
    fn reach(&self) -> f32 {
        let times = self.opacity * limits::ALPHA_MIN_INVERSE;
        let extent = limits::REACH_MARGIN * (2.0 * times.max(1.0).ln()).sqrt();
        extent * self.scale.max_element()
    }

    fn is_spanning(&self) -> bool {
        self.opacity >= opacity_spanning(self.training)
    }
}

/// The opacity from which a splat's bounding box spans a pixel whatever the projection: half a pixel is then within the
/// contour of 1/255 of what has the low-pass alone for a variance. Single precision may find that a little smaller.
pub(super) fn opacity_spanning(training: Training) -> f32 {
    const MARGIN: f32 = 1.01;
    let most = 0.5 * 0.5 / training.low_pass;
    MARGIN * limits::ALPHA_MIN * (0.5 * MARGIN * most).exp()
}

/// The opacity that making up for the low-pass has to leave of a splat so that it spans a pixel.
pub(super) fn least_opacity(training: Training) -> f32 {
    /// Single precision may find the opacity too small by this factor.
    const MARGIN: f32 = 1.05;
    MARGIN * opacity_spanning(training)
}

/// The bounds of nearly all centres, from a sample.
fn extent(positions: &[Vec3]) -> [Vec3; 2] {
    let step = positions.len().div_ceil(SAMPLES);
    let along = |pick: fn(&Vec3) -> f32| {
        let mut values: Vec<f32> = positions.iter().step_by(step).map(pick).collect();
        values.sort_unstable_by(f32::total_cmp);
        let outliers = values.len() / OUTLIERS;
        (values[outliers], values[values.len() - 1 - outliers])
    };
    let (x, y, z) = (along(|p| p.x), along(|p| p.y), along(|p| p.z));
    [Vec3::new(x.0, y.0, z.0), Vec3::new(x.1, y.1, z.1)]
}

/// The bits of three coordinates in turn.
fn morton(x: u32, y: u32, z: u32) -> u32 {
    /// Two zeros behind each of the lowest ten bits.
    fn spread(v: u32) -> u32 {
        let v = (v | v << 16) & 0x0300_00ff;
        let v = (v | v << 8) & 0x0300_f00f;
        let v = (v | v << 4) & 0x030c_30c3;
        (v | v << 2) & 0x0924_9249
    }
    spread(x) | spread(y) << 1 | spread(z) << 2
}

#[cfg(test)]
mod tests;
