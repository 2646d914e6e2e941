//! Attributes: which of them are in force where docs.rs builds the documentation.

use quote::ToTokens;
use syn::punctuated::Punctuated;
use syn::{Attribute, Meta, Token};

use super::lines::tidy;

/// The features of docs.rs.
const FEATURES: [&str; 6] = ["bake", "formats", "json", "picture", "serde", "viewer"];

pub(super) type List = Punctuated<Meta, Token![,]>;

/// Says whether a `cfg` holds where docs.rs builds the documentation.
pub(super) fn holds(meta: &Meta) -> bool {
    let inner = || match meta {
        Meta::List(list) => list.parse_args_with(List::parse_terminated).expect("cfg"),
        _ => List::new(),
    };
    let name = meta.path().require_ident().map(ToString::to_string);
    match name.unwrap_or_default().as_str() {
        "all" => inner().iter().all(holds),
        "any" => inner().iter().any(holds),
        "not" => !inner().iter().any(holds),
        "feature" => match meta {
            Meta::NameValue(pair) => {
                let feature = pair.value.to_token_stream().to_string();
                FEATURES.contains(&feature.trim_matches('"'))
            }
            _ => false,
        },
        "test" => false,
        _ => true,
    }
}

/// The attributes that are in force, those of `cfg_attr` included.
pub(super) fn in_force(attributes: &[Attribute]) -> Vec<Meta> {
    let mut found = Vec::new();
    for attribute in attributes {
        match &attribute.meta {
            Meta::List(list) if list.path.is_ident("cfg_attr") => {
                let parts = list.parse_args_with(List::parse_terminated);
                let mut parts = parts.expect("cfg_attr").into_iter();
                if parts.next().as_ref().is_some_and(holds) {
                    found.extend(parts);
                }
            }
            meta => found.push(meta.clone()),
        }
    }
    found
}

pub(super) fn is_there(attributes: &[Attribute]) -> bool {
    let mut conditions = attributes.iter().filter(|a| a.path().is_ident("cfg"));
    conditions.all(|a| holds(&a.parse_args().expect("a condition")))
}

pub(super) fn has(attributes: &[Attribute], name: &str) -> bool {
    in_force(attributes)
        .iter()
        .any(|meta| meta.path().is_ident(name))
}

pub(super) fn is_hidden(attributes: &[Attribute]) -> bool {
    let hidden = |meta: &Meta| tidy(meta) == "doc(hidden)";
    in_force(attributes).iter().any(hidden)
}
