use super::*;

/// Ids of the module below.
const VOID: u32 = 1;
const BOOL: u32 = 2;
const WHICH: u32 = 3;
const MAIN: u32 = 4;
const CALLED: u32 = 5;
const DROPPED: u32 = 6;
const OF_FUNCTIONS: u32 = 7;
const ENTRY: u32 = 8;
const THEN: u32 = 9;
const ELSE: u32 = 10;
const MERGE: u32 = 11;
const JOINED: u32 = 12;
const UINT: u32 = 13;
const LATER: u32 = 14;
const LAST: u32 = 15;
const HEAD: u32 = 16;
const BODY: u32 = 17;
const GOES_ON: u32 = 18;
const AFTER: u32 = 19;
const TURN: u32 = 20;
const ONE: u32 = 21;
const ZERO: u32 = 22;
const END: u32 = 23;

/// A function that calls one function where a constant is true and another where it is not, and then loops, unless the
/// constant is true: `if (WHICH) called(); else dropped(); for (uint turn = 0;; turn = 1) { if (WHICH) break; }`.
fn module() -> Vec<u32> {
    module_of(
        30,
        &[],
        &[
            instruction(op::LABEL, &[ENTRY]),
            instruction(op::SELECTION_MERGE, &[MERGE, 0]),
            instruction(op::BRANCH_CONDITIONAL, &[WHICH, THEN, ELSE]),
            instruction(op::LABEL, &[THEN]),
            instruction(op::FUNCTION_CALL, &[VOID, LATER, CALLED]),
            instruction(op::BRANCH, &[MERGE]),
            instruction(op::LABEL, &[ELSE]),
            instruction(op::FUNCTION_CALL, &[VOID, LAST, DROPPED]),
            instruction(op::BRANCH, &[MERGE]),
            instruction(op::LABEL, &[MERGE]),
            instruction(op::PHI, &[UINT, JOINED, ONE, THEN, ZERO, ELSE]),
            instruction(op::BRANCH, &[HEAD]),
            instruction(op::LABEL, &[HEAD]),
            instruction(op::PHI, &[UINT, TURN, JOINED, MERGE, ONE, GOES_ON]),
            instruction(op::LOOP_MERGE, &[AFTER, GOES_ON, 0]),
            instruction(op::BRANCH, &[BODY]),
            instruction(op::LABEL, &[BODY]),
            instruction(op::BRANCH_CONDITIONAL, &[WHICH, AFTER, GOES_ON]),
            instruction(op::LABEL, &[GOES_ON]),
            instruction(op::BRANCH, &[HEAD]),
            instruction(op::LABEL, &[AFTER]),
        ],
    )
}

/// A module whose main function has these instructions before its return, more types than others, and ids below a bound.
fn module_of(bound: u32, types: &[Vec<u32>], main: &[Vec<u32>]) -> Vec<u32> {
    let name = u32::from_ne_bytes(*b"main");
    let function = |id: u32, label: u32| {
        [
            instruction(op::FUNCTION, &[VOID, id, 0, OF_FUNCTIONS]),
            instruction(op::LABEL, &[label]),
            instruction(253, &[]), // a return
            instruction(op::FUNCTION_END, &[]),
        ]
    };
    let globals = [
        instruction(op::ENTRY_POINT, &[5, MAIN, name, 0]),
        instruction(op::DECORATE, &[WHICH, SPEC_ID, 7]),
        instruction(op::NAME, &[DROPPED, u32::from_ne_bytes(*b"dro\0")]),
        instruction(op::TYPE_VOID, &[VOID]),
        instruction(op::TYPE_BOOL, &[BOOL]),
        instruction(op::TYPE_INT, &[UINT, 32, 0]),
        instruction(33, &[OF_FUNCTIONS, VOID]), // a function's type
        instruction(op::SPEC_CONSTANT_FALSE, &[BOOL, WHICH]),
        instruction(op::CONSTANT, &[UINT, ZERO, 0]),
        instruction(op::CONSTANT, &[UINT, ONE, 1]),
    ];
    let begin = instruction(op::FUNCTION, &[VOID, MAIN, 0, OF_FUNCTIONS]);
    let end = [instruction(253, &[]), instruction(op::FUNCTION_END, &[])];
    let header = vec![0x0723_0203, 0x0001_0600, 0, bound, 0];
    let functions = [function(CALLED, 24), function(DROPPED, END)].concat();
    let before = [&[header][..], &globals, types, &[begin]].concat();
    [&before[..], main, &end, &functions].concat().concat()
}

