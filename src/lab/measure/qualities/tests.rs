use super::*;

/// Pixels of this alpha; their colour is as bright.
fn picture(width: u32, height: u32, alpha: impl Fn(u32, u32) -> f32) -> Picture {
    let mut picture = Picture::filled(width, height, [0.0; 4]);
    for (i, pixel) in picture.pixels.iter_mut().enumerate() {
        *pixel = [alpha(i as u32 % width, i as u32 / width); 4];
    }
    picture
}

#[test]
fn a_moved_edge_is_as_far_away_as_it_was_moved() {
    let whole = picture(40, 30, |_, _| 1.0);
    // A ramp of four pixels crosses 1/2 at `at`.
    let ramp = |at: f32| {
        picture(40, 30, move |x, _| {
            (0.5 + (x as f32 - at) / 4.0).clamp(0.0, 1.0)
        })
    };
    for moved in [0.0, 0.25, 1.5, 6.0] {
        let apart = edge_distance(&ramp(12.3 + moved), &ramp(12.3), &whole).unwrap();
        assert!(
            (apart.unwrap() - f64::from(moved)).abs() < 1e-5,
            "{moved}: {apart:?}"
        );
    }
    let none = picture(40, 30, |_, _| 0.0);
    assert_eq!(edge_distance(&ramp(9.0), &none, &whole).unwrap(), None);
    assert_eq!(
        edge_distance(&none, &ramp(9.0), &whole).unwrap(),
        Some(25.0)
    );
    // Where the scene itself ends there is no edge of the cut.
    let half = picture(40, 30, |x, _| if x < 20 { 1.0 } else { 0.0 });
    assert_eq!(edge_distance(&half, &half, &half).unwrap(), None);
}

#[test]
fn one_spike_is_far_but_rare() {
    let whole = picture(40, 40, |_, _| 1.0);
    let flat = picture(40, 40, |x, _| if x >= 20 { 1.0 } else { 0.0 });
    let spiked = picture(40, 40, |x, y| {
        if x >= 20 || (y == 7 && x >= 10) {
            1.0
        } else {
            0.0
        }
    });
    let apart = edge_distance(&spiked, &flat, &whole).unwrap().unwrap();
    // Above and below the spike ten points each, at 0.7 to 9.5 px, and its end at 10: 60 points with the flat rest.
    assert!(apart > 0.5 && apart < 1.5, "{apart}");
}

#[test]
fn pieces_and_holes_without_a_counterpart_are_counted() {
    let at = |x: u32, y: u32, left: u32, top: u32| {
        (left..left + 2).contains(&x) && (top..top + 2).contains(&y)
    };
    let disc = |x: u32, y: u32| (x as f32 - 20.0).hypot(y as f32 - 20.0) < 12.0;
    let truth = picture(40, 40, |x, y| f32::from(u8::from(disc(x, y))));
    let of = |faults: u32| {
        picture(40, 40, move |x, y| {
            let floats = at(x, y, 2, 2) || faults > 2 && at(x, y, 36, 3);
            let hole = faults > 1 && at(x, y, 20, 20) || faults > 3 && at(x, y, 14, 20);
            f32::from(u8::from(disc(x, y) && !hole || floats))
        })
    };
    assert_eq!(pieces_apart(&truth, &truth).unwrap(), 0);
    for faults in 1..=4 {
        assert_eq!(pieces_apart(&of(faults), &truth).unwrap(), faults);
        assert_eq!(pieces_apart(&truth, &of(faults)).unwrap(), faults);
    }
    // A speck is not seen; and what touches the true piece is no other one.
    let speck = picture(40, 40, |x, y| {
        f32::from(u8::from(disc(x, y) || (x, y) == (3, 3)))
    });
    assert_eq!(pieces_apart(&speck, &truth).unwrap(), 0);
    let spike = picture(40, 40, |x, y| {
        f32::from(u8::from(disc(x, y) || y == 20 && x < 20))
    });
    assert_eq!(pieces_apart(&spike, &truth).unwrap(), 0);
}

#[test]
fn the_share_of_the_way_is_what_was_mixed_in() {
    let truth = picture(8, 8, |x, y| (x + y) as f32 / 20.0);
    let other = picture(8, 8, |x, y| if x < 4 { 1.0 } else { (x + y) as f32 / 20.0 });
    for share in [0.0_f32, 0.25, 1.0] {
        let mut mixed = truth.clone();
        for ((m, t), o) in mixed
            .pixels
            .iter_mut()
            .zip(&truth.pixels)
            .zip(&other.pixels)
        {
            *m = std::array::from_fn(|c| t[c] + share * (o[c] - t[c]));
        }
        let found = share_of_way(&mixed, &truth, &other).unwrap();
        assert!((found - f64::from(share)).abs() < 1e-6, "{share}: {found}");
    }
    assert_eq!(share_of_way(&other, &truth, &truth).unwrap(), 0.0);
    // What goes the other way is no share of it.
    let less = picture(8, 8, |x, y| 0.5 * (x + y) as f32 / 20.0);
    assert_eq!(share_of_way(&less, &truth, &other).unwrap(), 0.0);
}
