// What a participant is asked, in which order, and what is on the left: the same for the same code, whenever it is asked.

"use strict";

// A number of 32 bits that stands for a text (FNV-1a). Its lowest bit differs between P1 and P2, P2 and P3, and so on.
function hash(text) {
  let value = 0x811c9dc5;
  for (const byte of new TextEncoder().encode(text)) {
    value = Math.imul(value ^ byte, 0x01000193) >>> 0;
  }
  return value;
}

// Random numbers from 0 to below 1, from a text (Marsaglia's xorshift).
function random(seed) {
  let state = hash(seed) || 1;
  const next = () => {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    return (state >>> 0) / 2 ** 32;
  };
  // The first numbers of similar seeds are similar.
  for (let i = 0; i < 16; i += 1) next();
  return next;
}

// The same values in random order (Fisher and Yates).
function shuffled(values, next) {
  const result = [...values];
  for (let last = result.length - 1; last > 0; last -= 1) {
    const other = Math.floor(next() * (last + 1));
    [result[last], result[other]] = [result[other], result[last]];
  }
  return result;
}

// The group, 1 or 2: as the address says by ?group=, or by the code.
function groupOf(participant, address) {
  const asked = new URLSearchParams(address).get("group");
  return asked === "1" || asked === "2" ? Number(asked) : 1 + (hash(participant) & 1);
}

// The items: case by case in random order, each in the three respects of the group. The method is on the left in half of
// the cases.
function plan(study, participant, group) {
  const next = random(`${study.id} ${participant}`);
  const half = study.cases.map((_, place) => (place % 2 === 0 ? "hard" : "method"));
  const lefts = shuffled(half, next);
  return shuffled(study.cases, next).flatMap((shown, place) =>
    study.groups[group - 1].map((metric, part) => ({
      key: `${shown.name}/${metric.key}`,
      place: place + 1,
      part: part + 1,
      shown,
      metric,
      left: lefts[place],
    })),
  );
}
