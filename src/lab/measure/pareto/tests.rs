use super::undominated;

#[test]
fn the_front_is_what_nothing_beats_twice() {
    let points = [
        [3.0, 1.0],
        [1.0, 3.0],
        [2.0, 2.0],
        [2.0, 2.5],
        [4.0, 1.0],
        [2.5, 2.0],
    ];
    assert_eq!(undominated(&points), [1, 2, 0]);
}

#[test]
fn ties_stay_and_what_is_no_number_does_not() {
    let points = [[1.0, 1.0], [f64::NAN, 0.0], [1.0, 1.0], [0.5, f64::NAN]];
    assert_eq!(undominated(&points), [0, 2]);
    assert!(undominated(&[]).is_empty());
}

#[test]
fn every_point_left_out_is_beaten_by_one_that_stays() {
    let mut state = 3_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 28)
    };
    let points: Vec<[f64; 2]> = (0..200).map(|_| [next(), next()]).collect();
    let best = undominated(&points);
    for (i, p) in points.iter().enumerate() {
        let beaten = best
            .iter()
            .any(|&b| points[b][0] <= p[0] && points[b][1] <= p[1]);
        assert!(beaten);
        assert_eq!(best.contains(&i), best.iter().any(|&b| points[b] == *p));
    }
}
