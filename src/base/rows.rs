//! Tables in code.

/// The rows of a table as an array of tuples: a line each, with a comma between the columns and a semicolon at the end.
#[macro_export]
macro_rules! rows {
    ($($($column:expr),+;)+) => { [$(($($column),+)),+] };
}
