//! Numbers of things, as sentences have them.

use std::fmt::Display;

/// So many of what is called `one`: "1 camera", "2 cameras", "0 properties".
pub fn counted(number: impl Display, one: &str) -> String {
    let number = number.to_string();
    match one.strip_suffix("ty") {
        _ if number == "1" => format!("{number} {one}"),
        Some(stem) => format!("{number} {stem}ties"),
        None => format!("{number} {one}s"),
    }
}

/// 1234567 as "1 234 567".
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_no_plural() {
        let shown = [0, 1, 2, 1000].map(|number| counted(number, "view"));
        assert_eq!(shown, ["0 views", "1 view", "2 views", "1000 views"]);
        assert_eq!(
            counted(1, "property") + &counted(2, "property"),
            "1 property2 properties"
        );
        assert_eq!(counted("1 234", "byte"), "1 234 bytes");
    }

    #[test]
    fn digits_stand_in_groups_of_three() {
        let shown = [0, 999, 1000, 1_234_567].map(grouped);
        assert_eq!(shown, ["0", "999", "1 000", "1 234 567"]);
        assert_eq!(counted(grouped(1000), "view"), "1 000 views");
    }
}