#[test]
fn what_a_constant_switches_off_is_gone() {
    let module = module();
    let has = |words: &[u32], op: u16, operands: &[u32]| {
        let wanted = instruction(op, operands);
        instructions(words).iter().any(|one| one.words == wanted)
    };
    let on = specialized(&module, &[(7, 1)]);
    assert!(!has(&on, op::CONSTANT_TRUE, &[BOOL, WHICH])); // nothing asks any more
    assert!(!has(&on, op::DECORATE, &[WHICH, SPEC_ID, 7]));
    assert!(has(&on, op::FUNCTION, &[VOID, CALLED, 0, OF_FUNCTIONS]));
    assert!(!has(&on, op::FUNCTION, &[VOID, DROPPED, 0, OF_FUNCTIONS]));
    assert!(!instructions(&on).iter().any(|one| one.op == op::NAME));
    assert!(has(&on, op::PHI, &[UINT, JOINED, ONE, THEN]));
    assert!(has(&on, op::BRANCH, &[AFTER]));
    // The loop keeps its shape: nothing goes on, and what would come back is undefined.
    assert!(has(&on, op::LOOP_MERGE, &[AFTER, GOES_ON, 0]));
    assert!(has(&on, op::PHI, &[UINT, TURN, JOINED, MERGE, 30, GOES_ON]));
    assert!(has(&on, op::UNDEF, &[UINT, 30]));
    assert_eq!(on[BOUND], 31);

    // The constant's own value, which no other constant's changes.
    let off = specialized(&module, &[(8, 1)]);
    assert!(!has(&off, op::FUNCTION, &[VOID, CALLED, 0, OF_FUNCTIONS]));
    assert!(has(&off, op::PHI, &[UINT, JOINED, ZERO, ELSE]));
    assert!(has(
        &off,
        op::PHI,
        &[UINT, TURN, JOINED, MERGE, ONE, GOES_ON]
    ));
    assert!(!instructions(&off).iter().any(|one| one.op == op::UNDEF));
}

#[test]
fn branches_go_where_their_values_say() {
    // With two weights, and with a label for all other values.
    let two = instruction(op::BRANCH_CONDITIONAL, &[WHICH, THEN, ELSE, 1, 2]);
    let many = instruction(op::SWITCH, &[TURN, MERGE, 0, THEN, 7, ELSE]);
    let all = [&two, &many].map(|words| instructions_of(words).next().expect("one"));
    let labels = all.map(|one| targets(&one).collect::<Vec<_>>());
    assert_eq!(labels, [vec![THEN, ELSE], vec![MERGE, THEN, ELSE]]);
    for (value, goes) in [(0, [ELSE, THEN]), (7, [THEN, ELSE]), (8, [THEN, MERGE])] {
        assert_eq!(all.map(|one| target(&one, value)), goes, "{value}");
    }
}

