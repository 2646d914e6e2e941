//! SPIR-V with its specialisation constants in place, and without what they switch off.
//!
//! A driver that is given a module and the values of its constants inlines all functions before it looks at the values: most of
//! the time that a pipeline takes to compile goes into code that is then thrown away, and the validation layer does the same once
//! more. So constants are replaced by their values here, expressions of them are folded, a branch that they decide is taken, and
//! blocks, functions and variables that nothing reaches any more are left out. What is computed does not change.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// The opcodes that are looked at, by the names that the specification of SPIR-V gives them.
mod op {
    pub(super) const NAME: u16 = 5;
    pub(super) const MEMBER_NAME: u16 = 6;
    pub(super) const ENTRY_POINT: u16 = 15;
    pub(super) const TYPE_VOID: u16 = 19;
    pub(super) const TYPE_BOOL: u16 = 20;
    pub(super) const TYPE_INT: u16 = 21;
    pub(super) const TYPE_FORWARD_POINTER: u16 = 39;
    pub(super) const CONSTANT_TRUE: u16 = 41;
    pub(super) const CONSTANT_FALSE: u16 = 42;
    pub(super) const CONSTANT: u16 = 43;
    pub(super) const CONSTANT_COMPOSITE: u16 = 44;
    pub(super) const SPEC_CONSTANT_TRUE: u16 = 48;
    pub(super) const SPEC_CONSTANT_FALSE: u16 = 49;
    pub(super) const SPEC_CONSTANT: u16 = 50;
    pub(super) const SPEC_CONSTANT_COMPOSITE: u16 = 51;
    pub(super) const SPEC_CONSTANT_OP: u16 = 52;
    pub(super) const FUNCTION: u16 = 54;
    pub(super) const FUNCTION_END: u16 = 56;
    pub(super) const FUNCTION_CALL: u16 = 57;
    pub(super) const VARIABLE: u16 = 59;
    pub(super) const LOAD: u16 = 61;
    pub(super) const STORE: u16 = 62;
    pub(super) const DECORATE: u16 = 71;
    pub(super) const MEMBER_DECORATE: u16 = 72;
    pub(super) const UNDEF: u16 = 1;
    pub(super) const S_NEGATE: u16 = 126;
    pub(super) const I_ADD: u16 = 128;
    pub(super) const I_SUB: u16 = 130;
    pub(super) const I_MUL: u16 = 132;
    pub(super) const U_DIV: u16 = 134;
    pub(super) const U_MOD: u16 = 137;
    pub(super) const LOGICAL_EQUAL: u16 = 164;
    pub(super) const LOGICAL_NOT_EQUAL: u16 = 165;
    pub(super) const LOGICAL_OR: u16 = 166;
    pub(super) const LOGICAL_AND: u16 = 167;
    pub(super) const LOGICAL_NOT: u16 = 168;
    pub(super) const SELECT: u16 = 169;
    pub(super) const I_EQUAL: u16 = 170;
    pub(super) const I_NOT_EQUAL: u16 = 171;
    pub(super) const U_GREATER_THAN: u16 = 172;
    pub(super) const S_GREATER_THAN: u16 = 173;
    pub(super) const U_GREATER_THAN_EQUAL: u16 = 174;
    pub(super) const S_GREATER_THAN_EQUAL: u16 = 175;
    pub(super) const U_LESS_THAN: u16 = 176;
    pub(super) const S_LESS_THAN: u16 = 177;
    pub(super) const U_LESS_THAN_EQUAL: u16 = 178;
    pub(super) const S_LESS_THAN_EQUAL: u16 = 179;
    pub(super) const SHIFT_RIGHT_LOGICAL: u16 = 194;
    pub(super) const SHIFT_LEFT_LOGICAL: u16 = 196;
    pub(super) const BITWISE_OR: u16 = 197;
    pub(super) const BITWISE_XOR: u16 = 198;
    pub(super) const BITWISE_AND: u16 = 199;
    pub(super) const NOT: u16 = 200;
    pub(super) const PHI: u16 = 245;
    pub(super) const LOOP_MERGE: u16 = 246;
    pub(super) const SELECTION_MERGE: u16 = 247;
    pub(super) const LABEL: u16 = 248;
    pub(super) const BRANCH: u16 = 249;
    pub(super) const BRANCH_CONDITIONAL: u16 = 250;
    pub(super) const SWITCH: u16 = 251;
    pub(super) const UNREACHABLE: u16 = 255;
}

