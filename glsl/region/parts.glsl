// A stack of the parts of a region, of which some are decided. A part is a word: 0 or 1 where it is decided, else 2 and the
// number of its first surface in a list, which ends with the part's last one. The includer says whether there are parts, as
// HAS_PARTS, and keeps the operators of the list's surfaces. Twin: src/reference/region/reduced.rs.
#ifndef RARA_REGION_PARTS
#define RARA_REGION_PARTS
#include "region/answers.glsl"

// Regions of 65536 surfaces need no more than 17.
const uint PART_DEPTH = 18u;

shared uint parts[HAS_PARTS ? PART_DEPTH * gl_WorkGroupSize.x : 1u];

// The operators of a surface of the list.
uint listed_operators(uint entry);
void list_operators(uint entry, uint operators);

// The part that two parts make. `entries` is how many surfaces the list has so far.
uint joined(uint below, uint top, bool is_or, inout uint entries) {
    bool below_decided = below < 2u;
    if (below_decided || top < 2u) {
        uint decided = below_decided ? below : top;
        uint rest = below_decided ? top : below;
        if (decided == (is_or ? 0u : 1u)) {
            return rest;
        }
        // The other part has no say, and its surfaces leave the list.
        if (rest >= 2u) {
            entries = rest - 2u;
        }
        return decided;
    }
    uint operators = listed_operators(entries - 1u);
    uint count = operator_count(operators);
    list_operators(entries - 1u, operators + 1u + (is_or ? 1u << (OPERATOR_SHIFT + count) : 0u));
    return below;
}

// Puts a part onto the stack and joins it with those below.
void push_part(uint part, uint operators, uint first_part, inout uint depth, inout uint entries) {
    parts[first_part + depth++] = part;
    for (uint i = 0u; i < operator_count(operators); i++) {
        depth--;
        uint top = parts[first_part + depth];
        uint below = parts[first_part + depth - 1u];
        parts[first_part + depth - 1u] = joined(below, top, is_or(operators, i), entries);
    }
}

#endif
