// A stack of the answers that make the answer of a region with parts: what it surely keeps and what it may keep, a bit each.
// Twin: src/scene/clip/postfix.rs.
#ifndef RARA_REGION_ANSWERS
#define RARA_REGION_ANSWERS
#include "region/sides.glsl"

struct Answers {
    uint surely;
    uint maybe;
};

// A surface's operators: how many there are, and of each whether it is a union.
uint operator_count(uint operators) {
    return operators & ((1u << OPERATOR_SHIFT) - 1u);
}

bool is_or(uint operators, uint place) {
    return (operators >> (OPERATOR_SHIFT + place) & 1u) != 0u;
}

// The stack after one more answer and its operators.
uint answered(uint stack, bool answer, uint operators) {
    stack = stack << 1 | (answer ? 1u : 0u);
    for (uint i = 0u; i < operator_count(operators); i++) {
        stack = is_or(operators, i) ? stack >> 1 | (stack & 1u) : (stack >> 1) & (stack | ~1u);
    }
    return stack;
}

// The same with four answers at once, on a stack of eight.
uint four_answered(uint stack, uint answers, uint operators) {
    stack = stack << 4 | answers;
    for (uint i = 0u; i < operator_count(operators); i++) {
        stack = is_or(operators, i) ? stack >> 4 | (stack & 15u) : (stack >> 4) & (stack | ~15u);
    }
    return stack;
}

void answer(inout Answers answers, uint side, uint operators) {
    answers.surely = answered(answers.surely, side == SIDE_VISIBLE, operators);
    answers.maybe = answered(answers.maybe, side != SIDE_INVISIBLE, operators);
}

uint side_answered(Answers answers) {
    return (answers.surely & 1u) != 0u ? SIDE_VISIBLE : (answers.maybe & 1u) == 0u ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

#endif