/// The decorations that are looked at: a constant's number, and built-in values, of which one is the workgroup's size.
const SPEC_ID: u32 = 1;
const BUILT_IN: u32 = 11;
const WORKGROUP_SIZE: u32 = 25;
/// Words before a module's first instruction, and which of them is one more than the largest id.
const HEADER: usize = 5;
const BOUND: usize = 3;

/// A module with these values in place of its constants: number and value each. Constants that are not named have their default.
pub(super) fn specialized(words: &[u32], constants: &[(u32, u32)]) -> Vec<u32> {
    let all = instructions(words);
    let functions_begin = all.iter().position(|one| one.op == op::FUNCTION);
    let (globals, bodies) = all.split_at(functions_begin.unwrap_or(all.len()));
    let mut module = Module {
        bound: words[BOUND],
        values: HashMap::new(),
        scalars: HashSet::new(),
        bools: HashSet::new(),
        undefined: Vec::new(),
    };
    let globals = module.with_constants(globals, constants);
    let entries = globals.iter().filter(|one| opcode(one) == op::ENTRY_POINT);
    let mut wanted: Vec<u32> = entries.map(|one| one[2]).collect();

    let functions: HashMap<u32, &[Instruction<'_>]> = bodies
        .split_inclusive(|one| one.op == op::FUNCTION_END)
        .map(|body| (body[0].words[2], body))
        .collect();
    let mut kept: HashMap<u32, Vec<u32>> = HashMap::new();
    while let Some(function) = wanted.pop() {
        kept.entry(function).or_insert_with(|| {
            let body = module.folded(functions[&function]);
            let calls = instructions_of(&body).filter(|one| one.op == op::FUNCTION_CALL);
            wanted.extend(calls.map(|call| call.words[3]));
            body
        });
    }
    let in_order = bodies.iter().filter(|one| one.op == op::FUNCTION);
    let code: Vec<u32> = in_order
        .filter_map(|function| kept.get(&function.words[2]))
        .flatten()
        .copied()
        .collect();

    let mut out = words[..HEADER].to_vec();
    out[BOUND] = module.bound;
    let globals = [globals, module.undefined].concat();
    let used = used(&globals, &code, module.bound);
    out.extend(
        globals
            .iter()
            .filter_map(|one| without_unused(one, &used))
            .flatten(),
    );
    out.extend(code);
    out
}

/// An instruction, whose first word is its opcode and its length.
#[derive(Debug, Clone, Copy)]
struct Instruction<'a> {
    op: u16,
    words: &'a [u32],
}

fn opcode(words: &[u32]) -> u16 {
    words[0] as u16
}

/// The instructions of words that a module's build has checked.
fn instructions_of(mut words: &[u32]) -> impl Iterator<Item = Instruction<'_>> {
    std::iter::from_fn(move || {
        let first = *words.first()?;
        let (instruction, rest) = words.split_at((first >> 16) as usize);
        words = rest;
        Some(Instruction {
            op: first as u16,
            words: instruction,
        })
    })
}

fn instructions(module: &[u32]) -> Vec<Instruction<'_>> {
    instructions_of(&module[HEADER..]).collect()
}

/// An instruction's words, of its opcode and operands.
fn instruction(op: u16, operands: &[u32]) -> Vec<u32> {
    let length = operands.len() as u32 + 1;
    let mut words = vec![length << 16 | u32::from(op)];
    words.extend(operands);
    words
}

