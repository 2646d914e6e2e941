//! A frame's spans on the device, set against the processor's clock.

use std::time::Instant;

use crate::renderer::RecordedFrame;
use crate::trace::{Note, Trace};
use rara_gpu::{Device, PassSpan};

/// Adds the stages of the frame that has just been waited for. Where the device's clock cannot be read, the first stage
/// begins with the submission, and the trace says so.
pub(super) fn add(
    trace: &Trace,
    device: &Device,
    frame: Option<&RecordedFrame>,
    submitted: Instant,
) {
    let info = device.info();
    let note = |key, words: &str| trace.note(key, Note::Text(words.into()));
    note("device", &info.name);
    note("driver", &info.driver);
    let spans = frame.map(RecordedFrame::pass_spans).unwrap_or_default();
    let Some(first) = spans.first() else {
        note("gpu_clock", "none: the device has no timestamps");
        return;
    };
    let (tick, at) = match device.calibrate() {
        Some(reading) => {
            note(
                "gpu_clock",
                "calibrated: the device's clock was read beside the processor's after each frame",
            );
            trace.note(
                "gpu_clock_within_us",
                Note::Number(reading.within.as_nanos() as f64 * 1e-3),
            );
            (reading.tick, reading.at)
        }
        None => {
            let how = "aligned: a frame's first stage is shown where the frame was submitted";
            note("gpu_clock", how);
            (first.begin, submitted)
        }
    };
    let support = device.support();
    let place = |then: u64| {
        let ticks = signed(then, tick, support.timestamp_bits);
        trace.at(at) + ticks as f64 * f64::from(support.timestamp_period) * 1e-3
    };
    let counted = frame
        .map(RecordedFrame::pass_statistics)
        .unwrap_or_default();
    for PassSpan { name, begin, end } in spans {
        let about = counted.iter().find(|pass| pass.name == name);
        let begin = place(begin);
        trace.gpu(name, [begin, place(end).max(begin)], about.copied());
    }
}

/// Ticks from one timestamp of `bits` bits to another, which may lie before it.
fn signed(to: u64, from: u64, bits: u32) -> i64 {
    let unused = 64 - bits.clamp(1, 64);
    (to.wrapping_sub(from) << unused).cast_signed() >> unused
}

#[cfg(test)]
mod tests {
    use super::signed;

    #[test]
    fn timestamps_lie_before_and_behind() {
        assert_eq!(signed(7, 10, 64), -3);
        assert_eq!(signed(10, 7, 36), 3);
        assert_eq!(signed((1 << 36) - 1, 1, 36), -2);
        assert_eq!(signed(1, (1 << 36) - 1, 36), 2);
    }
}
