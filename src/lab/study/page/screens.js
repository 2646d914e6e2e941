// The screens: each fills its template from the state, and reads it back when it is left, if it may be.

"use strict";

const find = (id) => document.getElementById(id);

const screens = {
  consent: {
    next: "about",
    show() {
      const count = STUDY.cases.length * STUDY.groups[0].length;
      find("count").textContent = count;
      find("minutes").textContent = Math.max(5, Math.ceil((count * 0.4 + 5) / 5) * 5);
    },
    leave(state) {
      state.begun ||= new Date().toISOString();
      return true;
    },
  },

  about: {
    back: "consent",
    next: "item",
    show(state) {
      find("participant").value = state.participant || new URLSearchParams(location.search).get("participant") || "";
      find("age").value = state.background.age;
      find("experience").value = state.background.experience;
    },
    leave(state) {
      const participant = find("participant").value.trim().toUpperCase();
      if (participant !== state.participant) {
        // Another order: what was answered belongs to somebody else.
        const answered = Object.values(state.drafts).some(({ at }) => at);
        if (answered && !confirm("With another code the study begins again, and your answers are deleted.")) return false;
        Object.assign(state, { participant, group: groupOf(participant, location.search), drafts: {}, index: 0 });
      }
      state.background = { age: find("age").value, experience: find("experience").value };
      return true;
    },
  },

  item: {
    back: "about",
    next: "questions",
    show(state, item, keep) {
      const sides = item.left === "hard" ? [item.shown.hard, item.shown.method] : [item.shown.method, item.shown.hard];
      document.querySelector("h1").textContent = `Case ${item.place} of ${STUDY.cases.length}: ${item.metric.name}`;
      find("definition").textContent = item.metric.definition;
      document.querySelector(".sides").classList.toggle("moving", item.metric.moves);
      ["left", "right"].forEach((side, place) => {
        Object.assign(find(`${side}-picture`), { src: sides[place].picture, width: STUDY.size, height: STUDY.size });
      });
      const canvases = [find("left-sweep"), find("right-sweep")];
      sweep.start(canvases, sides.map((side) => side.sweep), find("play"), find("place"));
      this.addStrengths();
      const draft = (state.drafts[item.key] ??= { choice: "", strength: 0, ms: 0, changes: 0, at: "" });
      this.mark(draft);
      document.querySelector("form").addEventListener("change", ({ target }) => {
        if (target.name === "choice") draft.choice = target.value;
        else if (target.name === "strength") draft.strength = Number(target.value);
        else return;
        draft.changes += 1;
        this.mark(draft);
        keep();
      });
    },
    addStrengths() {
      const fieldset = document.querySelector(".strength");
      for (let strength = 1; strength <= 7; strength += 1) {
        const label = document.createElement("label");
        const input = Object.assign(document.createElement("input"), {
          type: "radio",
          name: "strength",
          value: strength,
          required: true,
        });
        const text = Object.assign(document.createElement("span"), { textContent: strength });
        label.append(input, text);
        fieldset.append(label);
      }
    },
    // Shows what was chosen; how much better it is can be said once a side is chosen.
    mark({ choice, strength }) {
      document.querySelector(".strength").disabled = choice === "";
      for (const [name, value] of [["choice", choice], ["strength", String(strength)]]) {
        const input = document.querySelector(`input[name=${name}][value="${value}"]`);
        if (input) input.checked = true;
      }
    },
    leave(state, item) {
      state.drafts[item.key].at = new Date().toISOString();
      return true;
    },
    // Left and right choose a side and digits a strength; up and down change the strength.
    press(key, target) {
      if (/^[1-7]$/.test(key)) return pick("strength", key);
      // Arrows on the slider move it.
      if (target.type === "range") return false;
      const choice = { ArrowLeft: "left", ArrowRight: "right" }[key];
      if (choice) return pick("choice", choice);
      const step = { ArrowUp: 1, ArrowDown: -1 }[key];
      if (!step || target.type !== "radio") return false;
      const chosen = document.querySelector("input[name=strength]:checked");
      const strength = Math.min(7, Math.max(1, (chosen ? Number(chosen.value) : 0) + step));
      return pick("strength", strength);
    },
  },

  questions: {
    back: "item",
    next: "done",
    show(state, item, keep) {
      for (const question of Object.keys(state.questions)) {
        const area = find(question);
        area.value = state.questions[question];
        area.addEventListener("input", () => {
          state.questions[question] = area.value;
          keep();
        });
      }
    },
    leave: () => true,
  },

  done: {
    back: "questions",
    show(state, item, keep, items) {
      const answered = items.filter(({ key }) => state.drafts[key]?.at).length;
      find("summary").textContent = answered === items.length
        ? "You have answered everything. Thank you!"
        : `You have answered ${answered} of ${items.length} questions. What is there helps too; go back to answer the others.`;
    },
  },
};

// Chooses a radio button as a click would, if it can be chosen.
function pick(name, value) {
  const input = document.querySelector(`input[name=${name}][value="${value}"]`);
  if (!input || input.matches(":disabled")) return true;
  input.focus();
  input.click();
  return true;
}
