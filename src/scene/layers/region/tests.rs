use super::*;

fn bounds() -> Bounds {
    Bounds {
        min: DVec3::new(-1.0, 2.0, 10.0),
        max: DVec3::new(1.0, 4.0, 30.0),
    }
}

#[test]
fn planes_and_slabs_lie_at_shares_of_the_bounds() {
    for (typed, means) in [
        ("plane:x=25%", "plane:1,0,0,0.5"),
        ("!plane:axial=50%", "!plane:0,0,1,-20"),
        ("slab:coronal=25%..75%", "slab:0,1,0,-2.5,1"),
        (
            "any(plane:z=0%, not(slab:x= 0% .. 100% ))",
            "any(plane:0,0,1,-10, not(slab:1,0,0,1,2))",
        ),
        (
            "all(plane:1,0,0,3, plane:y=150%)",
            "all(plane:1,0,0,3, plane:0,1,0,-5)",
        ),
        ("sphere:50%,50%, 25% ,10%", "sphere:0,3,15,2"),
        (
            "!box:0,50%,20,50%,50%,1.5,0.6,0,0.8,0",
            "!box:0,3,20,1,1,1.5,0.6,0,0.8,0",
        ),
        (
            "not(cone:0%,0%,0%,100%,100%,100%,5%)",
            "not(cone:-1,2,10,1,4,30,1)",
        ),
        ("slab:0,0,1,-20,25%", "slab:0,0,1,-20,5"),
    ] {
        let region: Region = typed.parse().expect(typed);
        assert!(matches!(region, Region::Relative(..)), "{typed}");
        let meant: Expression = means.parse().expect(means);
        assert_eq!(region.resolve(bounds).expect(typed), meant, "{typed}");
    }
    let typed = "all(plane:1,0,0,3, sphere:0,0,0,1)";
    let region: Region = typed.parse().expect(typed);
    assert_eq!(region, Region::Fixed(typed.parse().expect(typed)));
}

#[test]
fn what_lies_nowhere_is_refused_before_there_is_a_scene() {
    for (typed, says) in [
        ("plane:w=40%", "sagittal"),
        ("plane:!x=40%", "sagittal"),
        ("plane:x=40", "in percent"),
        ("plane:x=nan%", "in percent"),
        ("plane:x=1%..2%", "a slab lies between two"),
        ("slab:x=40%", "between two shares"),
        ("slab:x=60%..40%", "the smaller one"),
        ("slab:x=4%..40", "in percent"),
        ("all(plane:x=40%", "the ) of all( is missing"),
        ("plane:10%,0,0,1", "'10%' is not a point or a length"),
        (
            "box:0,0,0,1,1,1,1,0,0,5%",
            "'5%' is not a point or a length",
        ),
        ("sphere:1%,2%,3..3%,4%", "'3..3%' is not a finite number"),
        ("sphere:50%,50%,50%,0%", "above zero"),
        ("sphere:1%,1%,1%", "4 numbers"),
        ("sphere:1,1,1,1,1%", "'1%' is not a point or a length"),
    ] {
        let error = typed.parse::<Region>().expect_err(typed).to_string();
        assert!(error.contains(says), "{typed}: {error}");
    }
    assert!(Region::shape("all(plane:x=4%)").is_err() && Region::shape("plane:x=4%").is_ok());
}
