// slider.ts — a labelled slider with its value as a number that can be typed, and its unit.
import { h } from "../page/dom.ts";

export class Slider {
  readonly element: HTMLElement;
  private readonly range: HTMLInputElement;
  private readonly box: HTMLInputElement;
  private readonly mark = h("i", { class: "live-mark", hidden: true });
  private readonly now = h("output", { class: "live-now", hidden: true });
  private touched = 0;
  private held = 0;

  /** @param acts  on every move; @param settles  only when the hand comes off: what is dear */
  constructor(
    id: string,
    label: string,
    private readonly unit: string,
    private readonly least: number,
    private readonly most: number,
    value: number,
    step: number,
    when: "acts" | "settles",
    private readonly act: (value: number) => void,
    private readonly scale: "linear" | "log" = "linear",
  ) {
    // Places of the slider are multiples of the step, or shares of the way in the logarithm; a typed number is kept as it is.
    const common =
      scale === "log"
        ? { min: 0, max: 1, step: 0.005, id }
        : { min: step * Math.ceil(least / step - 1e-9), max: most, step, id };
    this.range = h("input", { type: "range", ...common, "aria-label": `${label} [${unit}]` });
    this.box = h("input", {
      type: "number",
      min: least,
      max: most,
      step: "any",
      "aria-label": `${label} [${unit}], number`,
    });
    this.element = h(
      "div",
      { class: "live-slider" },
      h("label", { for: id }, label),
      h("span", { class: "live-track" }, this.range, this.mark),
      h("span", { class: "live-value" }, this.box, h("span", { class: "unit" }, unit)),
      this.now,
    );
    this.set(value);
    this.range.addEventListener("input", () => this.moved(this.placed, when === "acts"));
    this.range.addEventListener("change", () => this.moved(this.placed, true));
    this.box.addEventListener("change", () => this.moved(Number(this.box.value), true));
  }

  /** The number at the slider's place, a log one to three digits. */
  private get placed(): number {
    const place = Number(this.range.value);
    if (this.scale === "linear") return place;
    return Number((this.least * (this.most / this.least) ** place).toPrecision(3));
  }

  get value(): number {
    return this.held;
  }

  set(value: number): void {
    this.held = value;
    this.range.value = String(this.place(value));
    this.range.setAttribute("aria-valuetext", `${Number(value.toPrecision(4))} ${this.unit}`);
    if (document.activeElement !== this.box) this.box.value = String(Number(value.toPrecision(4)));
  }

  /** Where what it leads is now: a mark on the slider and a number below, beside the target that the slider itself shows. */
  showNow(value: number, digits: number): void {
    const [least, most] = [Number(this.range.min), Number(this.range.max)];
    const share = Math.min(1, Math.max(0, (this.place(value) - least) / (most - least)));
    const text = `now ${(Math.abs(value) < 0.5 * 10 ** -digits ? 0 : value).toFixed(digits).replace("-", "−")} ${this.unit}`;
    this.mark.hidden = this.now.hidden = false;
    this.mark.style.setProperty("--share", share.toFixed(4));
    if (this.now.textContent !== text) this.now.textContent = text;
  }

  private place(value: number): number {
    return this.scale === "log" ? Math.log(value / this.least) / Math.log(this.most / this.least) : value;
  }

  /** From the program; not while a hand is on it. */
  follow(value: number): void {
    if (performance.now() - this.touched > 600) this.set(value);
  }

  private moved(value: number, send: boolean): void {
    const kept = Math.min(this.most, Math.max(this.least, Number.isFinite(value) ? value : this.least));
    this.touched = performance.now();
    this.set(kept);
    if (send) this.act(kept);
  }

  set disabled(off: boolean) {
    this.range.disabled = this.box.disabled = off;
  }
}
