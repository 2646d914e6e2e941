use super::*;

#[test]
fn parts_are_all_of_it_and_nearly_alike() {
    for count in [0, 1, 7, 10, 1000] {
        for of in [1, 3, 10, 11] {
            let parts: Vec<Vec<u32>> = (1..=of)
                .map(|number| RunPart { number, of }.take_from((0..count).collect()))
                .collect();
            assert!(parts.concat().into_iter().eq(0..count), "{count} by {of}");
            let sizes = parts.iter().map(Vec::len);
            let (least, most) = (sizes.clone().min(), sizes.max());
            assert!(most <= least.map(|least| least + 1), "{count} by {of}");
        }
    }
}

#[test]
fn parts_are_read_as_they_are_written() {
    assert_eq!("3/10".parse(), Ok(RunPart { number: 3, of: 10 }));
    assert_eq!(
        "1/1".parse().map(|part: RunPart| part.to_string()),
        Ok("1/1".into())
    );
    for wrong in [
        "",
        "3",
        "0/10",
        "11/10",
        "1/0",
        "-1/3",
        "a/b",
        "1/2/3",
        "1/4294967296",
    ] {
        assert!(wrong.parse::<RunPart>().is_err(), "{wrong}");
    }
}
