//! What users of the library can name, read from its source and compared with `tests/api.txt`, so that no change goes
//! unseen.
//!
//! After an intended change, `RARA_RENEW_API=1 cargo test --test api` writes the list anew; the change's description
//! explains the difference. The features are those of docs.rs.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

use quote::ToTokens;
use syn::punctuated::Punctuated;
use syn::{Attribute, Fields, ImplItem, Item, Meta, Token, UseTree, Visibility};

const FEATURES: [&str; 5] = ["json", "picture", "ply", "serde", "view"];

#[test]
fn the_public_interface_is_what_is_written_down() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut library = Library::default();
    let text = fs::read_to_string(root.join("src/lib.rs")).expect("the library");
    let file = syn::parse_file(&text).expect("Rust");
    library.read("rara", file.items, &root.join("src"));
    library.find_impls();
    let found = library.public();

    let path = root.join("tests/api.txt");
    if std::env::var_os("RARA_RENEW_API").is_some() {
        fs::write(&path, &found).expect("tests/ is writable");
    }
    let written = fs::read_to_string(&path).expect("tests/api.txt");
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<HashSet<_>>();
    let (before, now) = (lines(&written), lines(&found));
    let gone = written.lines().filter(|line| !now.contains(*line));
    let new = found.lines().filter(|line| !before.contains(*line));
    let gone: Vec<String> = gone.map(|line| format!("- {line}")).collect();
    let new: Vec<String> = new.map(|line| format!("+ {line}")).collect();
    assert!(
        written == found,
        "the public interface is another than tests/api.txt says:\n{}\n{}\n\
         if that is meant, RARA_RENEW_API=1 cargo test --test api writes it down",
        gone.join("\n"),
        new.join("\n"),
    );
}

/// A definition: the module that it is in, and its name there.
type Place = (String, String);

#[derive(Default)]
struct Library {
    /// The items of each module, by its path.
    modules: BTreeMap<String, Vec<Item>>,
    /// What each module imports: the name here and the path there, as written.
    imports: HashMap<Place, Vec<String>>,
    /// The lines of what is implemented for each type.
    impls: HashMap<Place, Vec<String>>,
}

impl Library {
    /// Takes the items of a module, and those of the modules in it; `folder` has their files.
    fn read(&mut self, path: &str, items: Vec<Item>, folder: &Path) {
        let mut kept = Vec::new();
        for item in items.into_iter().filter(|item| is_there(attributes(item))) {
            match &item {
                Item::Mod(module) => {
                    let name = module.ident.to_string();
                    let below = folder.join(&name);
                    let items = match &module.content {
                        Some((_, items)) => items.clone(),
                        None => {
                            let files: [PathBuf; 2] =
                                [folder.join(format!("{name}.rs")), below.join("mod.rs")];
                            let text = files.iter().find_map(|file| fs::read_to_string(file).ok());
                            let text = text.unwrap_or_else(|| panic!("no file of {path}::{name}"));
                            syn::parse_file(&text).expect("Rust").items
                        }
                    };
                    self.read(&format!("{path}::{name}"), items, &below);
                }
                Item::Use(import) => {
                    for (name, from) in leaves(&import.tree) {
                        self.imports.insert((path.to_owned(), name), from);
                    }
                }
                _ => {}
            }
            kept.push(item);
        }
        self.modules.insert(path.to_owned(), kept);
    }

    /// Where the definition is that a module means by `path`; `None` if it is outside of the library.
    fn place(&self, module: &str, path: &[String]) -> Option<Place> {
        let (first, rest) = path.split_first()?;
        let inner = |name: &str| format!("{module}::{name}");
        let within = match first.as_str() {
            "crate" => "rara".to_owned(),
            "self" => module.to_owned(),
            "super" => module.rsplit_once("::")?.0.to_owned(),
            name if rest.is_empty() => {
                let here = self.modules.get(module)?;
                if here
                    .iter()
                    .any(|item| defined(item).as_deref() == Some(name))
                {
                    return Some((module.to_owned(), name.to_owned()));
                }
                let key = (module.to_owned(), name.to_owned());
                let import = self.imports.get(&key)?;
                return (import.as_slice() != path).then(|| self.place(module, import))?;
            }
            name if self.modules.contains_key(&inner(name)) => inner(name),
            name => {
                // A module that is imported, as in `use crate::types;`.
                let import = self.imports.get(&(module.to_owned(), name.to_owned()))?;
                let mut whole = import.clone();
                whole.extend_from_slice(rest);
                return (import.as_slice() != [name.to_owned()])
                    .then(|| self.place(module, &whole))?;
            }
        };
        match rest {
            [] => Some((within, String::new())),
            _ => self.place(&within, rest),
        }
    }

