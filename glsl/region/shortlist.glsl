// The surfaces that an invocation has to ask: all of its layer's region, or those of its block's shortlist, which keeps of the
// region what the block's bounds leave open. A region of many surfaces so costs a Gaussian no more than those near it. A
// shortlist is a word, 4 times the number of its surfaces and the side of the block, and for each surface its number and its
// operators. Included after the buffer `shortlists` is declared.
#ifndef RARA_REGION_SHORTLIST
#define RARA_REGION_SHORTLIST
#include "region/answers.glsl"
#include "region/surface.glsl"

// True when some layer's region has as many surfaces as SHORTLIST_FROM.
layout(constant_id = 13) const bool SHORTLISTED = false;

// The word of a shortlist that has no room for the surfaces that may cut the block.
const uint ALL_SURFACES = 0xffffffffu;
// A shortlist holds the surfaces of Gaussians whose bands reach this many times as far as without perspective.
const float SHORTLIST_WIDENING = 2.0;

// Of the shortlist that is gone through: its first word's place, and that word, or ALL_SURFACES.
uint shortlist_place = 0u;
uint shortlist = ALL_SURFACES;

// Goes through the shortlist of a block from now on, for Gaussians whose band is widened by this much, if it serves them.
void enter_shortlist(uint block, float widening) {
    if (SHORTLISTED) {
        shortlist_place = block * SHORTLIST_WORDS;
        shortlist = widening <= SHORTLIST_WIDENING ? shortlists.at[shortlist_place] : ALL_SURFACES;
    }
}

// Goes through all surfaces of the region from now on.
void leave_shortlist() {
    shortlist = ALL_SURFACES;
}

bool has_shortlist() {
    return SHORTLISTED && shortlist != ALL_SURFACES;
}

// The side of all Gaussians of the block, SIDE_CUTOFF where they may differ.
uint shortlist_side() {
    return shortlist & 3u;
}

// How many surfaces there are to ask.
uint surface_count() {
    return has_shortlist() ? shortlist >> 2 : LAYER.region.surface_count;
}

uint surface_at(uint i) {
    return has_shortlist() ? shortlists.at[shortlist_place + 1u + 2u * i] : LAYER.region.first_surface + i;
}

// The operators that follow a surface's answer.
uint operators_at(uint i) {
    return has_shortlist() ? shortlists.at[shortlist_place + 2u + 2u * i] : surfaces.at[surface_at(i)].operators;
}

// The region's answer, from those of the surfaces that were asked so far.
struct RegionAnswer {
    Answers parts; // of a region with parts
    uint list; // the side of a list
};

RegionAnswer unasked() {
    return RegionAnswer(Answers(0u, 0u), side_undecided());
}

// False where the surfaces that were not asked have no say.
bool is_open(RegionAnswer region) {
    return has_parts() || region.list != side_that_decides();
}

void add_answer(inout RegionAnswer region, uint i, uint side) {
    if (has_parts()) {
        answer(region.parts, side, operators_at(i));
    } else {
        region.list = combined_side(region.list, side);
    }
}

uint side_of(RegionAnswer region) {
    return has_parts() ? side_answered(region.parts) : region.list;
}

#endif
