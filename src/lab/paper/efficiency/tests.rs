use super::*;

#[test]
fn frames_per_second_milliseconds_and_ratios_are_of_one_statistic() {
    let row = |mode: &str, wall: [f64; 5]| {
        let frames = wall.map(|wall_ms| {
            let mut frame = FrameStats::default();
            frame.wall_ms = wall_ms;
            frame
        });
        EfficiencyRow::new(mode, false, &frames)
    };
    // One frame that something else has disturbed makes the slower mode no faster.
    let rows = vec![
        row("Original", [8.0, 8.0, 10.0, 9.0, 7.0]),
        row("Hard", [5.0, 4.0, 6.0, 400.0, 4.5]),
    ];
    let table = table(&[Efficiency {
        scene: "s".into(),
        gaussians: 1,
        size: [8, 8],
        frames: 5,
        rows,
    }]);
    let csv = table.csv();
    let rows: Vec<_> = csv.lines().rev().take(2).collect();
    for (row, numbers) in rows.iter().zip([",200,1.6,4.5,5,6", ",125,1,8,8,9"]) {
        assert!(row.ends_with(numbers), "{row}");
    }
}
