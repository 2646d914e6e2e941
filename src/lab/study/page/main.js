// Goes from screen to screen, keeps the state, and listens to the keyboard.

"use strict";

let state = record.load();
let items = [];
// When the item on the screen was last seen to be looked at.
let looked = 0;

const keep = () => record.keep(state);
const current = () => (state.screen === "item" ? items[state.index] : null);

function show() {
  sweep.stop();
  items = state.participant ? plan(STUDY, state.participant, state.group) : [];
  // A state that this page cannot have written begins again.
  if (!(state.screen in screens) || (state.screen === "item" && !current())) state.screen = "consent";
  find("screen").replaceChildren(find(state.screen).content.cloneNode(true));
  screens[state.screen].show(state, current(), keep, items);
  const form = document.querySelector("form");
  form.addEventListener("submit", submit);
  form.querySelector(".back")?.addEventListener("click", back);
  find("stop")?.addEventListener("click", () => go("done"));
  find("again")?.addEventListener("click", again);
  showProgress();
  looked = performance.now();
  window.scrollTo(0, 0);
  document.querySelector("h1").focus({ focusVisible: true });
  keep();
  find("storage").hidden = record.keeps;
}

function showProgress() {
  const done = items.filter(({ key }) => state.drafts[key]?.at).length;
  const item = current();
  const names = { consent: "Introduction", about: "About you", questions: "In your own words", done: "The end" };
  find("progress-text").textContent = item ? `Question ${state.index + 1} of ${items.length}` : names[state.screen];
  Object.assign(find("progress"), { max: Math.max(1, items.length), value: done });
}

// Adds the time that the item was looked at since the last time.
function time() {
  const now = performance.now();
  const draft = current() && state.drafts[current().key];
  if (draft && !document.hidden) draft.ms += now - looked;
  looked = now;
}

function go(screen, index = state.index) {
  time();
  Object.assign(state, { screen, index });
  show();
}

function submit(event) {
  event.preventDefault();
  if (state.screen === "done") {
    const name = record.save(record.file(state, items));
    find("saved").textContent = `Saved as ${name}, where your browser saves files.`;
    return;
  }
  time();
  if (!screens[state.screen].leave(state, current())) return;
  if (state.screen === "item" && state.index + 1 < items.length) go("item", state.index + 1);
  else go(screens[state.screen].next);
}

function back() {
  if (state.screen === "item" && state.index > 0) go("item", state.index - 1);
  else go(screens[state.screen].back);
}

function again() {
  if (!confirm("Delete all answers from this browser? Save them first if you have not.")) return;
  record.clear();
  state = record.empty();
  show();
}

document.addEventListener("keydown", (event) => {
  const { key, target } = event;
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (screens[state.screen].press?.(key, target)) {
    event.preventDefault();
  } else if (key === "Enter" && !target.matches("button, select, textarea")) {
    event.preventDefault();
    // A key that is held down confirms one answer, not all.
    if (!event.repeat) document.querySelector("form").requestSubmit();
  }
});

// What is hidden is not looked at.
document.addEventListener("visibilitychange", () => {
  if (document.hidden) {
    const draft = current() && state.drafts[current().key];
    if (draft) draft.ms += performance.now() - looked;
    keep();
  }
  looked = performance.now();
});

window.addEventListener("pagehide", () => {
  time();
  keep();
});

find("study").textContent = STUDY.id;
show();
