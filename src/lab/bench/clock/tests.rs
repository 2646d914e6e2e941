use super::*;
use rara::{FrameStats, PassTime};

#[test]
fn medians_and_minima() {
    let frame = |(gpu_ms, sort_ms, processor_ms)| {
        let mut stats = FrameStats::default();
        (stats.gpu_ms, stats.wall_ms) = (Some(gpu_ms), 5.0);
        let (name, ms) = ("sort", sort_ms);
        stats.passes.push(PassTime { name, ms });
        FrameTime {
            stats,
            processor_ms,
        }
    };
    let uncounted = [(4.0, 3.0, 0.0), (1.0, 1.0, 0.0), (9.0, 2.0, 0.0)].map(frame);
    let measured = summary(&uncounted, true);
    assert_eq!((measured.ms, measured.wall_ms), (4.0, 5.0));
    assert_eq!((measured.ms_min, measured.cost), (1.0, 1.0));
    let pass = &measured.passes[0];
    assert_eq!((pass.ms, pass.ms_min), (2.0, 1.0));
    assert_eq!((measured.cpu_ms, measured.cpu_ms_min), (0.0, 0.0));
    let counted = [(4.0, 3.0, 9.0), (1.0, 1.0, 8.0)].map(frame);
    let measured = summary(&counted, true);
    assert_eq!((measured.cost, measured.cpu_ms), (8.0, 8.5));
    let cost = summary(&counted, false).cost;
    assert_eq!(cost, 1.0, "a processor's time is not a GPU's");
}
