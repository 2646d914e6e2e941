//! Clusters: Gaussians that touch each other, one by the next. What floats in the air of a scan is in small ones.

use std::collections::HashMap;
use std::ops::Range;

use glam::{DMat3, DVec3};

use crate::gaussians::Gaussians;

/// How far a Gaussian reaches, in its standard deviations.
const REACH: f64 = 2.0;

/// The clusters of a set of Gaussians. Two Gaussians touch unless a plane across the line between their centres parts their
/// ellipsoids of two standard deviations, and all that are joined by touching ones are a cluster. Neither moving, turning nor
/// scaling the set changes them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Clusters {
    /// The cluster of each Gaussian.
    of: Vec<u32>,
    /// How many Gaussians each has, the largest first.
    sizes: Vec<u32>,
}

impl Clusters {
    /// Finds the clusters. It takes seconds for millions of Gaussians.
    pub fn of(gaussians: &Gaussians) -> Self {
        let bodies: Vec<Body> = (0..gaussians.len())
            .map(|index| Body::of(gaussians, index))
            .collect();
        let mut sets = Sets::new(bodies.len());
        Grid::new(&bodies).join(&mut sets);
        sets.clusters()
    }

    /// How many Gaussians are in the cluster of this one.
    pub fn size_at(&self, index: usize) -> u32 {
        self.sizes[self.of[index] as usize]
    }

    /// True when no cluster is larger than that of this Gaussian; of several that are as large, that of the first Gaussian is.
    pub fn is_in_largest(&self, index: usize) -> bool {
        self.of[index] == 0
    }

    /// How many Gaussians each has, the largest first.
    pub fn sizes(&self) -> &[u32] {
        &self.sizes
    }
}

/// The ellipsoid of a Gaussian.
struct Body {
    centre: DVec3,
    /// The rows are its axes times half its lengths.
    axes: DMat3,
    /// Half its longest axis.
    radius: f64,
}

impl Body {
    fn of(gaussians: &Gaussians, index: usize) -> Self {
        let half = REACH * gaussians.scales()[index].as_dvec3();
        let turn = DMat3::from_quat(gaussians.rotations()[index].as_dquat().normalize());
        Self {
            centre: gaussians.positions()[index].as_dvec3(),
            axes: (turn * DMat3::from_diagonal(half)).transpose(),
            radius: half.max_element(),
        }
    }

    /// True unless a plane across the line between their centres parts them.
    fn touches(&self, other: &Self) -> bool {
        let between = other.centre - self.centre;
        let square = between.length_squared();
        let most = self.radius + other.radius;
        // The reach along the line, times the line's length.
        let reach = |body: &Self| (body.axes * between).length();
        square <= most * most && square <= reach(self) + reach(other)
    }
}

/// Sets that are joined, by their members.
struct Sets {
    /// A member that is nearer to the set's first one, which is its own.
    parents: Vec<u32>,
}

impl Sets {
    fn new(count: usize) -> Self {
        Self {
            parents: (0..count as u32).collect(),
        }
    }

    /// The member by which a set is known.
    fn find(&mut self, mut member: u32) -> u32 {
        while self.parents[member as usize] != member {
            let parent = self.parents[member as usize];
            self.parents[member as usize] = self.parents[parent as usize];
            member = self.parents[member as usize];
        }
        member
    }

    /// Joins the sets of two members. The lower first member stays that of both.
    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }

    fn clusters(mut self) -> Clusters {
        let first: Vec<u32> = (0..self.parents.len() as u32)
            .map(|member| self.find(member))
            .collect();
        let mut counts = vec![0_u32; first.len()];
        first.iter().for_each(|&first| counts[first as usize] += 1);
        let mut order: Vec<u32> = (0..first.len() as u32).collect();
        order.retain(|&member| counts[member as usize] > 0);
        order.sort_by_key(|&member| (std::cmp::Reverse(counts[member as usize]), member));
        let mut ranks = vec![0; first.len()];
        for (rank, &member) in (0..).zip(&order) {
            ranks[member as usize] = rank;
        }
        Clusters {
            of: first.iter().map(|&first| ranks[first as usize]).collect(),
            sizes: order
                .iter()
                .map(|&member| counts[member as usize])
                .collect(),
        }
    }
}

/// A cell of a level: its level, and its place in cells of this level.
type Cell = (i32, [i64; 3]);

/// The bodies of a cell.
struct Members {
    range: Range<usize>,
    /// True once all of them are known to be in one set.
    are_joined: bool,
}

/// Bodies by size and place. A level's cells are as wide as two of its largest bodies together reach, so that a body touches bodies
/// of its own level or of coarser ones only in the cell of its centre and in those around it. A cell is a part of one coarser cell.
struct Grid<'a> {
    bodies: &'a [Body],
    /// Their numbers, cell by cell.
    numbers: Vec<u32>,
    /// The cells, the finest first.
    cells: Vec<(Cell, Members)>,
    at: HashMap<Cell, usize>,
    /// The levels that have cells, the finest first.
    levels: Vec<i32>,
}

