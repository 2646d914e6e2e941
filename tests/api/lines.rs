//! Items as lines of text.

use quote::ToTokens;
use syn::{Attribute, Fields, ImplItem, Meta, UseTree, Visibility};

use super::attributes::{List, in_force, is_hidden, is_there};

/// The lines of the traits that an item derives.
pub(super) fn derived(attributes: &[Attribute]) -> Vec<String> {
    let mut lines = Vec::new();
    for meta in in_force(attributes) {
        if let Meta::List(list) = meta
            && list.path.is_ident("derive")
        {
            let traits = list.parse_args_with(List::parse_terminated);
            let traits = traits.expect("derive");
            lines.extend(traits.iter().map(|name| format!("impl {}", tidy(name))));
        }
    }
    lines
}

/// The lines of fields: all of them, or those that are public.
pub(super) fn fields(fields: &Fields, before: &str, all: bool) -> Vec<String> {
    let mut lines = Vec::new();
    for (at, field) in fields.iter().enumerate() {
        if all || matches!(field.vis, Visibility::Public(_)) {
            let name = field.ident.as_ref();
            let name = name.map_or(at.to_string(), ToString::to_string);
            lines.push(format!("{before}{name}: {}", tidy(&field.ty)));
        }
    }
    lines
}

/// The lines of an `impl`.
pub(super) fn implemented(block: &syn::ItemImpl) -> Vec<String> {
    if let Some((of, _)) = &block.trait_ {
        return vec![format!("impl {}", tidy(of))];
    }
    let mut lines = Vec::new();
    for item in &block.items {
        match item {
            ImplItem::Fn(item)
                if matches!(item.vis, Visibility::Public(_))
                    && is_there(&item.attrs)
                    && !is_hidden(&item.attrs) =>
            {
                lines.push(tidy(&item.sig));
            }
            ImplItem::Const(item) if matches!(item.vis, Visibility::Public(_)) => {
                lines.push(format!("const {}: {}", item.ident, tidy(&item.ty)));
            }
            _ => {}
        }
    }
    lines
}

/// The methods of a trait; those that it provides have a body.
pub(super) fn methods(of: &syn::ItemTrait) -> Vec<String> {
    let line = |item: &syn::TraitItem| match item {
        syn::TraitItem::Fn(method) => Some(match method.default {
            Some(_) => format!("{} {{}}", tidy(&method.sig)),
            None => tidy(&method.sig),
        }),
        _ => None,
    };
    of.items.iter().filter_map(line).collect()
}

/// The type and the methods of `setters!`, around a struct or of `Type { field: Value, }`.
pub(super) fn setters(tokens: &str) -> (String, Vec<String>) {
    let listed = || syn::parse_str(&format!("struct {tokens}"));
    let item: syn::ItemStruct = syn::parse_str(tokens)
        .or_else(|_| listed())
        .expect("fields");
    let method = |field: &syn::Field| {
        let name = field.ident.as_ref().expect("a name");
        format!("fn {name}(self, {name}: {}) -> Self", tidy(&field.ty))
    };
    let methods = item.fields.iter().map(method).collect();
    (item.ident.to_string(), methods)
}

/// The struct of `settings!` without its rows, each of which stands behind a field's type as `as "name"(...)`.
pub(super) fn without_rows(tokens: &str) -> String {
    let mut parts = tokens.split(" as \"");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let mut open = 0;
        let end = part.find(|letter| {
            open += i32::from(letter == '(') - i32::from(letter == ')');
            letter == ')' && open == 0
        });
        text += &part[end.expect("a row ends") + 1..];
    }
    text.replace(", ; #", ", #")
}

/// The segments of a type's path.
pub(super) fn segments(of: &syn::Type) -> Vec<String> {
    match of {
        syn::Type::Path(path) => path
            .path
            .segments
            .iter()
            .map(|s| s.ident.to_string())
            .collect(),
        _ => Vec::new(),
    }
}

/// The names that an import makes, and what each stands for.
pub(super) fn leaves(tree: &UseTree) -> Vec<(String, Vec<String>)> {
    match tree {
        UseTree::Path(path) => {
            let mut found = leaves(&path.tree);
            for (_, from) in &mut found {
                from.insert(0, path.ident.to_string());
            }
            found
        }
        UseTree::Name(name) => vec![(name.ident.to_string(), vec![name.ident.to_string()])],
        UseTree::Rename(name) => vec![(name.rename.to_string(), vec![name.ident.to_string()])],
        UseTree::Group(group) => group.items.iter().flat_map(leaves).collect(),
        UseTree::Glob(_) => vec![("*".into(), Vec::new())],
    }
}

pub(super) fn tidy(tokens: &impl ToTokens) -> String {
    squeezed(&tokens.to_token_stream().to_string())
}

/// Tokens with the blanks that people put between them.
pub(super) fn squeezed(tokens: &str) -> String {
    let mut text = tokens.split_whitespace().collect::<Vec<_>>().join(" ");
    let pairs = [
        (" :: ", "::"),
        (" <", "<"),
        ("< ", "<"),
        (" >", ">"),
        ("& ", "&"),
        ("* ", "*"),
        (" ,", ","),
        (" ;", ";"),
        (" :", ":"),
        ("( ", "("),
        (" )", ")"),
        (",)", ")"),
        ("[ ", "["),
        (" ]", "]"),
        ("->", " -> "),
        ("  ", " "),
    ];
    for (from, to) in pairs {
        text = text.replace(from, to);
    }
    // A bracket follows a name without a blank, and anything else after one.
    let mut joined = String::new();
    for (at, letter) in text.char_indices() {
        let name = joined
            .trim_end()
            .ends_with(|c: char| c.is_alphanumeric() || "_>".contains(c));
        if letter == '(' && name && !joined.ends_with("-> ") && text[..at].ends_with(' ') {
            joined.pop();
        }
        joined.push(letter);
    }
    joined
}
