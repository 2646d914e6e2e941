// The moving cut on both sides, always at the same step.

"use strict";

const sweep = {
  // Steps a second.
  rate: 12,
  isPlaying: !matchMedia("(prefers-reduced-motion: reduce)").matches,
  // Ends what the item before has begun.
  stop() {},

  // Plays two sheets of steps on two canvases, there and back; button and slider belong to both.
  start(canvases, sheets, button, slider) {
    this.stop();
    const { frames, columns, size } = STUDY.sweep;
    let [step, shown, since, request, ended] = [0, -1, 0, 0, false];
    slider.max = frames - 1;
    for (const canvas of canvases) [canvas.width, canvas.height] = [size, size];
    const images = sheets.map((sheet) => Object.assign(new Image(), { src: sheet }));

    const draw = () => {
      const at = Math.floor(step) % (2 * frames - 2);
      const frame = at < frames ? at : 2 * frames - 2 - at;
      if (frame === shown) return;
      shown = frame;
      slider.value = frame;
      canvases.forEach((canvas, side) => {
        const [x, y] = [(frame % columns) * size, Math.floor(frame / columns) * size];
        canvas.getContext("2d").drawImage(images[side], x, y, size, size, 0, 0, size, size);
      });
    };
    const tick = (now) => {
      if (ended) return;
      // A page that was hidden goes on where it was.
      if (this.isPlaying) step += Math.min((now - since) / 1000, 0.25) * this.rate;
      since = now;
      draw();
      request = requestAnimationFrame(tick);
    };
    const label = () => {
      button.textContent = this.isPlaying ? "Pause" : "Play";
    };
    button.addEventListener("click", () => {
      this.isPlaying = !this.isPlaying;
      label();
    });
    // Whoever takes the slider stops the cut, also if the slider stays where it is.
    const hold = () => {
      this.isPlaying = false;
      step = Number(slider.value);
      label();
    };
    for (const kind of ["input", "pointerdown"]) slider.addEventListener(kind, hold);
    slider.addEventListener("keydown", (event) => {
      if (/^(Arrow|Home$|End$|Page)/.test(event.key)) hold();
    });
    label();
    this.stop = () => {
      ended = true;
      cancelAnimationFrame(request);
    };
    Promise.all(images.map((image) => image.decode())).then(
      () => {
        since = performance.now();
        request = requestAnimationFrame(tick);
      },
      () => {
        button.disabled = true;
        button.textContent = "Missing";
      },
    );
  },
};
