//! Which Gaussians of a layer are framed, and which are strays.
//!
//! Weights alone cannot tell hair, which reaches out and weighs little, from a background, which is far and weighs much. What
//! tells them apart is that hair is one with the head: Gaussians are linked to others that are as near as is usual in their
//! scene. All of the heaviest part counts, but for what weighs next to nothing for how far it reaches; another part has to weigh
//! the more, the more it would widen the picture.

use glam::DVec3;

use super::reach::Reach;

/// The share of the weight that is worth a picture wider by the factor e: of a part by itself.
const PART: f64 = 0.03;
/// The same within the heaviest part.
const WITHIN: f64 = 0.0005;
/// A Gaussian counts as no larger than so many of the middle one: a wall of one Gaussian shows less than the object before it.
const LARGEST: f64 = 4.0;
/// Cells are halved in volume until half of the Gaussians are in cells of so many or fewer.
const CROWD: usize = 2;
/// The most steps of it.
const STEPS: i32 = 28;
/// The largest Gaussian that links others, in cells of its second axis: it is smooth, and goes through what is apart.
const LINKING: f64 = 4.0;
/// The most places on half of an axis that are linked.
const PLACES: i32 = 16;

/// A Gaussian and what it weighs.
#[derive(Debug, Clone, Copy)]
pub(super) struct WeightedPoint {
    /// Out to where it shows well, which links it.
    pub(super) reach: Reach,
    /// Out to where it is drawn.
    pub(super) drawn: Reach,
    pub(super) opacity: f64,
    /// Its largest deviation.
    pub(super) size: f64,
}

/// The Gaussians that are framed, and the cells that they are in. A `generous` choice takes ten times as little for worth
/// showing.
pub(super) fn framed(all: &[WeightedPoint], generous: bool) -> (Vec<Reach>, Cells) {
    let Some(cell) = cell(all) else {
        let framed: Vec<_> = all.iter().map(|one| one.drawn).collect();
        return (framed, Cells::default());
    };
    let unit = LARGEST * median(all.iter().map(|one| one.size));
    // Squared, since what is faint is hardly seen before what is not.
    let weight = |one: &WeightedPoint| one.opacity.powi(2) * one.size.min(unit);
    let mut parts = parts(all, cell);
    let weights = |part: &[u32]| part.iter().map(|&i| weight(&all[i as usize])).sum::<f64>();
    let mut weighed: Vec<(f64, Vec<u32>)> = parts.drain(..).map(|p| (weights(&p), p)).collect();
    let total: f64 = weighed.iter().map(|(weight, _)| weight).sum();
    let heaviest = (0..weighed.len()).max_by(|a, b| weighed[*a].0.total_cmp(&weighed[*b].0));
    let (_, main) = weighed.swap_remove(heaviest.unwrap_or(0));

    let along = |axis: usize| median(main.iter().map(|&i| all[i as usize].reach.centre[axis]));
    let middle = DVec3::new(along(0), along(1), along(2));
    let far = |i: u32| all[i as usize].reach.farthest(middle);
    let worth = if generous { 0.1 } else { 1.0 };
    // From the farthest on, where what lies beyond costs least for how far it reaches.
    let mut by_distance: Vec<(f64, u32)> = main.iter().map(|&i| (far(i), i)).collect();
    by_distance.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    let within = total * WITHIN * worth;
    let weighed_there = by_distance
        .iter()
        .map(|&(far, i)| (far, weight(&all[i as usize])));
    let first = first_worth(weighed_there, within);
    let radius = by_distance[first].0;
    let others = weighed.iter().filter(|(weight, part)| {
        let farthest = part.iter().map(|&i| far(i)).fold(0.0, f64::max);
        weight / total >= PART * worth * (farthest / radius).ln()
    });
    let others = others.flat_map(|(_, part)| part.iter().copied());
    let main = by_distance[first..].iter().map(|&(_, i)| i);
    // Likewise out to where they are drawn: a wide and faint one is left to reach out of the picture.
    let drawn = |i: u32| all[i as usize].drawn.farthest(middle);
    let mut chosen: Vec<(f64, u32)> = main.chain(others).map(|i| (drawn(i), i)).collect();
    chosen.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    let weighed_there = chosen
        .iter()
        .map(|&(far, i)| (far, weight(&all[i as usize])));
    let first = first_worth(weighed_there, within);
    let framed = chosen.iter().enumerate().map(|(number, &(_, i))| {
        let one = &all[i as usize];
        if number < first { one.reach } else { one.drawn }
    });
    let framed: Vec<_> = framed.collect();
    let mut keys: Vec<u64> = framed.iter().map(|one| key(one.centre, cell)).collect();
    keys.sort_unstable();
    keys.dedup();
    (framed, Cells { cell, keys })
}

/// The first, of how far some reach and what they weigh, the farthest first, that is worth a picture that is as much wider: those
/// before it cost more than they weigh, where `within` is worth one wider by the factor e.
fn first_worth(mut all: impl Iterator<Item = (f64, f64)>, within: f64) -> usize {
    let Some((mut far, mut weight)) = all.next() else {
        return 0;
    };
    let (mut beyond, mut first, mut least) = (0.0, 0, far.ln());
    for (index, next) in all.enumerate() {
        beyond += weight;
        (far, weight) = next;
        let cost = far.ln() + beyond / within;
        if cost < least {
            (first, least) = (index + 1, cost);
        }
    }
    first
}

/// The cells that what is framed is in.
#[derive(Debug, Default)]
pub(super) struct Cells {
    cell: f64,
    /// Sorted.
    keys: Vec<u64>,
}

