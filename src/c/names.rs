//! The names of C in messages. rara names its own items by their paths in Rust, of which a host in C knows nothing: where a
//! message leaves, each becomes the name of `rara.h` that the header's own names tell it is.

use std::borrow::Cow;

// FIELDS, each with its struct, and NAMES: the functions and the constants.
include!(concat!(env!("OUT_DIR"), "/names.rs"));

/// A message with the names of `rara.h` in place of paths in Rust. A path that has no such name stays as it is.
pub(crate) fn in_c(message: &str) -> Cow<'_, str> {
    if !message.contains("::") {
        return message.into();
    }
    let is_word = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let (mut said, mut rest) = (String::new(), message);
    while let Some((before, after)) = rest.split_once("::") {
        let (words, owner) = before.split_at(before.trim_end_matches(is_word).len());
        let behind = after.trim_start_matches(is_word);
        let item = &after[..after.len() - behind.len()];
        said += words;
        said += &name(owner, item).unwrap_or_else(|| format!("{owner}::{item}"));
        rest = behind;
    }
    said += rest;
    said.into()
}

/// The name of an item: of the field of a struct, of a function, or of a constant.
fn name(owner: &str, item: &str) -> Option<String> {
    let of = format!("Rara{owner}");
    let written = |(of, field): &(&str, &str)| format!("{of}.{field}");
    if let Some(own) = FIELDS.iter().find(|own| **own == (&of, item)) {
        return Some(written(own));
    }
    let words = snake(owner);
    let is_module = owner.starts_with(char::is_lowercase);
    let function = match is_module {
        true => format!("rara_{item}"),
        false => format!("rara_{words}_{item}"),
    };
    let constant = format!("RARA_{words}_{}", snake(item)).to_uppercase();
    if let Some(own) = [function, constant]
        .into_iter()
        .find(|own| NAMES.contains(&&**own))
    {
        return Some(own);
    }
    // A struct within another lies flat in C: a field of the inner one has the name of both.
    let outer = format!("{item}_");
    let inner = format!("{}_{item}", snake(owner.trim_end_matches("Desc")));
    let flat =
        |(own, field): &&(&str, &str)| *field == inner || (*own == of && field.starts_with(&outer));
    if let Some(own) = FIELDS.iter().find(flat) {
        return Some(written(own));
    }
    owner.starts_with("Vk").then(|| format!("{owner}.{item}"))
}

/// `ColorSpace` as `color_space`.
fn snake(name: &str) -> String {
    let mut words = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push('_');
        }
        words.push(letter.to_ascii_lowercase());
    }
    words
}

#[cfg(test)]
mod tests;
