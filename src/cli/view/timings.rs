//! The lines that the key T prints.

use std::fmt::Write;
use std::time::Duration;

use rara::FrameStats;

use crate::output::grouped;
use crate::times;

/// The lines that the key T prints: the last frame that computed anything, and the time between frames since the last
/// time.
pub(super) fn lines(
    size: (u32, u32),
    stats: Option<&FrameStats>,
    intervals: &[Duration],
) -> String {
    let mut text = format!("window   {}x{}", size.0, size.1);
    if let Some(stats) = stats {
        let counts = &stats.counts;
        let _ = write!(
            text,
            "\ncounts   {} visible, {} cutoff, {} invisible, {} culled",
            grouped(counts.visible.into()),
            grouped(counts.cutoff.into()),
            grouped(counts.invisible.into()),
            grouped(counts.culled.into())
        );
        let _ = write!(
            text,
            "\npasses   {}\ntime     {} ms on the device, as {} ({})",
            times::line(stats),
            times::ms(times::total(stats), 2),
            stats.raster.path,
            stats.raster.reason
        );
    }
    if intervals.is_empty() {
        return text;
    }
    let mut intervals = intervals.to_vec();
    intervals.sort();
    let ms = |at: usize| intervals[at].as_secs_f64() * 1e3;
    let middle = ms(intervals.len() / 2);
    let _ = write!(
        text,
        "\nframes   {} in a row, {middle:.2} ms from one to the next at the median ({:.2} at least, {:.2} at most): {:.1} \
         a second",
        intervals.len(),
        ms(0),
        ms(intervals.len() - 1),
        1e3 / middle.max(1e-3)
    );
    text
}

#[cfg(test)]
mod tests;
