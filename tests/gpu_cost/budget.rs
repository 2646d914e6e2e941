//! The committed budget: a file of tables with a line an entry, in the part of TOML that this needs.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{env, fs};

/// Numbers by their names, in the order in which they are written.
pub type Numbers = Vec<(&'static str, u64)>;
/// What was found, by its name.
pub type Table = BTreeMap<String, Numbers>;

/// What the numbers in the file mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// Nothing may exceed them.
    Ceiling,
    /// As [`Ceiling`](Self::Ceiling), of compilers, whose versions differ: where the file is renewed, registers and code get
    /// a tenth more than was found.
    CompilersCeiling,
}

impl Rule {
    fn allowance(self, name: &str, found: u64) -> u64 {
        match (self, name) {
            (Self::CompilersCeiling, "registers" | "code") => found + found.div_ceil(10),
            _ => found,
        }
    }
}

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/gpu_cost/budget.toml");

const HEADER: &str = "\
# What frames may cost a GPU; the guide's chapter on testing says how to read it. A change that costs more changes it:
#     RARA_RENEW_BUDGET=1 cargo test --release --test library gpu_cost
";

/// What stands before a table.
fn explained(table: &str) -> &'static str {
    match table {
        "frames" => "\n# The commands of a frame with the pipelines for GPUs.\n",
        _ => {
            "\n\
# Ceilings of each shader and its specialisation constants, those that are 0 left out: vector registers, spilled registers,\n\
# bytes of scratch memory, of shared memory and of code, and the subgroup size that is asked for, 0 for none. Registers and\n\
# code are what was found and a tenth, since compilers' versions differ.\n"
        }
    }
}

/// The numbers of a line of the file.
type Entry = Vec<(String, u64)>;
type Budget = BTreeMap<String, BTreeMap<String, Entry>>;

/// The tests of one process take turns, since each writes a part of the file.
fn turn() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Compares what was found with the same tables of the file, or writes it there.
///
/// # Panics
/// With a line for each difference that is not allowed.
pub fn check(found: BTreeMap<String, Table>, rule: Rule) {
    let _turn = turn();
    let mut budget = parse(&fs::read_to_string(FILE).expect("the budget"));
    if env::var_os("RARA_RENEW_BUDGET").is_some() {
        for (name, table) in &found {
            budget.insert(name.clone(), renewed(table, rule));
        }
        fs::write(FILE, text(&budget)).expect("tests/ is writable");
    }
    let empty = BTreeMap::new();
    let differences: Vec<String> = found
        .iter()
        .flat_map(|(name, table)| {
            let allowed = budget.get(name).unwrap_or(&empty);
            differences(name, table, allowed)
        })
        .collect();
    assert!(
        differences.is_empty(),
        "this is not what tests/gpu_cost/budget.toml allows:\n{}\nif that is meant, \
         RARA_RENEW_BUDGET=1 cargo test --release --test library gpu_cost writes it down",
        differences.join("\n")
    );
}

fn differences(name: &str, table: &Table, allowed: &BTreeMap<String, Entry>) -> Vec<String> {
    let mut all = Vec::new();
    for (item, numbers) in table {
        let Some(entry) = allowed.get(item) else {
            let has: Vec<_> = numbers.iter().map(|(n, v)| format!("{n} {v}")).collect();
            let has = has.join(", ");
            all.push(format!(
                "{name}: \"{item}\" is not in the file; it has {has}"
            ));
            continue;
        };
        for (number, value) in numbers {
            let ceiling = entry.iter().find(|(n, _)| n == number);
            let ceiling = ceiling.map_or(0, |(_, ceiling)| *ceiling);
            // A subgroup that is asked for is no matter of more or less.
            let allows = match *number {
                "asked" => *value == ceiling,
                _ => *value <= ceiling,
            };
            if !allows {
                all.push(format!(
                    "{name}: \"{item}\" has {number} {value}, and the file says {ceiling}"
                ));
            }
        }
    }
    let gone = allowed.keys().filter(|item| !table.contains_key(*item));
    all.extend(gone.map(|item| format!("{name}: \"{item}\" is in the file and no longer there")));
    all
}

fn renewed(table: &Table, rule: Rule) -> BTreeMap<String, Entry> {
    let entry = |(item, numbers): (&String, &Numbers)| {
        let allowance =
            |(name, value): &(&str, u64)| (name.to_string(), rule.allowance(name, *value));
        (item.clone(), numbers.iter().map(allowance).collect())
    };
    table.iter().map(entry).collect()
}

fn text(budget: &Budget) -> String {
    let mut text = HEADER.to_owned();
    let mut explanation = "";
    for (name, table) in budget {
        // One explanation does for the tables of all GPUs.
        if explained(name) == explanation {
            text.push('\n');
        } else {
            explanation = explained(name);
            text += explanation;
        }
        text += &format!("[{name}]\n");
        for (item, entry) in table {
            let fields = entry
                .iter()
                .map(|(name, value)| format!("{name} = {value}"));
            let fields: Vec<String> = fields.collect();
            text += &format!("\"{item}\" = {{ {} }}\n", fields.join(", "));
        }
    }
    text
}

fn parse(text: &str) -> Budget {
    let mut budget = Budget::new();
    let mut table = None;
    for line in text.lines().map(str::trim) {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if let Some(name) = line
            .strip_prefix('[')
            .and_then(|rest| rest.strip_suffix(']'))
        {
            table = Some(budget.entry(name.to_owned()).or_default());
            continue;
        }
        let parsed =
            entry(line).unwrap_or_else(|| panic!("budget.toml: what is this line? {line}"));
        let table = table
            .as_deref_mut()
            .expect("budget.toml: an entry before the first table");
        let twice = table.insert(parsed.0, parsed.1);
        assert!(twice.is_none(), "budget.toml: this is there twice: {line}");
    }
    budget
}

/// `"name" = { number = 1, number = 2 }`
fn entry(line: &str) -> Option<(String, Entry)> {
    let (item, rest) = line.strip_prefix('"')?.split_once("\" = { ")?;
    let numbers = rest.strip_suffix(" }")?;
    let number = |field: &str| {
        let (name, value) = field.split_once(" = ")?;
        Some((name.to_owned(), value.parse().ok()?))
    };
    let entry = numbers.split(", ").map(number).collect::<Option<_>>()?;
    Some((item.to_owned(), entry))
}

#[test]
fn the_file_is_read_as_it_is_written() {
    let _turn = turn();
    let written = fs::read_to_string(FILE).expect("the budget");
    assert!(
        text(&parse(&written)) == written,
        "the lines of budget.toml are not as and where RARA_RENEW_BUDGET=1 writes them"
    );
}

#[test]
fn every_difference_is_told() {
    let file = parse(
        "[t]\n\"gone\" = { a = 1 }\n\"more\" = { a = 1, b = 2 }\n\"less\" = { a = 3, asked = 64 }\n",
    );
    let found = Table::from([
        ("more".into(), vec![("a", 2), ("b", 2)]),
        ("less".into(), vec![("a", 2), ("asked", 32)]),
        ("new".into(), vec![("a", 7), ("b", 8)]),
    ]);
    assert_eq!(
        differences("t", &found, &file["t"]),
        [
            "t: \"less\" has asked 32, and the file says 64",
            "t: \"more\" has a 2, and the file says 1",
            "t: \"new\" is not in the file; it has a 7, b 8",
            "t: \"gone\" is in the file and no longer there",
        ]
    );
    let again = renewed(&found, Rule::CompilersCeiling);
    assert_eq!(differences("t", &found, &again), [""; 0]);
}
