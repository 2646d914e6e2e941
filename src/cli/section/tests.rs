use super::*;

#[test]
fn shares_are_one_or_equal_steps() {
    let shares = |text| Steps::parse(text, share).map(|shares| shares.all().collect::<Vec<_>>());
    assert_eq!(shares("0.4"), Ok(vec![0.4]));
    assert_eq!(shares("40%"), shares("0.4"));
    assert_eq!(shares("0..1:5"), Ok(vec![0.0, 0.25, 0.5, 0.75, 1.0]));
    assert_eq!(shares("0%..100%:5"), shares("0..1:5"));
    let positions = Steps::parse("-3..1:3", position).map(|all| all.all().collect::<Vec<_>>());
    assert_eq!(positions, Ok(vec![-3.0, -1.0, 1.0]));
    assert_eq!(shares("0.9..0.1:2"), Ok(vec![0.9, 0.1]));
    assert_eq!(shares("0.2..0.4:1"), Ok(vec![0.30000000000000004]));
    for text in [
        "", "1.1", "-0.1", "nan", "0.1..0.9", "0..1:0", "0..2:3", "0..1:1e3", "..:1",
    ] {
        assert!(shares(text).is_err(), "{text}");
    }
}

#[test]
fn what_is_no_section_is_refused_with_what_would_be() {
    for (text, says) in [
        ("", "axial=50%"),
        ("w=0.5", "sagittal"),
        ("z=2", "from 0 to 1"),
        ("z=0.1..0.9", "FROM..TO:COUNT"),
        ("z=0.1..0.9:x", "number of sections"),
    ] {
        let error = wanted(text).expect_err(text);
        assert!(error.contains(says), "{text}: {error}");
    }
    for name in ["skin", "axial"] {
        assert_eq!(wanted(name), Ok(SectionRequest::Named(name.into(), false)));
    }
    assert_eq!(
        wanted("!skin"),
        Ok(SectionRequest::Named("skin".into(), true))
    );
    assert!(matches!(
        wanted("!z@-1..2:3"),
        Ok(SectionRequest::At { .. })
    ));
}