/// A word of an instruction that may be an id. Numbers that are none may look like one: more is kept then than has to be.
fn mark(used: &mut [bool], words: &[u32]) {
    for &word in words {
        if let Some(used) = used.get_mut(word as usize) {
            *used = true;
        }
    }
}

/// The id that an instruction outside of functions declares.
fn declared(words: &[u32]) -> Option<u32> {
    match opcode(words) {
        op::TYPE_VOID..op::TYPE_FORWARD_POINTER => Some(words[1]),
        op::CONSTANT_TRUE..=op::SPEC_CONSTANT_OP | op::VARIABLE | op::UNDEF => Some(words[2]),
        _ => None,
    }
}

/// Where an entry point's list of variables begins, behind its name.
fn interface(words: &[u32]) -> usize {
    let ends = |word: &u32| word.to_ne_bytes().contains(&0);
    words[3..]
        .iter()
        .position(ends)
        .map_or(words.len(), |last| 3 + last + 1)
}

/// Says of each id whether it is declared in what is kept: in functions, or outside of them where anything refers to it.
fn used(globals: &[Vec<u32>], code: &[u32], bound: u32) -> Vec<bool> {
    let mut used = vec![false; bound as usize];
    for one in instructions_of(code) {
        mark(&mut used, &one.words[1..]);
    }
    let mut are_pending: Vec<_> = globals.iter().collect();
    loop {
        let before = are_pending.len();
        // Most refer to what is before them.
        are_pending = are_pending.into_iter().rev().collect();
        are_pending.retain(|words| {
            let is_used = match (opcode(words), declared(words)) {
                (_, Some(id)) => used[id as usize],
                (op::DECORATE, None) => words[2..].starts_with(&[BUILT_IN, WORKGROUP_SIZE]),
                (op::NAME | op::MEMBER_NAME | op::MEMBER_DECORATE | op::ENTRY_POINT, None) => false,
                (op::TYPE_FORWARD_POINTER, None) => false,
                _ => true,
            };
            if is_used {
                mark(&mut used, &words[1..]);
            }
            !is_used
        });
        are_pending.reverse();
        if are_pending.len() == before {
            break;
        }
    }
    // A word that only looks like an id does not bring back one of a function that is gone.
    let are_types = globals
        .iter()
        .filter(|words| declared(words) == Some(words[1]));
    let types: HashSet<u32> = are_types.map(|words| words[1]).collect();
    let mut is_there = vec![false; bound as usize];
    for one in instructions_of(code) {
        match *one.words {
            [_, label] if one.op == op::LABEL => is_there[label as usize] = true,
            [_, of_type, id, ..] if types.contains(&of_type) => is_there[id as usize] = true,
            _ => {}
        }
    }
    for id in globals.iter().filter_map(|words| declared(words)) {
        is_there[id as usize] = used[id as usize];
    }
    is_there
}

/// An instruction outside of functions, if anything needs it; entry points without the variables that nothing does.
fn without_unused(words: &[u32], used: &[bool]) -> Option<Vec<u32>> {
    let is_used = |id: u32| used[id as usize];
    match opcode(words) {
        op::ENTRY_POINT => {
            let (head, variables) = words.split_at(interface(words));
            let variables = variables.iter().copied().filter(|id| is_used(*id));
            Some(instruction(
                op::ENTRY_POINT,
                &[&head[1..], &variables.collect::<Vec<_>>()].concat(),
            ))
        }
        op::NAME
        | op::MEMBER_NAME
        | op::DECORATE
        | op::MEMBER_DECORATE
        | op::TYPE_FORWARD_POINTER => is_used(words[1]).then(|| words.to_vec()),
        _ => declared(words).is_none_or(is_used).then(|| words.to_vec()),
    }
}