    fn find_impls(&mut self) {
        let mut found: HashMap<Place, Vec<String>> = HashMap::new();
        for (module, items) in &self.modules {
            for item in items {
                let (name, lines) = match item {
                    Item::Impl(block) => (segments(&block.self_ty), implemented(block)),
                    Item::Macro(call) if call.mac.path.is_ident("setters") => {
                        let (name, lines) = setters(&call.mac.tokens.to_string());
                        (vec![name], lines)
                    }
                    _ => continue,
                };
                if let Some(place) = self.place(module, &name) {
                    found.entry(place).or_default().extend(lines);
                }
            }
        }
        self.impls = found;
    }

    /// Everything that can be named, a paragraph each.
    fn public(&self) -> String {
        let mut paragraphs = BTreeMap::new();
        self.list("rara", "rara", &mut paragraphs);
        let mut seen: HashMap<Place, String> = HashMap::new();
        let mut text = String::new();
        // The shortest path gets the definition; the others only refer to it.
        let mut names: Vec<_> = paragraphs.into_iter().collect();
        names.sort_by_key(|(name, _)| (name.matches("::").count(), name.clone()));
        for (name, place) in names {
            match place {
                None => text += &format!("pub use {name}\n\n"),
                Some(place) if seen.contains_key(&place) => {
                    text += &format!("pub use {} as {name}\n\n", seen[&place]);
                }
                Some(place) => {
                    text += &self.paragraph(&name, &place);
                    text += "\n";
                    seen.insert(place, name);
                }
            }
        }
        text
    }

    /// Adds what a module makes public under a path.
    fn list(&self, path: &str, module: &str, to: &mut BTreeMap<String, Option<Place>>) {
        for item in &self.modules[module] {
            if !is_public(item) || is_hidden(attributes(item)) {
                continue;
            }
            match item {
                Item::Mod(inner) => {
                    let name = &inner.ident;
                    self.list(&format!("{path}::{name}"), &format!("{module}::{name}"), to);
                }
                Item::Use(import) => {
                    for (name, from) in leaves(&import.tree) {
                        assert_ne!(name, "*", "{module} shows everything of {from:?}");
                        to.insert(format!("{path}::{name}"), self.place(module, &from));
                    }
                }
                _ => {
                    if let Some(name) = defined(item) {
                        let place = (module.to_owned(), name.clone());
                        to.insert(format!("{path}::{name}"), Some(place));
                    }
                }
            }
        }
    }

    fn paragraph(&self, path: &str, place: &Place) -> String {
        let (module, name) = place;
        let item = self.modules[module]
            .iter()
            .find(|item| defined(item).as_ref() == Some(name))
            .unwrap_or_else(|| panic!("{path} is not found in {module}"));
        let mut lines: Vec<String> = Vec::new();
        let kind = match item {
            Item::Struct(item) => {
                lines.extend(fields(&item.fields, "", false));
                format!("struct {path}{}", tidy(&item.generics))
            }
            Item::Enum(item) => {
                for variant in &item.variants {
                    lines.extend(fields(
                        &variant.fields,
                        &format!("{}.", variant.ident),
                        true,
                    ));
                    lines.push(variant.ident.to_string());
                }
                format!("enum {path}{}", tidy(&item.generics))
            }
            Item::Fn(item) => tidy(&item.sig).replace(&format!("fn {name}"), &format!("fn {path}")),
            Item::Const(item) => format!("const {path}: {}", tidy(&item.ty)),
            Item::Type(item) => format!("type {path}{} = {}", tidy(&item.generics), tidy(&item.ty)),
            other => format!("{path}: {}", tidy(other)),
        };
        let mut head = format!("pub {kind}");
        if has(attributes(item), "non_exhaustive") {
            head = format!("#[non_exhaustive] {head}");
        }
        lines.extend(derived(attributes(item)));
        lines.extend(self.impls.get(place).cloned().unwrap_or_default());
        lines.sort();
        let (traits, mut lines): (Vec<String>, Vec<String>) = lines
            .into_iter()
            .partition(|line| line.starts_with("impl "));
        let traits: Vec<&str> = traits.iter().map(|line| &line["impl ".len()..]).collect();
        if !traits.is_empty() {
            lines.push(format!("impl {}", traits.join(", ")));
        }
        lines
            .iter()
            .fold(head + "\n", |text, line| text + "    " + line + "\n")
    }
}

