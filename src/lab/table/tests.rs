use super::*;

#[test]
fn three_digits_count() {
    let shown = [
        0.0, -0.0, 0.000_312, 0.118, 3.44, 25.24, 731.4, 73_140.0, 1.234e-9,
    ]
    .map(small);
    let expected = [
        "0", "0", "0.000312", "0.118", "3.44", "25.2", "731", "73140", "1.23e-9",
    ];
    assert_eq!(shown, expected);
}

#[test]
fn people_see_digits_and_programs_see_numbers() {
    let mut table = Table::new("Times", "ms", ["who", "least", "n"]);
    table.row(["a, \"b\" | c".into(), 0.123_456.into(), 7_u32.into()]);
    table.row(["<d>".into(), None.into(), 1_u32.into()]);
    assert_eq!(
        table.csv(),
        "\"who\",\"least\",\"n\"\n\"a, \"\"b\"\" | c\",0.123456,7\n\"<d>\",,1\n"
    );
    assert!(
        table
            .markdown()
            .contains("|---|---:|---:|\n| a, \"b\" \\| c | 0.123 | 7 |\n| <d> | - | 1 |")
    );
    let html = table.html();
    assert!(
        html.contains("<td>&lt;d&gt;</td><td class=\"number\">-</td>"),
        "{html}"
    );
}