/// A module, and what is known of its ids.
struct Module {
    bound: u32,
    /// The values of constants, and of what follows from them: 32 bits each, 0 or 1 of truth values.
    values: HashMap<u32, u32>,
    /// The types whose values are known by them: whole numbers of 32 bits and truth values.
    scalars: HashSet<u32>,
    bools: HashSet<u32>,
    /// Values that nothing reads.
    undefined: Vec<Vec<u32>>,
}

impl Module {
    /// What is outside of functions, with values in place of constants.
    fn with_constants(
        &mut self,
        globals: &[Instruction<'_>],
        constants: &[(u32, u32)],
    ) -> Vec<Vec<u32>> {
        let numbers: HashMap<u32, u32> = globals
            .iter()
            .filter(|one| one.op == op::DECORATE && one.words[2] == SPEC_ID)
            .map(|one| (one.words[1], one.words[3]))
            .collect();
        let given = |id: u32| {
            let number = numbers.get(&id)?;
            let (_, value) = constants.iter().find(|(constant, _)| constant == number)?;
            Some(*value)
        };
        let mut out = Vec::with_capacity(globals.len());
        for one in globals {
            let words = one.words;
            let value = match one.op {
                op::TYPE_BOOL => {
                    self.bools.insert(words[1]);
                    self.scalars.insert(words[1]);
                    None
                }
                op::TYPE_INT if words[2] == 32 => {
                    self.scalars.insert(words[1]);
                    None
                }
                op::CONSTANT_TRUE => Some(1),
                op::CONSTANT_FALSE => Some(0),
                op::SPEC_CONSTANT_TRUE | op::SPEC_CONSTANT_FALSE => {
                    let default = u32::from(one.op == op::SPEC_CONSTANT_TRUE);
                    Some(given(words[2]).map_or(default, |value| u32::from(value != 0)))
                }
                op::CONSTANT if words.len() == 4 => Some(words[3]),
                op::SPEC_CONSTANT if words.len() == 4 => Some(given(words[2]).unwrap_or(words[3])),
                op::SPEC_CONSTANT_OP if self.scalars.contains(&words[1]) => {
                    self.evaluated(words[3] as u16, &words[4..])
                }
                _ => None,
            };
            let is_number = one.op == op::DECORATE && words[2] == SPEC_ID;
            if let Some(value) = value {
                let (of_type, id) = (words[1], words[2]);
                self.values.insert(id, value);
                out.push(match (self.bools.contains(&of_type), value) {
                    (true, 0) => instruction(op::CONSTANT_FALSE, &[of_type, id]),
                    (true, _) => instruction(op::CONSTANT_TRUE, &[of_type, id]),
                    (false, _) => instruction(op::CONSTANT, &[of_type, id, value]),
                });
            } else if one.op == op::SPEC_CONSTANT_COMPOSITE {
                out.push(instruction(op::CONSTANT_COMPOSITE, &words[1..]));
            } else if !is_number {
                out.push(words.to_vec());
            }
        }
        out
    }

    /// The result of an operation, if it follows from what is known.
    fn evaluated(&self, operation: u16, operands: &[u32]) -> Option<u32> {
        let known = |at: usize| operands.get(at).and_then(|id| self.values.get(id)).copied();
        let (a, b) = (known(0), known(1));
        match (operation, a, b) {
            // Or and And may follow from one of both.
            (op::LOGICAL_OR, Some(1), _) | (op::LOGICAL_OR, _, Some(1)) => return Some(1),
            (op::LOGICAL_AND, Some(0), _) | (op::LOGICAL_AND, _, Some(0)) => return Some(0),
            (op::LOGICAL_NOT, Some(a), _) => return Some(1 - a),
            (op::SELECT, Some(which), _) => return if which != 0 { b } else { known(2) },
            (op::S_NEGATE, Some(a), _) => return Some(a.wrapping_neg()),
            (op::NOT, Some(a), _) => return Some(!a),
            _ => {}
        }
        let (a, b) = (a?, b?);
        let (signed_a, signed_b) = (a as i32, b as i32);
        Some(match operation {
            op::I_ADD => a.wrapping_add(b),
            op::I_SUB => a.wrapping_sub(b),
            op::I_MUL => a.wrapping_mul(b),
            op::U_DIV => a.checked_div(b)?,
            op::U_MOD => a.checked_rem(b)?,
            op::SHIFT_RIGHT_LOGICAL => a.checked_shr(b)?,
            op::SHIFT_LEFT_LOGICAL => a.checked_shl(b)?,
            op::LOGICAL_EQUAL | op::I_EQUAL => u32::from(a == b),
            op::LOGICAL_NOT_EQUAL | op::I_NOT_EQUAL => u32::from(a != b),
            op::LOGICAL_OR | op::BITWISE_OR => a | b,
            op::LOGICAL_AND | op::BITWISE_AND => a & b,
            op::BITWISE_XOR => a ^ b,
            op::U_GREATER_THAN => u32::from(a > b),
            op::S_GREATER_THAN => u32::from(signed_a > signed_b),
            op::U_GREATER_THAN_EQUAL => u32::from(a >= b),
            op::S_GREATER_THAN_EQUAL => u32::from(signed_a >= signed_b),
            op::U_LESS_THAN => u32::from(a < b),
            op::S_LESS_THAN => u32::from(signed_a < signed_b),
            op::U_LESS_THAN_EQUAL => u32::from(a <= b),
            op::S_LESS_THAN_EQUAL => u32::from(signed_a <= signed_b),
            _ => return None,
        })
    }

    /// A function without the blocks that its constants switch off.
    fn folded(&mut self, function: &[Instruction<'_>]) -> Vec<u32> {
        let mut flow = self.flow(function, &HashSet::new());
        // Where a block is gone, a variable may be left that is stored once: it has that value wherever it is read.
        let mut stored_once = HashSet::new();
        loop {
            let once = flow.stored_once(function);
            if once == stored_once {
                break;
            }
            stored_once = once;
            flow = self.flow(function, &stored_once);
        }
        let mut out = Vec::new();
        let before_blocks = flow
            .blocks
            .first()
            .map_or(function.len(), |first| first.code.start);
        for one in &function[..before_blocks] {
            out.extend(one.words);
        }
        for (number, block) in flow.blocks.iter().enumerate() {
            let code = &function[block.code.clone()];
            match block.fate {
                Fate::Gone => {}
                Fate::Named => {
                    out.extend(code[0].words);
                    out.extend(instruction(op::UNREACHABLE, &[]));
                }
                Fate::NamedToContinue(header) => {
                    out.extend(code[0].words);
                    out.extend(instruction(op::BRANCH, &[header]));
                }
                Fate::Reached => self.emit(&flow, number, code, &mut out),
            }
        }
        out.extend(instruction(op::FUNCTION_END, &[]));
        out
    }

    /// Writes a block that is reached.
    fn emit(&mut self, flow: &Flow, number: usize, code: &[Instruction<'_>], out: &mut Vec<u32>) {
        let block = &flow.blocks[number];
        let end = &code[code.len() - 1];
        for one in code {
            match (one.op, block.taken) {
                (op::PHI, _) => {
                    let mut words = one.words[1..3].to_vec();
                    for pair in one.words[3..].chunks_exact(2) {
                        if flow.edges.contains(&(flow.places[&pair[1]], number)) {
                            words.extend(pair);
                        }
                    }
                    if let Some(continues) = flow.unreached_continue(code) {
                        let undefined = self.bound;
                        self.bound += 1;
                        self.undefined
                            .push(instruction(op::UNDEF, &[one.words[1], undefined]));
                        words.extend([undefined, continues]);
                    }
                    out.extend(instruction(op::PHI, &words));
                }
                (op::SELECTION_MERGE, Some(_)) if end.op == op::BRANCH_CONDITIONAL => {}
                (op::BRANCH_CONDITIONAL, Some(taken)) => {
                    out.extend(instruction(op::BRANCH, &[taken]))
                }
                // What is inside may leave a switch by its merge block, so it stays one.
                (op::SWITCH, Some(taken)) => {
                    out.extend(instruction(op::SWITCH, &[one.words[1], taken]));
                }
                _ => out.extend(one.words),
            }
        }
    }

    /// Finds which blocks of a function are reached, and how. A variable that is stored once has the value that is stored.
    fn flow(&mut self, function: &[Instruction<'_>], stored_once: &HashSet<u32>) -> Flow {
        let mut flow = Flow::new(function);
        if let Some(first) = flow.blocks.first_mut() {
            first.fate = Fate::Reached;
        }
        // A block comes after those through which it is reached, but for the way back to a loop's header, which was reached before.
        for number in 0..flow.blocks.len() {
            let block = &flow.blocks[number];
            if block.fate != Fate::Reached {
                continue;
            }
            let label = function[block.code.start].words[1];
            let code = &function[block.code.clone()];
            for one in code {
                let words = one.words;
                match one.op {
                    op::PHI => {
                        if let Some(value) = self.joined(&flow, number, &words[3..]) {
                            self.values.insert(words[2], value);
                        }
                    }
                    op::LOOP_MERGE => {
                        flow.name(words[1], Fate::Named);
                        flow.name(words[2], Fate::NamedToContinue(label));
                    }
                    op::BRANCH => flow.reach(number, words[1]),
                    op::BRANCH_CONDITIONAL | op::SWITCH => {
                        let known = self.values.get(&words[1]).copied();
                        let taken = known.map(|value| target(one, value));
                        flow.blocks[number].taken = taken;
                        match taken {
                            Some(taken) => flow.reach(number, taken),
                            None => targets(one).for_each(|label| flow.reach(number, label)),
                        }
                        let merge = code.iter().find(|one| one.op == op::SELECTION_MERGE);
                        if let Some(merge) = merge
                            && (taken.is_none() || one.op == op::SWITCH)
                        {
                            flow.name(merge.words[1], Fate::Named);
                        }
                    }
                    op::STORE if stored_once.contains(&words[1]) => {
                        if let Some(value) = self.values.get(&words[2]) {
                            self.values.insert(words[1], *value);
                        }
                    }
                    op::LOAD if stored_once.contains(&words[3]) => {
                        if let Some(value) = self.values.get(&words[3]) {
                            self.values.insert(words[2], *value);
                        }
                    }
                    operation if words.len() > 3 && self.scalars.contains(&words[1]) => {
                        if let Some(value) = self.evaluated(operation, &words[3..]) {
                            self.values.insert(words[2], value);
                        }
                    }
                    _ => {}
                }
            }
        }
        flow
    }

    /// The value that all ways into a block bring.
    fn joined(&self, flow: &Flow, number: usize, pairs: &[u32]) -> Option<u32> {
        let mut joined = None;
        for pair in pairs.chunks_exact(2) {
            let from = flow.places[&pair[1]];
            if from >= number {
                return None; // the way back of a loop
            }
            if flow.edges.contains(&(from, number)) {
                let value = *self.values.get(&pair[0])?;
                if joined.is_some_and(|joined| joined != value) {
                    return None;
                }
                joined = Some(value);
            }
        }
        joined
    }
}

/// The labels to which a conditional branch or a switch may go.
fn targets<'a>(one: &Instruction<'a>) -> impl Iterator<Item = u32> + use<'a> {
    let words = one.words;
    let (first, step) = if one.op == op::SWITCH { (2, 2) } else { (2, 1) };
    // A conditional branch may have two weights behind its labels.
    let count = if one.op == op::SWITCH { words.len() } else { 4 };
    words[first..count].iter().step_by(step).copied()
}

/// The label to which it goes.
fn target(one: &Instruction<'_>, value: u32) -> u32 {
    let words = one.words;
    if one.op == op::SWITCH {
        let mut cases = words[3..].chunks_exact(2);
        return cases
            .find(|case| case[0] == value)
            .map_or(words[2], |case| case[1]);
    }
    words[if value != 0 { 2 } else { 3 }]
}

/// What becomes of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fate {
    Gone,
    /// Not reached, but the end of a construct.
    Named,
    /// Not reached, but where a loop would go on, whose header this is.
    NamedToContinue(u32),
    Reached,
}

struct Block {
    /// Its instructions, of the function's.
    code: Range<usize>,
    fate: Fate,
    /// Where it goes, if a constant decides that.
    taken: Option<u32>,
}

struct Flow {
    blocks: Vec<Block>,
    /// The blocks' numbers by their labels.
    places: HashMap<u32, usize>,
    /// From which block one comes to which.
    edges: HashSet<(usize, usize)>,
}

impl Flow {
    fn new(function: &[Instruction<'_>]) -> Self {
        let is_label = |at: &usize| function[*at].op == op::LABEL;
        let begins: Vec<usize> = (0..function.len()).filter(is_label).collect();
        let ends = begins[1.min(begins.len())..].iter().copied();
        let ends = ends.chain([function.len() - 1]);
        let blocks = begins.iter().zip(ends).map(|(&begin, end)| Block {
            code: begin..end,
            fate: Fate::Gone,
            taken: None,
        });
        let labels = begins.iter().map(|&begin| function[begin].words[1]);
        Self {
            blocks: blocks.collect(),
            places: labels.zip(0..).collect(),
            edges: HashSet::new(),
        }
    }

    /// The variables of a function that are stored once in the blocks that are reached, and otherwise loaded alone.
    fn stored_once(&self, function: &[Instruction<'_>]) -> HashSet<u32> {
        let reached = self.blocks.iter().filter(|one| one.fate == Fate::Reached);
        let reached = reached.flat_map(|block| &function[block.code.clone()]);
        let mut stores: HashMap<u32, u32> = HashMap::new();
        for one in reached.clone().filter(|one| one.op == op::VARIABLE) {
            // One with a value from the start has been stored.
            stores.insert(one.words[2], u32::from(one.words.len() > 4));
        }
        for one in reached {
            let (pointer, others) = match (one.op, one.words) {
                (op::VARIABLE, _) => continue,
                (op::LOAD, [_, _, _, from, more @ ..]) => (*from, more),
                (op::STORE, [_, to, more @ ..]) => {
                    stores.entry(*to).and_modify(|count| *count += 1);
                    (*to, more)
                }
                (_, words) => (0, &words[1..]),
            };
            // Whoever else has its address may store it.
            for other in others.iter().filter(|other| **other != pointer) {
                stores.remove(other);
            }
        }
        let once = stores.into_iter().filter(|(_, count)| *count == 1);
        once.map(|(variable, _)| variable).collect()
    }

    fn reach(&mut self, from: usize, label: u32) {
        let to = self.places[&label];
        self.edges.insert((from, to));
        self.blocks[to].fate = Fate::Reached;
    }

    fn name(&mut self, label: u32, fate: Fate) {
        let block = &mut self.blocks[self.places[&label]];
        if block.fate == Fate::Gone {
            block.fate = fate;
        }
    }

    /// The label of the block in which a loop would go on, if these are its header's instructions and nothing goes on.
    fn unreached_continue(&self, header: &[Instruction<'_>]) -> Option<u32> {
        let merge = header.iter().find(|one| one.op == op::LOOP_MERGE)?;
        let block = &self.blocks[self.places[&merge.words[2]]];
        matches!(block.fate, Fate::NamedToContinue(_)).then_some(merge.words[2])
    }
}

#[cfg(test)]
mod tests;
