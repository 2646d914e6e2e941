//! The text of a selection, `--select NAME=PREDICATE`, and what it takes of two Gaussians.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rara::Gaussians;
use rara::scene::Predicate;
use rara_fuzz::{assert_readable, within};

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    // A range of four bytes is two f64; a shape of twenty-one is a shape and its region.
    let predicate = match within(4 << 10, 256, bytes, || text.parse::<Predicate>()) {
        Ok(predicate) => predicate,
        Err(error) => return assert_readable(&error),
    };
    let again: Predicate = predicate.to_string().parse().expect("its own text");
    assert_eq!(again.to_string(), predicate.to_string());
    let mut gaussians = Gaussians::default();
    let turn = glam::Quat::IDENTITY;
    gaussians.push(glam::Vec3::ZERO, glam::Vec3::ONE, turn, 0.5, &[0.0; 3]);
    gaussians.push(glam::Vec3::X, glam::Vec3::ONE, turn, 1.0, &[1.0; 3]);
    // A property that no file has brought along is an error; otherwise each Gaussian is in one of the parts.
    match predicate.split(gaussians, &[]) {
        Ok([rest, taken]) => assert_eq!(rest.gaussians.len() + taken.gaussians.len(), 2),
        Err(error) => assert_readable(&error),
    }
});
