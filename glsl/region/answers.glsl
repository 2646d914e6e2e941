// A stack of the answers that make the answer of a region with parts: what it surely keeps and what it may keep, a bit each.
// Twin: src/scene/clip/postfix.rs.
#ifndef RARA_REGION_ANSWERS
#define RARA_REGION_ANSWERS
#include "region/sides.glsl"

struct Answers {
    uint surely;
    uint maybe;
};

// A surface's joins: how many there are, and of each whether it is a union.
uint join_count(uint joins) {
    return joins & ((1u << JOIN_SHIFT) - 1u);
}

bool joins_by_or(uint joins, uint place) {
    return (joins >> (JOIN_SHIFT + place) & 1u) != 0u;
}

// The stack after one more answer and its joins.
uint answered(uint stack, bool answer, uint joins) {
    stack = stack << 1 | (answer ? 1u : 0u);
    for (uint i = 0u; i < join_count(joins); i++) {
        stack = joins_by_or(joins, i) ? stack >> 1 | (stack & 1u) : (stack >> 1) & (stack | ~1u);
    }
    return stack;
}

void answer(inout Answers answers, uint side, uint joins) {
    answers.surely = answered(answers.surely, side == SIDE_VISIBLE, joins);
    answers.maybe = answered(answers.maybe, side != SIDE_INVISIBLE, joins);
}

uint side_answered(Answers answers) {
    return (answers.surely & 1u) != 0u ? SIDE_VISIBLE : (answers.maybe & 1u) == 0u ? SIDE_INVISIBLE : SIDE_CUTOFF;
}

#endif
