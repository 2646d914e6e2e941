//! The check that a scene fits. Linux promises memory that it does not have, and ends the process that takes it.

use rara::{Error, Result};

/// Bytes for each Gaussian: first in the process (236 with SH of degree 3) while it is made, and then in each renderer
/// that holds it: the same, a frame's working memory and its pairs of splat and tile.
const MADE: u64 = 300;
const HELD: u64 = 600;
/// Further bytes of each renderer: the driver, pictures and shaders.
const RENDERER: u64 = 256 << 20;

/// Returns an error if this machine has not enough memory for a scene in so many renderers. It does not check a GPU's
/// memory, whose driver refuses what it does not have.
pub(crate) fn check(gaussians: usize, renderers: u64) -> Result<()> {
    let needed = gaussians as u64 * (MADE + renderers * HELD) + renderers * RENDERER;
    match available() {
        Some(available) if available < needed => Err(Error::Memory(format!(
            "it takes about {} MiB and {} MiB are available",
            needed >> 20,
            available >> 20
        ))),
        _ => Ok(()),
    }
}

fn available() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kib << 10)
}
