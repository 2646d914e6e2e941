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