#[test]
fn operations_on_constants_are_folded() {
    let module = Module {
        bound: 10,
        values: HashMap::from([(1, 1), (2, 0), (3, 6), (4, u32::MAX)]),
        scalars: HashSet::new(),
        bools: HashSet::new(),
        undefined: Vec::new(),
    };
    // Opcode, operands of which 9 is not known, and what follows.
    for (operation, operands, result) in [
        (op::LOGICAL_OR, &[9, 1][..], Some(1)),
        (op::LOGICAL_OR, &[9, 2], None),
        (op::LOGICAL_AND, &[2, 9], Some(0)),
        (op::LOGICAL_AND, &[1, 9], None),
        (op::LOGICAL_NOT, &[2], Some(1)),
        (op::SELECT, &[1, 3, 9], Some(6)),
        (op::SELECT, &[2, 9, 4], Some(u32::MAX)),
        (op::I_ADD, &[3, 4], Some(5)),
        (op::U_DIV, &[3, 2], None),
        (op::U_GREATER_THAN, &[4, 3], Some(1)),
        (op::S_GREATER_THAN, &[4, 3], Some(0)),
        (op::SHIFT_RIGHT_LOGICAL, &[3, 1], Some(3)),
        (op::I_EQUAL, &[3, 3], Some(1)),
        (op::S_NEGATE, &[3], Some(6_u32.wrapping_neg())),
        (op::NOT, &[3], Some(!6)),
        (op::I_SUB, &[3, 1], Some(5)),
        (op::I_MUL, &[3, 4], Some(6_u32.wrapping_neg())),
        (op::U_MOD, &[4, 3], Some(3)),
        (op::SHIFT_LEFT_LOGICAL, &[3, 1], Some(12)),
        (op::LOGICAL_EQUAL, &[1, 2], Some(0)),
        (op::LOGICAL_NOT_EQUAL, &[1, 2], Some(1)),
        (op::I_NOT_EQUAL, &[3, 3], Some(0)),
        (op::BITWISE_OR, &[3, 1], Some(7)),
        (op::BITWISE_AND, &[3, 4], Some(6)),
        (op::BITWISE_XOR, &[3, 4], Some(!6)),
        (op::U_LESS_THAN, &[3, 3], Some(0)),
        (op::S_LESS_THAN, &[4, 3], Some(1)),
        (op::U_LESS_THAN_EQUAL, &[3, 4], Some(1)),
        (op::S_LESS_THAN_EQUAL, &[3, 4], Some(0)),
        (op::U_GREATER_THAN_EQUAL, &[3, 3], Some(1)),
        (op::S_GREATER_THAN_EQUAL, &[4, 3], Some(0)),
        (4, &[3, 3], None),
    ] {
        assert_eq!(module.evaluated(operation, operands), result, "{operation}");
    }
}

/// `bool both = WHICH && called(); if (both) dropped();`, where `both` is a variable, and the same of one that is stored twice.
#[test]
fn a_variable_that_is_stored_once_has_that_value() {
    const POINTER: u32 = 31;
    const BOTH: u32 = 32;
    const LOADED: u32 = 33;
    let pointer = instruction(32, &[POINTER, 7, BOOL]);
    let condition = |more: &[Vec<u32>]| {
        let stores = [
            instruction(op::LABEL, &[ENTRY]),
            instruction(op::VARIABLE, &[POINTER, BOTH, 7]),
            instruction(op::SELECTION_MERGE, &[MERGE, 0]),
            instruction(op::BRANCH_CONDITIONAL, &[WHICH, THEN, MERGE]),
            instruction(op::LABEL, &[THEN]),
            instruction(op::FUNCTION_CALL, &[BOOL, LATER, CALLED]),
            instruction(op::BRANCH, &[MERGE]),
            instruction(op::LABEL, &[MERGE]),
            instruction(op::PHI, &[BOOL, JOINED, WHICH, ENTRY, LATER, THEN]),
            instruction(op::STORE, &[BOTH, JOINED]),
        ];
        let loads = [
            instruction(op::LOAD, &[BOOL, LOADED, BOTH]),
            instruction(op::SELECTION_MERGE, &[AFTER, 0]),
            instruction(op::BRANCH_CONDITIONAL, &[LOADED, BODY, AFTER]),
            instruction(op::LABEL, &[BODY]),
            instruction(op::FUNCTION_CALL, &[VOID, LAST, DROPPED]),
            instruction(op::BRANCH, &[AFTER]),
            instruction(op::LABEL, &[AFTER]),
        ];
        module_of(
            34,
            std::slice::from_ref(&pointer),
            &[&stores, more, &loads[..]].concat(),
        )
    };
    let drops = |module: &[u32], which: u32| {
        let made = specialized(module, &[(7, which)]);
        let dropped = instruction(op::FUNCTION, &[VOID, DROPPED, 0, OF_FUNCTIONS]);
        !instructions(&made).iter().any(|one| one.words == dropped)
    };
    let once = condition(&[]);
    assert!(drops(&once, 0) && !drops(&once, 1));
    let stored = instruction(op::STORE, &[BOTH, LATER]);
    assert!(!drops(&condition(&[stored]), 0));
    // Whoever gets the variable's address may store it.
    let lent = instruction(op::FUNCTION_CALL, &[VOID, LAST, CALLED, BOTH]);
    assert!(!drops(&condition(&[lent]), 0));
}
