//! A viewer's report on its frames in the title of its window.

use std::fmt::Write;

use rara::FrameStats;

/// The time of all stages of a frame; none where none was timed.
pub(super) fn total(frame: &FrameStats) -> Option<f64> {
    let times = frame.passes.iter().map(|pass| pass.ms);
    times.reduce(|sum, ms| sum + ms)
}

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
    let Some((stats, total)) = stats.and_then(|stats| Some((stats, total(stats)?))) else {
        return text;
    };
    let mut most = stats.clone();
    most.passes.sort_by(|a, b| b.ms.total_cmp(&a.ms));
    most.passes.truncate(3);
    let most: Vec<String> = most
        .passes
        .iter()
        .map(|pass| format!("{} {:.1}", pass.name, pass.ms))
        .collect();
    let _ = write!(text, "; {total:.1} ms ({})", most.join(", "));
    text
}

#[cfg(test)]
mod tests;
