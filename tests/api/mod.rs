//! The names that users of the library can use, read from its source and that of the crates below it, and compared with `tests/api.txt`, so that no
//! change goes unseen.
//!
//! After an intended change, `RARA_RENEW_API=1 cargo test --test library api` writes the list anew; the change's description
//! explains the difference. The features are those of docs.rs.

mod attributes;
mod lines;
mod package;

use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

use syn::{Attribute, Item, Visibility};

use attributes::{has, is_hidden, is_there};
use lines::{derived, fields, implemented, leaves, methods, segments, setters, tidy, without_rows};

#[test]
fn the_public_interface_is_what_is_written_down() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut library = Library::default();
    for (name, folder) in CRATES {
        let folder = root.join(folder);
        let text = fs::read_to_string(folder.join("lib.rs")).expect("the library");
        let file = syn::parse_file(&text).expect("Rust");
        library.read(name, file.items, &folder);
    }
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
         if that is meant, RARA_RENEW_API=1 cargo test --test library api writes it down",
        gone.join("\n"),
        new.join("\n"),
    );
}

/// The library, the crates whose items it shows, and that of windows.
const CRATES: [(&str, &str); 5] = [
    ("rara", "src"),
    ("rara_base", "src/base"),
    ("rara_gpu", "src/gpu"),
    ("rara_scene", "src/scene"),
    ("rara_view", "src/view"),
];

/// What `named!` adds to an enumeration.
const NAMED: [&str; 4] = [
    "const ALL: &'static [Self]",
    "const fn name(self) -> &'static str",
    "impl FromStr",
    "impl fmt::Display",
];

/// A definition: the module that it is in, and its name there.
type Place = (String, String);

#[derive(Default)]
struct Library {
    /// The items of each module, by its path.
    modules: BTreeMap<String, Vec<Item>>,
    /// The imports of each module: the name here and the path there, as written.
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
                // Those of the macro stand around the struct itself, which is an item as any other.
                Item::Macro(call) if call.mac.path.is_ident("setters") => {
                    let of = call.mac.parse_body::<syn::ItemStruct>();
                    kept.extend(of.ok().map(Item::Struct));
                }
                Item::Macro(call) if call.mac.path.is_ident("settings") => {
                    let of = syn::parse_str(&without_rows(&call.mac.tokens.to_string()));
                    kept.extend(of.ok().map(Item::Struct));
                }
                // The names look like the numbers of values.
                Item::Macro(call) if call.mac.path.is_ident("named") => {
                    let of = call.mac.parse_body::<syn::ItemEnum>();
                    kept.extend(of.ok().map(Item::Enum));
                }
                _ => {}
            }
            kept.push(item);
        }
        self.modules.insert(path.to_owned(), kept);
    }

    /// The place of the definition that a module means by `path`; `None` if it is outside of the library.
    fn place(&self, module: &str, path: &[String]) -> Option<Place> {
        let (first, rest) = path.split_first()?;
        let inner = |name: &str| format!("{module}::{name}");
        let within = match first.as_str() {
            "crate" => module.split("::").next()?.to_owned(),
            name if !rest.is_empty() && self.modules.contains_key(name) => name.to_owned(),
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
                let Some(import) = self.imports.get(&key) else {
                    let inner = Some(inner(name)).filter(|inner| self.modules.contains_key(inner));
                    return inner.map(|inner| (inner, String::new()));
                };
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
                    Item::Macro(call) if call.mac.path.is_ident("settings") => {
                        let tokens = without_rows(&call.mac.tokens.to_string());
                        let (name, mut lines) = setters(&tokens);
                        lines.push("const ALL: &'static [Setting<Self>]".into());
                        (vec![name], lines)
                    }
                    Item::Macro(call) if call.mac.path.is_ident("named") => {
                        let of = call.mac.parse_body::<syn::ItemEnum>().expect("an enum");
                        (vec![of.ident.to_string()], NAMED.map(Into::into).to_vec())
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
        for shown in ["rara", "rara_view"] {
            self.list(shown, shown, &mut paragraphs);
        }
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
                        let shown = format!("{path}::{name}");
                        match self.place(module, &from) {
                            Some((inner, item)) if item.is_empty() => self.list(&shown, &inner, to),
                            place => drop(to.insert(shown, place)),
                        }
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
            Item::Trait(item) => {
                lines.extend(methods(item));
                let safety = item.unsafety.map_or("", |_| "unsafe ");
                let above = match item.supertraits.is_empty() {
                    true => String::new(),
                    false => format!(": {}", tidy(&item.supertraits)),
                };
                format!("{safety}trait {path}{}{above}", tidy(&item.generics))
            }
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
