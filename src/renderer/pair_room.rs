//! How many pairs of tile and splat a frame has room for. It follows from earlier frames, since nothing is read back within
//! one, and from an estimate, so that a first frame has the room too.

use rara_base::error::{Error, Result};

/// The room before any frame has shown how many pairs there are: this many a Gaussian, where most are small, and this many
/// a tile, where they are few and large.
const USUAL_PER_GAUSSIAN: u32 = 2;
const USUAL_PER_TILE: u32 = 64;
/// The most pairs, 1.5 GiB of lists, or 2.2 GiB with the pipelines for GPUs: frames with more have coarse lists.
pub(super) const MOST: u32 = 1 << 27;

/// Where the device has no memory, lists of half the room are tried down to so many pairs.
const LEAST: u32 = 1 << 12;

/// The room for pairs. It grows with the frames' needs, and does not shrink.
#[derive(Debug, Clone, Copy)]
pub(super) struct PairRoom {
    room: u32,
    /// Less than [`MOST`] once the device has had no memory for them.
    most: u32,
    /// The room that there is without the growth for the next frame.
    least: u32,
    /// The room that an estimate asked for; `None` once the device has had no memory for one.
    expected: Option<u32>,
    growth: Growth,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Growth {
    /// It grows with what frames need.
    Free,
    /// It does not under this budget, which had no room for more.
    Held(u64),
    /// It does not: a host has reserved so much and no more.
    Fixed,
}

impl Default for PairRoom {
    fn default() -> Self {
        Self {
            room: 0,
            most: MOST,
            least: 0,
            expected: Some(0),
            growth: Growth::Free,
        }
    }
}

impl PairRoom {
    /// The room that a host has reserved, which neither grows nor shrinks.
    pub(super) fn fixed(pairs: u32) -> Self {
        Self {
            room: pairs,
            most: pairs,
            least: pairs,
            growth: Growth::Fixed,
            ..Self::default()
        }
    }

    /// True when it does not grow.
    pub(super) fn is_fixed(&self) -> bool {
        self.growth == Growth::Fixed
    }

    /// The room that scenes of `gaussians` in pictures of `tiles` usually need.
    pub(super) fn usual(gaussians: u32, tiles: u32) -> u32 {
        gaussians
            .saturating_mul(USUAL_PER_GAUSSIAN)
            .saturating_add(tiles.saturating_mul(USUAL_PER_TILE))
            .min(gaussians.saturating_mul(tiles))
            .min(MOST)
    }

    /// Room for a scene of `gaussians` in a picture of `tiles`, after a frame that had, or would have had, `needed` pairs.
    pub(super) fn make(&mut self, gaussians: u32, tiles: u32, needed: u32) {
        if self.is_fixed() {
            return;
        }
        let usual = Self::usual(gaussians, tiles).min(self.most);
        self.least = self.room.max(usual);
        if self.can_grow_to(needed) {
            self.room = with_margin(needed);
        }
        self.room = self.room.max(usual);
    }

    /// Makes room for a frame that has about so many pairs, and for half as many more: estimates err, and the next camera may
    /// see more. Pairs that would not fit anyway are no reason to take memory.
    pub(super) fn expect(&mut self, estimated: u32) {
        let room = estimated.saturating_add(estimated / 2);
        let can_grow = self.growth == Growth::Free && self.expected.is_some();
        if room <= self.most && room > self.room && can_grow {
            self.room = room;
            self.expected = Some(room);
        }
    }

    /// Takes back room after an error for want of memory, so that the frame is tried in less; the error where nothing is left to
    /// take.
    pub(super) fn retry(
        &mut self,
        error: Error,
        budget: Option<u64>,
        has_lists: bool,
    ) -> Result<()> {
        match error {
            Error::Budget(_) if self.hold(budget) => Ok(()),
            Error::Memory(_) if has_lists && self.room > LEAST => {
                self.refuse();
                Ok(())
            }
            error => Err(error),
        }
    }

    /// Takes back the growth since the frame before, for which a budget has no room; there is no more as long as it is the
    /// budget. False where nothing had grown.
    fn hold(&mut self, budget: Option<u64>) -> bool {
        let has_grown = self.room > self.least;
        if has_grown {
            self.room = self.least;
            self.growth = budget.map_or(Growth::Free, Growth::Held);
        }
        has_grown
    }

    /// Lets it grow again if the budget is another one.
    pub(super) fn review(&mut self, budget: Option<u64>) {
        if matches!(self.growth, Growth::Held(held) if Some(held) != budget) {
            self.growth = Growth::Free;
        }
    }

    /// True when there is no room for so many pairs, but can be. Pairs that would not fit anyway are no reason to take
    /// memory.
    pub(super) fn can_grow_to(&self, needed: u32) -> bool {
        self.growth == Growth::Free && needed > self.room && with_margin(needed) <= self.most
    }

    /// Notes that the device has no memory for so many pairs. Where only an estimate has asked for them, the frames' own
    /// needs count from now on.
    fn refuse(&mut self) {
        if self.is_fixed() {
            self.growth = Growth::Free;
        }
        if self.expected == Some(self.room) {
            self.expected = None;
        } else {
            self.most = self.room / 2;
        }
        self.room = 0;
    }

    /// Allows fewer pairs, as on a device with less memory.
    #[cfg(test)]
    pub(super) fn limited(most: u32) -> Self {
        Self {
            most,
            ..Self::default()
        }
    }

    pub(super) fn room(&self) -> u32 {
        self.room
    }
}

/// Adds a margin, so that a frame that needs a little more than the one before does not allocate again.
fn with_margin(needed: u32) -> u32 {
    needed.saturating_add(needed / 4)
}

#[cfg(test)]
mod tests;
