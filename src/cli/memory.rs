//! Host memory: what will not fit is known before it is taken.

use std::collections::HashSet;

use rara::{Error, Result};

use super::output::counted;

/// Bytes of a Gaussian of degree 3 here: position, scales, rotation, opacity and 48 numbers of colour.
const GAUSSIAN: u64 = 4 * (3 + 3 + 4 + 1 + 48);
/// Bytes of a pixel while a picture is drawn, read back and written, on a device that is this machine's processor.
const PIXEL: u64 = 64;
/// Bytes of a pixel of a picture that is kept while others are drawn.
const KEPT_PIXEL: u64 = 16;
/// Address space that drivers take for themselves: lavapipe with its compiler.
const DRIVER: u64 = 800 << 20;

/// Fails where so many Gaussians do not fit.
pub(super) fn check_gaussians(count: u64) -> Result<()> {
    check(
        count * GAUSSIAN,
        || counted(count, "Gaussian"),
        "ask for fewer",
    )
}

/// Fails where so many Gaussians do not fit beside a renderer that draws them on this machine's processor: it holds them too,
/// and their splats and pairs of a splat and a tile.
pub fn check_drawing(count: u64) -> Result<()> {
    check(
        4 * count * GAUSSIAN + DRIVER,
        || format!("{} and a renderer", counted(count, "Gaussian")),
        "ask for fewer",
    )
}

/// Fails where a picture of this size does not fit beside the driver and so many pixels of others that are kept for it. Of a
/// machine without a limit of address space the driver has its own to say.
pub(super) fn check_picture((width, height): (u32, u32), kept: u64) -> Result<()> {
    let pixels = u64::from(width) * u64::from(height);
    let driver = if address_space_is_limited() {
        DRIVER
    } else {
        0
    };
    check(
        pixels * PIXEL + kept * KEPT_PIXEL + driver,
        || {
            let beside = if driver > 0 { " with a driver" } else { "" };
            format!("a picture of {width}x{height}{beside}")
        },
        "draw a smaller one, or allow more (ulimit -v)",
    )
}

/// The same of pictures of these sizes, one after the other.
pub(super) fn check_pictures(sizes: impl Iterator<Item = (u32, u32)>, kept: u64) -> Result<()> {
    // Most runs have many pictures of one size.
    let sizes: HashSet<_> = sizes.collect();
    sizes
        .into_iter()
        .try_for_each(|size| check_picture(size, kept))
}

/// Fails where so many bytes are not to be had.
fn check(bytes: u64, what: impl Fn() -> String, remedy: &str) -> Result<()> {
    // Nothing is written there, so that this costs no memory: it asks whether addresses can be had.
    let mut probe = Vec::<u8>::new();
    let has_room = usize::try_from(bytes).is_ok_and(|bytes| probe.try_reserve_exact(bytes).is_ok());
    let available = available();
    if has_room && available.is_none_or(|available| bytes <= available) {
        return Ok(());
    }
    let there = match available {
        Some(there) if bytes > there => format!("of which {} MiB are free", there >> 20),
        _ => "more than this process can have".into(),
    };
    let (what, mebibytes) = (what(), bytes.div_ceil(1 << 20));
    Err(Error::Memory(format!(
        "there is not enough memory for {what}: this takes about {mebibytes} MiB, {there}; {remedy}"
    )))
}

/// Bytes that the system can give away without swapping; none where it does not say.
fn available() -> Option<u64> {
    let memory = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = memory
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kib.saturating_mul(1024))
}

/// True under `ulimit -v`.
pub(super) fn address_space_is_limited() -> bool {
    let limits = std::fs::read_to_string("/proc/self/limits").unwrap_or_default();
    let line = limits
        .lines()
        .find_map(|line| line.strip_prefix("Max address space"));
    line.is_some_and(|line| !line.trim_start().starts_with("unlimited"))
}
