//! The times of a frame's stages, as people read them. A stage that did not run has none.

use rara::FrameStats;

/// Milliseconds with so many decimals; a dash where nothing was timed.
pub(super) fn ms(time: Option<f64>, decimals: usize) -> String {
    time.map_or_else(|| "-".into(), |ms| format!("{ms:.decimals$}"))
}

pub(super) fn sum(times: impl IntoIterator<Item = f64>) -> f64 {
    // The iterator's own `sum` of nothing is -0.
    times.into_iter().fold(0.0, |sum, ms| sum + ms)
}

/// The time of one stage; none where it did not run.
pub(super) fn of_stage(frame: &FrameStats, name: &str) -> Option<f64> {
    let passes = frame.passes.iter().filter(|pass| pass.name == name);
    passes.map(|pass| pass.ms).reduce(|sum, ms| sum + ms)
}

/// The time of all stages; none where none was timed.
#[cfg(feature = "view")]
pub(super) fn total(frame: &FrameStats) -> Option<f64> {
    let is_timed = !frame.passes.is_empty();
    is_timed.then(|| sum(frame.passes.iter().map(|pass| pass.ms)))
}

pub(super) fn stages(frame: &FrameStats, decimals: usize) -> Vec<String> {
    let stage = |pass: &rara::PassTime| format!("{} {}", pass.name, ms(Some(pass.ms), decimals));
    frame.passes.iter().map(stage).collect()
}

/// The same on a line, with those that were skipped.
pub(super) fn line(frame: &FrameStats) -> String {
    let mut parts = stages(frame, 2);
    if !frame.skipped.is_empty() {
        parts.push(format!("(skipped: {})", frame.skipped.join(", ")));
    }
    parts.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use rara::PassTime;

    #[test]
    fn what_did_not_run_has_no_time() {
        let mut frame = FrameStats::default();
        assert_eq!((total(&frame), line(&frame)), (None, String::new()));
        frame.skipped.push("sort");
        assert_eq!(line(&frame), "(skipped: sort)");
        let pass = |name, ms| PassTime { name, ms };
        frame.passes = vec![pass("clip", 0.25), pass("tiles", 1.0), pass("clip", 0.5)];
        assert_eq!(of_stage(&frame, "clip"), Some(0.75));
        assert_eq!(of_stage(&frame, "sort"), None);
        assert_eq!(ms(total(&frame), 1) + &ms(None, 1), "1.8-");
        frame.passes.pop();
        assert_eq!(line(&frame), "clip 0.25 tiles 1.00 (skipped: sort)");
        assert!(sum([]).is_sign_positive());
    }
}
