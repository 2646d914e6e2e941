use crate::{Gaussians, Kind, Layer, Scene, generate};

fn numbers(scene: &Scene<'_>) -> Vec<Vec<u32>> {
    let of_layer = |(layer, numbers): (&Layer<'_>, super::Numbers<'_>)| {
        let count = layer.gaussians().len() as u32;
        (0..count).map(|index| numbers.of(index)).collect()
    };
    scene
        .layers()
        .iter()
        .zip(scene.numbers())
        .map(of_layer)
        .collect()
}

#[test]
fn layers_number_on_and_parts_have_the_numbers_of_their_set() {
    let [two, three] = [2, 3].map(|count| generate(Kind::General, count, 1));
    let scene = Scene::from_iter([
        Layer::new("whole", &two),
        Layer::new("part", &three).numbered(2, &[0, 3, 4]),
        Layer::new("rest", &two).numbered(2, &[1, 2]),
        Layer::new("last", &two),
    ]);
    scene.check().expect("each number once");
    let expected = [vec![0, 1], vec![2, 5, 6], vec![3, 4], vec![7, 8]];
    assert_eq!(numbers(&scene), expected);
    let all: Vec<_> = scene.numbers().collect();
    let sets: Vec<_> = all.iter().map(super::Numbers::set).collect();
    assert_eq!(sets, [None, Some(2), Some(2), None]);
}

#[test]
fn numbers_count_the_room_of_the_layers_before() {
    let [two, three] = [2, 3].map(|count| generate(Kind::General, count, 1));
    let none = Gaussians::default();
    let scene = Scene::from_iter([
        Layer::new("more", &two).with_room(5),
        Layer::new("later", &none).with_room(4),
        Layer::new("less", &three).with_room(1),
        Layer::new("part", &two).numbered(12, &[1, 0]),
        Layer::new("last", &two),
    ]);
    scene.check().expect("each number once");
    let expected = [
        vec![0, 1],
        vec![],
        vec![9, 10, 11],
        vec![13, 12],
        vec![14, 15],
    ];
    assert_eq!(numbers(&scene), expected);
    assert_eq!((scene.gaussians(), scene.room()), (9, 16));
    let part = Layer::new("part", &two).numbered(0, &[1, 0]).with_room(3);
    let refused = Scene::from_iter([part]).check().expect_err("no room");
    assert!(refused.to_string().contains("leave no room"), "{refused}");
}

#[test]
fn numbers_that_are_missing_or_not_their_own_are_refused() {
    let two = generate(Kind::General, 2, 1);
    let none = Gaussians::default();
    for (first, numbers, words) in [
        (0, &[0][..], "2 Gaussians and 1 number "),
        (0, &[1, 1], "number 1, which another has too"),
        (0, &[0, 2], "number 2, and the scene's 2"),
        (u32::MAX, &[0, u32::MAX], "number 4294967295"),
    ] {
        let layers = [
            Layer::new("two", &two).numbered(first, numbers),
            Layer::new("none", &none),
        ];
        let error = Scene::from_iter(layers).check().expect_err(words);
        let text = error.to_string();
        assert!(text.contains(words) && text.contains("'two'"), "{text}");
    }
}