impl<'a> Grid<'a> {
    fn new(bodies: &'a [Body]) -> Self {
        let mut levels: Vec<i32> = bodies.iter().map(|body| level(body.radius)).collect();
        levels.sort_unstable();
        // Much smaller bodies than most are few, and go to a level that is coarse enough for all; so do points without an extent.
        let usual = levels.get(levels.len() / 2).copied().unwrap_or_default();
        let widest = bodies.iter().map(|body| body.centre.abs().max_element());
        let finest = (usual - 4).max(level(widest.fold(0.0, f64::max)) - 30);
        let cell = |body: &Body| {
            let level = level(body.radius).max(finest);
            let place = (body.centre / side(level)).floor().to_array();
            (level, place.map(|at| at as i64))
        };
        let mut all: Vec<(Cell, u32)> = bodies.iter().map(cell).zip(0..).collect();
        all.sort_unstable();
        let mut cells = Vec::new();
        let mut begin = 0;
        for of_cell in all.chunk_by(|(a, _), (b, _)| a == b) {
            let end = begin + of_cell.len();
            let members = Members {
                range: begin..end,
                are_joined: false,
            };
            cells.push((of_cell[0].0, members));
            begin = end;
        }
        levels
            .iter_mut()
            .for_each(|level| *level = finest.max(*level));
        levels.dedup();
        Self {
            bodies,
            numbers: all.into_iter().map(|(_, number)| number).collect(),
            at: cells.iter().map(|(cell, _)| *cell).zip(0..).collect(),
            cells,
            levels,
        }
    }

    /// Joins all that touch.
    fn join(&mut self, sets: &mut Sets) {
        for index in 0..self.cells.len() {
            self.join_within(index, sets);
        }
        for index in 0..self.cells.len() {
            self.note_joined(index, sets);
            let (level, place) = self.cells[index].0;
            for other in self.levels.iter().filter(|other| **other >= level) {
                let up = (other - level).min(63);
                let around = |at: i64| (at >> up) - 1..=(at >> up) + 1;
                let [x, y, z] = place.map(around);
                for place in x.flat_map(|x| {
                    let z = z.clone();
                    y.clone()
                        .flat_map(move |y| z.clone().map(move |z| [x, y, z]))
                }) {
                    // Each two cells of a level are looked at once.
                    let near = self.at.get(&(*other, place));
                    if let Some(&near) = near.filter(|near| **near > index) {
                        self.join_two([index, near], sets);
                    }
                }
            }
        }
    }

    fn members(&self, cell: usize) -> &[u32] {
        &self.numbers[self.cells[cell].1.range.clone()]
    }

    fn touch(&self, a: u32, b: u32) -> bool {
        self.bodies[a as usize].touches(&self.bodies[b as usize])
    }

    /// Joins the bodies of a cell that touch. None of them is in a set with another one before.
    fn join_within(&self, cell: usize, sets: &mut Sets) {
        let members = self.members(cell);
        let mut left = members.len() - 1;
        for (at, &a) in members.iter().enumerate() {
            for &b in &members[at + 1..] {
                if left == 0 {
                    return;
                }
                if sets.find(a) != sets.find(b) && self.touch(a, b) {
                    sets.join(a, b);
                    left -= 1;
                }
            }
        }
    }

    /// Finds out whether the bodies of a cell are in one set.
    fn note_joined(&mut self, cell: usize, sets: &mut Sets) {
        if !self.cells[cell].1.are_joined {
            let members = self.members(cell);
            let first = sets.find(members[0]);
            self.cells[cell].1.are_joined = members.iter().all(|&one| sets.find(one) == first);
        }
    }

    /// Joins the bodies of one cell with those of another that they touch.
    fn join_two(&self, cells: [usize; 2], sets: &mut Sets) {
        let are_joined = cells.map(|cell| self.cells[cell].1.are_joined) == [true; 2];
        let [some, others] = cells.map(|cell| self.members(cell));
        for &a in some {
            for &b in others {
                if sets.find(a) == sets.find(b) {
                    if are_joined {
                        return;
                    }
                } else if self.touch(a, b) {
                    sets.join(a, b);
                }
            }
        }
    }
}

/// The level of bodies of a radius; that of those without an extent is below all.
fn level(radius: f64) -> i32 {
    radius.max(f64::MIN_POSITIVE).log2().floor() as i32
}

/// How wide the cells of a level are: twice as wide as any radius of it.
fn side(level: i32) -> f64 {
    2_f64.powi(level + 2)
}

#[cfg(test)]
mod tests;
