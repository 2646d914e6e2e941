use super::*;

/// The numbers in the scene, layer by layer; the scene takes them.
fn found(layers: &[(usize, Option<&SetPart>)]) -> Vec<Vec<u32>> {
    let mut before = 0;
    let mut found = Vec::new();
    for (&(count, _), numbers) in layers.iter().zip(numbers(layers)) {
        let own: Vec<u32> = match numbers {
            Some((first, in_set)) => in_set.iter().map(|number| first + number).collect(),
            None => (before..before + count as u32).collect(),
        };
        assert_eq!(own.len(), count);
        before += count as u32;
        found.push(own);
    }
    let mut all = found.concat();
    all.sort_unstable();
    assert_eq!(all, (0..before).collect::<Vec<_>>(), "each once");
    found
}

#[test]
fn sets_are_numbered_one_after_the_other_whatever_of_them_is_there() {
    let set = Arc::new(5);
    let part = |numbers: &[u32]| SetPart {
        set: set.clone(),
        numbers: numbers.into(),
    };
    let (odd, even, last) = (part(&[1, 3]), part(&[0, 2]), part(&[4]));
    let none: [Vec<u32>; 0] = [];
    assert_eq!(found(&[]), none);
    assert!(numbers(&[(2, None), (3, None)]).iter().all(Option::is_none));
    let (a, b, c) = (Some(&odd), Some(&even), Some(&last));
    // All parts of the set, with another between them.
    assert_eq!(
        found(&[(2, a), (3, None), (2, b), (1, c), (1, None)]),
        [vec![1, 3], vec![5, 6, 7], vec![0, 2], vec![4], vec![8]]
    );
    // Some of them.
    assert_eq!(
        found(&[(1, None), (2, a), (1, c)]),
        [vec![0], vec![1, 2], vec![3]]
    );
    // The same one twice, and an empty one.
    let nothing = part(&[]);
    assert_eq!(
        found(&[(2, a), (2, a), (2, b), (0, Some(&nothing)), (1, c)]),
        [vec![0, 1], vec![3, 5], vec![2, 4], vec![], vec![6]]
    );
    // Another set of as many.
    let other = SetPart {
        set: Arc::new(5),
        numbers: vec![0, 1],
    };
    assert_eq!(
        found(&[(2, b), (2, Some(&other))]),
        [vec![0, 1], vec![2, 3]]
    );
}
