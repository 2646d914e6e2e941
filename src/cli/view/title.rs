//! A viewer's report on its frames: a short one in the window's title, a long one on the terminal.

use std::fmt::Write;
use std::time::Duration;

use rara::FrameStats;

use crate::output::grouped;
use crate::times;

/// The title: what is shown, how it is cut, and where the last frame's time went on the device.
pub(super) fn title(
    scene: &str,
    mode: &str,
    cut: Option<&str>,
    stats: Option<&FrameStats>,
) -> String {
    let mut text = format!("rara: {scene}, {mode}");
    if let Some(cut) = cut {
        let _ = write!(text, ", {cut}");
    }
    let Some((stats, total)) = stats.and_then(|stats| Some((stats, times::total(stats)?))) else {
        return text;
    };
    let mut most = stats.clone();
    most.passes.sort_by(|a, b| b.ms.total_cmp(&a.ms));
    most.passes.truncate(3);
    let most = times::stages(&most, 1).join(", ");
    let _ = write!(text, "; {} ms ({most})", times::ms(Some(total), 1));
    text
}

/// The lines that the key T prints: the last frame that computed anything, and the time between frames since the last
/// time.
pub(super) fn lines(
    size: (u32, u32),
    stats: Option<&FrameStats>,
    intervals: &mut [Duration],
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
mod tests {
    use super::*;
    use rara::PassTime;

    fn stats() -> FrameStats {
        let pass = |name, ms| PassTime { name, ms };
        let mut stats = FrameStats::default();
        stats.passes = vec![
            pass("clip", 0.4),
            pass("project", 5.85),
            pass("sort", 3.0),
            pass("tiles", 14.25),
        ];
        stats
    }

    #[test]
    fn the_title_names_the_longest_stages() {
        let text = title(
            "hair.ply",
            "exact",
            Some("plane at -0.5000"),
            Some(&stats()),
        );
        assert_eq!(
            text,
            "rara: hair.ply, exact, plane at -0.5000; 23.5 ms (tiles 14.2, project 5.8, sort 3.0)"
        );
        assert_eq!(title("a.ply", "hard", None, None), "rara: a.ply, hard");
    }

    #[test]
    fn frames_in_a_row_are_summed_up_by_their_median() {
        let mut intervals = [40, 10, 20].map(Duration::from_millis);
        let text = lines((640, 480), Some(&stats()), &mut intervals);
        assert!(
            text.contains("window   640x480") && text.contains("tiles 14.25"),
            "{text}"
        );
        assert!(
            text.contains("20.00 ms") && text.contains("50.0 a second"),
            "{text}"
        );
        assert!(!lines((1, 1), None, &mut []).contains("frames"));
    }
}
