use super::*;

#[test]
fn nonsense_is_refused_with_its_place_and_a_remedy() {
    for (text, words) in [
        ("", "column 1 of the selection: a predicate is missing"),
        ("and opacity>1", "column 1 of the selection: a predicate"),
        (
            "opacity",
            "column 8 of the selection: a comparison is missing",
        ),
        ("opacity>", "column 9 of the selection: a number is missing"),
        ("opacity>half", "'half' is not a finite number"),
        ("opacity>inf", "'inf' is not a finite number"),
        (
            "opacity==1",
            "column 9 of the selection: a number is missing",
        ),
        ("label in", "a number is missing"),
        ("label in 3,", "a number is missing"),
        ("label in 3 4", "'4' is left over; join"),
        ("label in 4..3", "smaller end first"),
        ("label in 4..", "a number is missing"),
        ("(opacity>1", "a ) is missing"),
        ("opacity>1)", "')' is left over"),
        ("inside sphere:0,0,0,1", "inside needs a shape"),
        ("inside(sphere:0,0,0,1", "the ) of inside( is missing"),
        (
            "red>1 and inside(globe:1)",
            "from column 18 of the selection on: column 1 of the clip expression",
        ),
        (
            "inside(sphere:0,0,0,1 and red>1",
            "the ) of inside( is missing",
        ),
        ("property()>1", "no name in it"),
        ("property(a>1", "the ) of property( is missing"),
        ("opacity>1 size<2", "'size<2' is left over"),
        ("3>opacity", "a predicate is missing"),
        ("ä>1 and", "column 8 of"),
    ] {
        let message = text.parse::<Predicate>().unwrap_err().to_string();
        assert!(message.contains(words), "{text}: {message}");
    }
    let deep = format!("{}opacity>1{}", "(".repeat(100), ")".repeat(100));
    let message = deep.parse::<Predicate>().unwrap_err().to_string();
    assert!(message.contains("48"), "{message}");
    let deep = format!("{}opacity>1", "not ".repeat(100_000));
    assert!(deep.parse::<Predicate>().is_err());
}

#[test]
fn text_is_what_it_parses_from() {
    for text in [
        "opacity>0.5",
        "label in 3,4,7..9 and not (size<0.01)",
        "(red>0.6 or blue<=0.1) and property(red)!=200",
        "inside(all(box:0,0,0,1,1,1, !sphere:0,0,0,0.5)) or property(in)=1",
        "property(my label)>=-1",
    ] {
        assert_eq!(text.parse::<Predicate>().unwrap().to_string(), text);
    }
    // As deep as a text may be, its own text is no deeper.
    for (level, close) in [
        ("not ", ""),
        ("not (", ")"),
        ("not not (", ")"),
        ("red>1 and size<1 or red>1 and (", ")"),
    ] {
        let count = 48 / level.matches("not ").count().max(1);
        let deepest = format!("{}opacity>1{}", level.repeat(count), close.repeat(count));
        let predicate: Predicate = deepest.parse().unwrap();
        let again: Predicate = predicate.to_string().parse().unwrap();
        assert_eq!(again, predicate, "{level}");
    }
}
