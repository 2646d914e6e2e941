use super::*;
use rara::PassTime;

fn stats() -> FrameStats {
    let mut stats = FrameStats::default();
    stats.passes = vec![PassTime {
        name: "tiles",
        ms: 14.25,
    }];
    stats
}

#[test]
fn frames_in_a_row_are_summed_up_by_their_median() {
    let intervals = [40, 10, 20].map(Duration::from_millis);
    let text = lines((640, 480), Some(&stats()), &intervals);
    assert!(
        text.contains("window   640x480") && text.contains("tiles 14.25"),
        "{text}"
    );
    assert!(
        text.contains("20.00 ms") && text.contains("50.0 a second"),
        "{text}"
    );
    assert!(!lines((1, 1), None, &[]).contains("frames"));
}