impl Cells {
    /// True for a place in one of them, or beside one.
    pub(super) fn links(&self, at: DVec3) -> bool {
        if self.keys.is_empty() {
            return false;
        }
        let here = key(at, self.cell);
        (-1..=1).any(|x: i64| {
            (-1..=1).any(|y: i64| {
                let row = here.wrapping_add_signed((x << (2 * BITS)) + (y << BITS) - 1);
                let first = self.keys.partition_point(|key| *key < row);
                self.keys.get(first).is_some_and(|key| *key <= row + 2)
            })
        })
    }
}

/// The middle one of some numbers; 0 without any.
fn median(numbers: impl Iterator<Item = f64>) -> f64 {
    let mut numbers: Vec<f64> = numbers.collect();
    let half = numbers.len() / 2;
    match numbers.is_empty() {
        true => 0.0,
        false => *numbers.select_nth_unstable_by(half, f64::total_cmp).1,
    }
}

/// The side of cells in which Gaussians are as near as is usual; none where all are in one place.
fn cell(all: &[WeightedPoint]) -> Option<f64> {
    let spread = |axis: usize| {
        let mut along: Vec<f64> = all.iter().map(|one| one.reach.centre[axis]).collect();
        if along.is_empty() {
            return 0.0;
        }
        let tenth = along.len() / 10;
        let mut nth = |n| *along.select_nth_unstable_by(n, f64::total_cmp).1;
        nth(all.len() - 1 - tenth) - nth(tenth)
    };
    let largest = (0..3).map(spread).fold(0.0, f64::max);
    if largest == 0.0 || !largest.is_finite() {
        return None;
    }
    let side = |step: i32| largest * 2.0_f64.powf(-0.5 * f64::from(step));
    let is_sparse = |step: i32| {
        let keys = all.iter().map(|one| key(one.reach.centre, side(step)));
        let mut keys: Vec<u64> = keys.collect();
        keys.sort_unstable();
        let crowded = keys
            .chunk_by(|a, b| a == b)
            .filter(|cell| cell.len() > CROWD);
        2 * crowded.map(<[u64]>::len).sum::<usize>() <= all.len()
    };
    let (mut crowded, mut sparse) = (-1, STEPS);
    while sparse - crowded > 1 {
        let step = (crowded + sparse) / 2;
        match is_sparse(step) {
            true => sparse = step,
            false => crowded = step,
        }
    }
    Some(side(sparse))
}

/// The bits of a cell's number along an axis.
const BITS: u32 = 21;

/// A cell's key: neighbours along z have keys next to each other.
fn key(at: DVec3, cell: f64) -> u64 {
    let most = f64::from(1 << (BITS - 1)) - 2.0;
    let number = |along: f64| ((along / cell).floor().clamp(-most, most) + most + 1.0) as u64;
    number(at.x) << (2 * BITS) | number(at.y) << BITS | number(at.z)
}

/// The parts that are linked.
fn parts(all: &[WeightedPoint], cell: f64) -> Vec<Vec<u32>> {
    // What is in which cell: Gaussians by their centres, and by places on their axes.
    let mut inside: Vec<(u64, u32)> = Vec::with_capacity(all.len());
    for (index, WeightedPoint { reach, .. }) in all.iter().enumerate() {
        let index = index as u32;
        inside.push((key(reach.centre, cell), index));
        let axes = [reach.axes.x_axis, reach.axes.y_axis, reach.axes.z_axis];
        let mut lengths = axes.map(DVec3::length);
        lengths.sort_unstable_by(f64::total_cmp);
        if lengths[1] > LINKING * cell {
            continue;
        }
        for axis in axes {
            let places = (axis.length() / (2.0 * cell) - 0.5).ceil() as i32;
            let places = places.clamp(0, PLACES);
            for place in (-places..=places).filter(|place| *place != 0) {
                let at = reach.centre + axis * (f64::from(place) / f64::from(places));
                inside.push((key(at, cell), index));
            }
        }
    }
    inside.sort_unstable();
    let mut cells: Vec<u64> = inside.iter().map(|(cell, _)| *cell).collect();
    cells.dedup();
    let mut links = Links((0..(all.len() + cells.len()) as u32).collect());
    let of_cell = |index: usize| (all.len() + index) as u32;
    for (index, of_one) in inside.chunk_by(|a, b| a.0 == b.0).enumerate() {
        of_one
            .iter()
            .for_each(|(_, one)| links.link(*one, of_cell(index)));
    }
    // Each cell and its neighbours, rows of three along z: half of them, as the others are neighbours of it.
    for (x, y) in [(0, 0), (0, 1), (1, -1), (1, 0), (1, 1_i64)] {
        let row = (x << (2 * BITS)) + (y << BITS);
        let mut from = 0;
        for (index, cell) in cells.iter().enumerate() {
            let first = cell.wrapping_add_signed(row - 1);
            from += cells[from..]
                .iter()
                .take_while(|other| **other < first)
                .count();
            let near = cells[from..]
                .iter()
                .take_while(|other| **other <= first + 2);
            (0..near.count()).for_each(|more| links.link(of_cell(index), of_cell(from + more)));
        }
    }
    let mut by_root: Vec<(u32, u32)> = (0..all.len() as u32).map(|i| (links.root(i), i)).collect();
    by_root.sort_unstable();
    let parts = by_root.chunk_by(|a, b| a.0 == b.0);
    parts
        .map(|part| part.iter().map(|(_, index)| *index).collect())
        .collect()
}

/// A forest whose trees are what is linked: where each element leads to.
struct Links(Vec<u32>);

impl Links {
    fn root(&mut self, mut one: u32) -> u32 {
        while self.0[one as usize] != one {
            let next = self.0[self.0[one as usize] as usize];
            self.0[one as usize] = next;
            one = next;
        }
        one
    }

    fn link(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
