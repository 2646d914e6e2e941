use super::*;
use crate::generate::Random;

fn evaluate(colours: &Colours, d: DVec3) -> DVec3 {
    colours
        .0
        .iter()
        .zip(basis(d))
        .map(|(c, b)| *c * b)
        .sum::<DVec3>()
        + 0.5
}

#[test]
fn plain_colours_come_back() {
    let colour = DVec3::new(0.1, 0.5, 0.9);
    let seen = evaluate(&Colours::plain(colour), DVec3::new(0.6, 0.0, -0.8));
    assert!(seen.abs_diff_eq(colour, 1e-12));
}

#[test]
fn lobes_are_sums_of_legendre_polynomials() {
    let mut random = Random::new(1);
    for _ in 0..50 {
        let (axis, d) = (random.direction(), random.direction());
        let bands = [0.3, -0.2, 0.7];
        let mut colours = Colours::plain(DVec3::splat(0.5));
        colours.add_zonal(axis, bands, DVec3::new(1.0, 2.0, 0.0));
        let t = axis.dot(d);
        let legendre = [t, 1.5 * t * t - 0.5, 2.5 * t * t * t - 1.5 * t];
        let expected: f64 = bands.iter().zip(legendre).map(|(b, p)| b * p).sum();
        let seen = evaluate(&colours, d) - 0.5;
        assert!(
            seen.abs_diff_eq(DVec3::new(expected, 2.0 * expected, 0.0), 1e-12),
            "{seen} {expected}"
        );
    }
}
