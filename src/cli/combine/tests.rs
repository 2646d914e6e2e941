use super::*;

fn frame(gpu_ms: f64, visible: u32, sort: Option<f64>) -> FrameStats {
    let mut frame = FrameStats::default();
    frame.gpu_ms = Some(gpu_ms);
    frame.counts.visible = visible;
    frame.counts.drawn = visible;
    frame.passes.push(PassTime {
        name: "classify",
        ms: 1.0,
    });
    match sort {
        Some(ms) => frame.passes.push(PassTime { name: "sort", ms }),
        None => frame.skipped.push("sort"),
    }
    frame
}

fn sorting(frame: &FrameStats) -> Option<f64> {
    times::of_stage(frame, "sort")
}

#[test]
fn medians_means_and_sums() {
    let frames = [
        frame(9.0, 10, Some(3.0)),
        frame(1.0, 30, None),
        frame(2.0, 20, Some(6.0)),
    ];
    let median = combine(&frames, Combine::Median);
    assert_eq!((median.gpu_ms, median.counts.visible), (Some(2.0), 20));
    assert_eq!(sorting(&median), Some(3.0));
    assert!(median.skipped.is_empty());
    let parts = [
        FrameSummary::from_frames(&frames[..1]),
        FrameSummary::from_frames(&frames[1..]),
    ];
    let all = FrameSummary::all(parts.iter());
    assert_eq!((all.samples, all.stats.gpu_ms), (3, Some(5.25)));
    assert_eq!(
        (all.least.gpu_ms, all.greatest.gpu_ms),
        (Some(1.0), Some(9.0))
    );
    let mean = combine(&frames, Combine::Mean);
    assert_eq!((mean.gpu_ms, sorting(&mean)), (Some(4.0), Some(3.0)));
    assert_eq!(combine(&frames[1..2], Combine::Median), frames[1]);
    assert_eq!(combine(&frames[1..], Combine::Median).gpu_ms, Some(1.5));
    assert_eq!(
        combine(&[FrameStats::default()], Combine::Mean).gpu_ms,
        None
    );
    let together = FrameSummary::together(parts.iter());
    assert_eq!((together.samples, together.stats.gpu_ms), (3, Some(10.5)));
    assert_eq!(sorting(&together.stats), Some(6.0));
    assert_eq!(
        (together.least.gpu_ms, together.greatest.gpu_ms),
        (Some(10.0), Some(11.0))
    );
}

#[test]
fn a_stage_is_timed_or_skipped_and_never_both() {
    let frames = |ran: usize, of: usize| {
        let frame = |index| frame(1.0, 1, (index < ran).then_some(2.0));
        (0..of).map(frame).collect::<Vec<_>>()
    };
    for (ran, of, median, mean) in [
        (0, 3, None, None),
        (1, 3, None, Some(2.0 / 3.0)),
        (1, 2, Some(1.0), Some(1.0)),
        (2, 3, Some(2.0), Some(4.0 / 3.0)),
    ] {
        for (how, expected) in [(Combine::Median, median), (Combine::Mean, mean)] {
            let combined = combine(&frames(ran, of), how);
            assert_eq!(sorting(&combined), expected, "{ran} of {of}, {how:?}");
            assert_eq!(combined.skipped.contains(&"sort"), expected.is_none());
        }
    }
    // Where nothing is timed, stages that most frames skipped are those that are skipped.
    let untimed = |ran, of| {
        let mut all = frames(ran, of);
        all.iter_mut().for_each(|frame| {
            frame.gpu_ms = None;
            frame.passes.clear();
        });
        combine(&all, Combine::Median).skipped
    };
    assert_eq!((untimed(2, 3), untimed(1, 3)), (vec![], vec!["sort"]));
    assert!(combine(&[], Combine::Sum).wall_ms.is_sign_positive());
}
