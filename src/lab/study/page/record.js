// What a participant has done: kept in the browser after every step, and saved as a file at the end.

"use strict";

const record = {
  key: `rara study ${STUDY.id}`,

  // False where the browser keeps nothing.
  keeps: true,

  empty() {
    return {
      screen: "consent",
      index: 0,
      participant: "",
      group: 0,
      background: { age: "", experience: "" },
      begun: "",
      drafts: {},
      questions: { properties: "", limitations: "", strengths: "" },
    };
  },

  load() {
    try {
      const kept = { ...this.empty(), ...JSON.parse(localStorage.getItem(this.key)) };
      // What this page cannot have written is not used.
      const parts = [kept.background, kept.drafts, kept.questions];
      return parts.every((part) => part && typeof part === "object") ? kept : this.empty();
    } catch {
      return this.empty();
    }
  },

  keep(state) {
    try {
      localStorage.setItem(this.key, JSON.stringify(state));
    } catch {
      this.keeps = false;
    }
  },

  clear() {
    try {
      localStorage.removeItem(this.key);
    } catch {
      this.keeps = false;
    }
  },

  // The file's content: every item that was confirmed.
  file(state, items) {
    const confirmed = items
      .map((item, place) => ({ item, position: place + 1, draft: state.drafts[item.key] }))
      .filter(({ draft }) => draft?.at);
    return {
      format: STUDY.format,
      version: STUDY.version,
      study: { id: STUDY.id, method: STUDY.method, cases: STUDY.cases.map((shown) => shown.name) },
      participant: state.participant,
      group: state.group,
      background: state.background,
      begun: state.begun,
      saved: new Date().toISOString(),
      answers: confirmed.map(({ item, position, draft }) => ({
        case: item.shown.name,
        metric: item.metric.key,
        left: item.left,
        choice: draft.choice,
        strength: draft.strength,
        ms: Math.round(draft.ms),
        changes: draft.changes,
        at: draft.at,
        position,
      })),
      questions: state.questions,
    };
  },

  // Hands the file to the browser, which saves it.
  save(content) {
    const name = `rara-study-${content.participant || "unknown"}.json`;
    const url = URL.createObjectURL(new Blob([JSON.stringify(content, null, 2)], { type: "application/json" }));
    const link = document.createElement("a");
    link.href = url;
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 60_000);
    return name;
  },
};
