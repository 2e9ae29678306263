// replay_controls.ts — what plays a recorded run: play and pause, frame by frame, a slider over its time, its speed.
import { button, h, select } from "../page/dom.ts";
import { icon } from "../page/icons.ts";
import { speedsFor } from "../mesh3d/player.ts";
import type { Command, LiveFrame, Recorded } from "./protocol.ts";

const STEPS = 2000; // of the slider

export class ReplayControls {
  readonly element: HTMLElement;
  private readonly slider = h("input", {
    type: "range",
    min: 0,
    max: STEPS,
    step: 1,
    value: 0,
    "aria-label": "Time",
  });
  private readonly readout = h("output", { class: "mesh-readout" });
  private readonly playButton = h("button", { type: "button", class: "button play" }, icon("play"));
  private touched = 0;
  private time = 0;
  private paused = true;
  private readonly speeds: readonly number[];
  private readonly speed: HTMLSelectElement;

  /** @param send  at once @param sendSoon  with the next picture: of many the last */
  constructor(
    private readonly recorded: Recorded,
    private readonly send: (command: Command) => void,
    private readonly sendSoon: (command: Command) => void,
  ) {
    this.speeds = speedsFor(this.duration).speeds;
    this.playButton.addEventListener("click", () => this.toggle());
    this.slider.addEventListener("input", () => this.moved());
    const step = button("Next frame", "Go to the next recorded frame", () => send({ kind: "step" }));
    const first = button("From the start", "Play from the first frame", () => send({ kind: "play" }));
    const factor = (value: number) => ({ value: String(value), label: `${value}×` });
    const speed = select("Speed", this.speeds.map(factor), "1", (value) =>
      send({ kind: "rate", values: [Number(value)] }),
    );
    this.speed = speed.querySelector("select")!;
    this.element = h(
      "fieldset",
      { class: "live-replay" },
      h("div", { class: "mesh-playback" }, this.playButton, this.slider, this.readout),
      h("div", { class: "live-buttons" }, step, first, speed),
    );
    this.show();
  }

  private get duration(): number {
    return this.recorded.end_s - this.recorded.start_s;
  }

  toggle(): void {
    this.send({ kind: "pause", index: this.paused ? 0 : 1 });
  }

  private moved(): void {
    this.touched = performance.now();
    this.time = this.recorded.start_s + (Number(this.slider.value) / STEPS) * this.duration;
    if (!this.paused) this.send({ kind: "pause", index: 1 });
    this.sendSoon({ kind: "seek", values: [this.time] });
    this.show();
  }

  /** From the program; the slider stays where a hand has it. */
  follow(frame: LiveFrame): void {
    this.paused = frame.paused;
    const rate = this.speeds.find((speed) => Math.abs(speed / frame.realtimeFactor - 1) < 1e-3);
    if (rate && document.activeElement !== this.speed) this.speed.value = String(rate);
    if (performance.now() - this.touched > 500) {
      this.time = frame.time;
      const share = this.duration > 0 ? (frame.time - this.recorded.start_s) / this.duration : 1;
      this.slider.value = String(Math.round(STEPS * share));
    }
    this.show();
  }

  private show(): void {
    const long = this.recorded.end_s >= 0.5;
    const digits = long ? 3 : 1;
    const shown = (time: number) => (long ? time : 1000 * time).toFixed(digits);
    const text = `${shown(this.time)} of ${shown(this.recorded.end_s)}\u00a0${long ? "s" : "ms"}`;
    if (this.readout.textContent !== text) this.readout.textContent = text;
    this.slider.setAttribute("aria-valuetext", text);
    const playing = String(!this.paused);
    if (this.playButton.dataset["playing"] === playing) return;
    this.playButton.dataset["playing"] = playing;
    this.playButton.replaceChildren(icon(this.paused ? "play" : "pause"));
    this.playButton.title = this.paused ? "Play (Space)" : "Pause (Space)";
    this.playButton.setAttribute("aria-label", this.paused ? "Play" : "Pause");
  }
}
