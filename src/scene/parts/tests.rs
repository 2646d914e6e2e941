use super::*;
use crate::{Kind, generate};

#[test]
fn parts_hold_every_gaussian_once_and_in_order() {
    let mut whole = generate(Kind::General, 1_000, 3);
    whole.set_antialiased(true);
    let part_of: Vec<u32> = (0..1_000_u32)
        .map(|i| i.wrapping_mul(2_654_435_761) % 3)
        .collect();
    let parts = whole.clone().into_parts(&part_of, 4).unwrap();
    assert!(parts[3].gaussians.is_empty());
    let mut found = 0;
    for (number, part) in parts.iter().enumerate() {
        assert!(part.numbers.is_sorted());
        assert_eq!(part.gaussians.sh_degree(), whole.sh_degree());
        assert!(part.gaussians.is_antialiased());
        for (index, &source) in part.numbers.iter().enumerate() {
            let source = source as usize;
            assert_eq!(part_of[source] as usize, number);
            let mut one = Gaussians::default();
            one.set_sh_degree(whole.sh_degree());
            let mut other = one.clone();
            one.push_from(&part.gaussians, index);
            other.push_from(&whole, source);
            assert_eq!(one, other);
            found += 1;
        }
    }
    assert_eq!(found, 1_000);
}

#[test]
fn what_divides_nothing_is_refused() {
    let whole = generate(Kind::General, 2, 3);
    for (part_of, parts, words) in [
        (&[0][..], 1, "one each"),
        (&[0, 1], 1, "Gaussian 1 goes to part 1 of 1"),
        (&[0, 0], 0, "part 0 of 0"),
    ] {
        let mut set = whole.clone();
        let error = set.divide(part_of, parts).expect_err(words);
        assert!(error.to_string().contains(words), "{error}");
        assert_eq!(set, whole, "as it was");
    }
    let none = Gaussians::default().into_parts(&[], 2).unwrap();
    assert_eq!(none, vec![Part::default(); 2]);
}
