use super::*;

#[test]
fn a_codebook_has_all_of_few_values_and_is_near_to_many() {
    let few = [3.0, -1.0, 0.25, 3.0];
    let book = Codebook::from_values(few.into_iter());
    few.iter()
        .for_each(|value| assert_eq!(book.0[usize::from(book.nearest(*value))], *value));
    let book = Codebook::from_values((0..10_000).map(f64::from));
    for value in (0..10_000).map(f64::from) {
        let near = book.0[usize::from(book.nearest(value))];
        assert!((near - value).abs() < 60.0, "{value} is {near}");
    }
    assert_eq!(Codebook::from_values(std::iter::empty()).0, [0.0; NUMBERS]);
}

#[test]
fn sets_hold_what_is_alike() {
    let vectors: Vec<f32> = (0..64)
        .flat_map(|at| [(at % 8) as f32, 100.0 * (at / 8) as f32])
        .collect();
    let (labels, means) = sets(&vectors, 2, 8);
    assert_eq!(means.len(), 16);
    for (vector, &label) in vectors.chunks(2).zip(&labels) {
        let mean = &means[2 * usize::from(label)..][..2];
        assert!((mean[1] - vector[1]).abs() < 1.0, "{vector:?} {mean:?}");
    }
    let (labels, means) = sets(&vectors, 2, 64);
    assert_eq!((labels[63], means), (63, vectors));
}
