use super::*;
use rara::scene::Kind;

#[test]
fn rows_of_a_table_stand_where_each_column_has_them() {
    let world = World::made("general", Kind::General, 3);
    let mut numbers = Measurements::new("passes", &world, [8, 4]).for_pictures([6, 5], "tiles");
    for (column, rows) in [("none", ["sort", "bin"]), ("hard", ["clip", "sort"])] {
        for row in rows {
            numbers.add(column, row, "ms", vec![3.0, 1.0, 2.0]);
        }
    }
    numbers.add("hard", "skipped", "ms", Vec::new());
    numbers.add("hard", "sort / none", "ratio", vec![0.5]);
    let table = numbers.table();
    assert_eq!(table.title, "passes: general, 3 Gaussians, 6x5, tiles");
    assert_eq!(table.columns, ["", "unit", "none", "hard"]);
    let texts = |row: &Vec<Cell>| row.iter().map(Cell::text).collect::<Vec<_>>().join(" ");
    let rows: Vec<String> = table.rows.iter().map(texts).collect();
    let expected = [
        "clip ms - 2.00 (1.00)",
        "sort ms 2.00 (1.00) 2.00 (1.00)",
        "sort / none ratio - 0.500",
        "bin ms 2.00 (1.00) -",
    ];
    assert_eq!(rows, expected);
    let rows: Vec<String> = numbers
        .rows(&["d".into(), "e".into()])
        .map(|row| texts(&row))
        .collect();
    assert_eq!(
        rows[0],
        "d e passes general 3 6x5 none tiles sort ms 3 1.00 2.00"
    );
    assert_eq!(rows.len(), 5);
}