/// The name that an item defines.
fn defined(item: &Item) -> Option<String> {
    Some(match item {
        Item::Const(item) => item.ident.to_string(),
        Item::Enum(item) => item.ident.to_string(),
        Item::Fn(item) => item.sig.ident.to_string(),
        Item::Struct(item) => item.ident.to_string(),
        Item::Trait(item) => item.ident.to_string(),
        Item::Type(item) => item.ident.to_string(),
        _ => return None,
    })
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

fn is_public(item: &Item) -> bool {
    let visibility = match item {
        Item::Const(item) => &item.vis,
        Item::Enum(item) => &item.vis,
        Item::Fn(item) => &item.vis,
        Item::Mod(item) => &item.vis,
        Item::Struct(item) => &item.vis,
        Item::Trait(item) => &item.vis,
        Item::Type(item) => &item.vis,
        Item::Use(item) => &item.vis,
        _ => return false,
    };
    matches!(visibility, Visibility::Public(_))
}

type List = Punctuated<Meta, Token![,]>;

/// Whether a `cfg` holds where docs.rs builds the documentation.
fn holds(meta: &Meta) -> bool {
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
fn in_force(attributes: &[Attribute]) -> Vec<Meta> {
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

fn is_there(attributes: &[Attribute]) -> bool {
    let mut conditions = attributes.iter().filter(|a| a.path().is_ident("cfg"));
    conditions.all(|a| holds(&a.parse_args().expect("a condition")))
}

fn has(attributes: &[Attribute], name: &str) -> bool {
    in_force(attributes)
        .iter()
        .any(|meta| meta.path().is_ident(name))
}

fn is_hidden(attributes: &[Attribute]) -> bool {
    let hidden = |meta: &Meta| tidy(meta) == "doc(hidden)";
    in_force(attributes).iter().any(hidden)
}

fn derived(attributes: &[Attribute]) -> Vec<String> {
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
fn fields(fields: &Fields, before: &str, all: bool) -> Vec<String> {
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
fn implemented(block: &syn::ItemImpl) -> Vec<String> {
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

/// The type and the methods of `setters!(Type { field: Value, })`.
fn setters(tokens: &str) -> (String, Vec<String>) {
    let text = squeezed(tokens);
    let (name, fields) = text.split_once('{').expect("setters of a type");
    let item = format!("struct {name} {{ {}", fields);
    let item: syn::ItemStruct = syn::parse_str(&item).expect("fields");
    let method = |field: &syn::Field| {
        let name = field.ident.as_ref().expect("a name");
        format!("fn {name}(self, {name}: {}) -> Self", tidy(&field.ty))
    };
    (
        name.trim().to_owned(),
        item.fields.iter().map(method).collect(),
    )
}

/// The segments of a type's path.
fn segments(of: &syn::Type) -> Vec<String> {
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
fn leaves(tree: &UseTree) -> Vec<(String, Vec<String>)> {
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

fn tidy(tokens: &impl ToTokens) -> String {
    squeezed(&tokens.to_token_stream().to_string())
}

/// Tokens with the blanks that people put between them.
fn squeezed(tokens: &str) -> String {
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
