use super::*;

/// A disc of alpha in a picture.
fn disc(size: u32, radius: f32) -> Picture {
    let middle = size as f32 / 2.0;
    let pixel = |at: u32| {
        let (x, y) = ((at % size) as f32 + 0.5, (at / size) as f32 + 0.5);
        let alpha = f32::from(u8::from((x - middle).hypot(y - middle) < radius));
        [0.0, 0.0, 0.0, alpha]
    };
    Picture {
        width: size,
        height: size,
        pixels: (0..size * size).map(pixel).collect(),
    }
}

#[test]
fn distances_are_those_to_the_nearest_pixel_of_the_other_side() {
    let (size, radius) = (40_usize, 11.0);
    let slice = disc(size as u32, radius);
    let covered: Vec<bool> = slice.pixels.iter().map(|p| p[3] > 0.5).collect();
    let ours = distances(&slice, 0.5);
    for at in 0..size * size {
        let apart = |other: usize| {
            let (x, y) = ((at % size) as f32, (at / size) as f32);
            (x - (other % size) as f32).hypot(y - (other / size) as f32)
        };
        let others = (0..size * size).filter(|&other| covered[other] != covered[at]);
        let least = others.map(apart).fold(f32::INFINITY, f32::min) - 0.5;
        let expected = if covered[at] { least } else { -least };
        assert!(
            (ours[at] - expected).abs() < 1e-4,
            "{at}: {} and {expected}",
            ours[at]
        );
    }
}

#[test]
fn distances_are_right_at_the_end_of_a_long_row() {
    let (width, height) = (9000_usize, 3_usize);
    let mut slice = Picture::filled(width as u32, height as u32, [0.0; 4]);
    let covered: Vec<(usize, usize)> = (0..width / 7).map(|i| (7 * i, i % height)).collect();
    for (x, y) in &covered {
        slice.pixels[y * width + x] = [1.0; 4];
    }
    for (at, &ours) in distances(&slice, 0.5).iter().enumerate() {
        let (x, y) = (at % width, at / width);
        let apart =
            |&(to, row): &(usize, usize)| (x as f64 - to as f64).hypot(y as f64 - row as f64);
        // The nearest is among these, since each seventh column has one.
        let near = x.saturating_sub(21) / 7..(x / 7 + 4).min(covered.len());
        let least = covered[near]
            .iter()
            .map(apart)
            .fold(f64::INFINITY, f64::min);
        let expected = if least == 0.0 { 0.5 } else { 0.5 - least };
        assert!(
            (f64::from(ours) - expected).abs() < 1e-3,
            "{x}, {y}: {ours} and {expected}"
        );
    }
}

#[test]
fn what_is_cut_becomes_opaque_and_its_edge_stays_soft() {
    let slice = |pixels: &[[f32; 4]]| Picture {
        width: pixels.len() as u32,
        height: 1,
        pixels: pixels.to_vec(),
    };
    let mut made = slice(&[
        [0.0; 4],
        [0.2, 0.1, 0.0, 0.25],
        [0.3, 0.6, 0.0, 0.75],
        [1.0; 4],
    ]);
    made.make_opaque(0.5);
    let expected = [
        [0.0; 4],
        [0.4, 0.2, 0.0, 0.5],
        [0.4, 0.8, 0.0, 1.0],
        [1.0; 4],
    ];
    let near = |[a, b]: [&[f32; 4]; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(made.pixels.iter().zip(&expected).all(|(a, b)| near([a, b])));
    made.put_before([0.0, 0.0, 1.0]);
    let expected = [
        [0.0, 0.0, 1.0, 1.0],
        [0.4, 0.2, 0.5, 1.0],
        [0.4, 0.8, 0.0, 1.0],
        [1.0; 4],
    ];
    assert!(made.pixels.iter().zip(&expected).all(|(a, b)| near([a, b])));
}

#[test]
fn cues_stay_near_the_edge_and_nothing_is_drawn_without() {
    let slice = disc(64, 20.0);
    let grey = Picture::filled(64, 64, [0.5, 0.5, 0.5, 1.0]);
    let mut drawn = grey.clone();
    drawn
        .draw_cues(&slice, &Cues::default())
        .expect("nothing to draw");
    assert_eq!(drawn, grey);
    let cue = |colour, width| Some(Cue { colour, width });
    let cues = Cues {
        outline: cue([1.0, 0.0, 0.0], 2.0),
        rim: cue([0.0, 0.0, 1.0], 8.0),
        ..Cues::default()
    };
    drawn
        .draw_cues(&slice, &cues)
        .expect("a slice of the same size");
    assert_eq!(drawn.at(32, 32), grey.at(32, 32), "the middle");
    assert_eq!(drawn.at(2, 2), grey.at(2, 2), "outside");
    let on_line = drawn.at(32 + 19, 32);
    assert!(on_line[0] > 0.9 && on_line[2] < 0.1, "{on_line:?}");
    let on_rim = drawn.at(32 + 15, 32);
    assert!(on_rim[2] > 0.6 && on_rim[0] < 0.4, "{on_rim:?}");
    // Of a slice that covers nothing, or everything, there is no edge.
    for alpha in [0.0, 1.0] {
        let mut drawn = grey.clone();
        let all = Picture::filled(64, 64, [0.0, 0.0, 0.0, alpha]);
        drawn.draw_cues(&all, &cues).expect("the same size");
        assert_eq!(drawn, grey);
    }
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let mut picture = Picture::filled(4, 4, [0.0; 4]);
    let other = Picture::filled(4, 5, [0.0; 4]);
    assert!(picture.draw_cues(&other, &Cues::default()).is_err());
    for width in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let cue = Cue {
            colour: [1.0; 3],
            width,
        };
        let cues = Cues {
            outline: Some(cue),
            ..Cues::default()
        };
        let slice = picture.clone();
        assert!(picture.draw_cues(&slice, &cues).is_err(), "{width}");
    }
}
