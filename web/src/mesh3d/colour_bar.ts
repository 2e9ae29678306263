// colour_bar.ts — the scale beside the mesh: colours with numbers.
import { formatTick } from "../format/number.ts";
import { h } from "../page/dom.ts";
import { colourGradient } from "./colour_map.ts";

/** Round numbers from 0 to `range`, four to seven of them, `range` itself not among them unless round. */
export function barTicks(range: number): { values: number[]; increment: number } {
  if (!(range > 0)) return { values: [0], increment: 1 };
  const rough = range / 4.5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const increment = [1, 2, 2.5, 5, 10].map((step) => step * power).find((step) => step >= rough * 0.999) ?? 10 * power;
  const values: number[] = [];
  for (let i = 0; i * increment <= range * 1.0001; i++) values.push(i * increment);
  return { values, increment };
}

export class ColourBar {
  readonly element: HTMLElement;
  private readonly ticks: HTMLElement;

  constructor() {
    const bar = h("div", { class: "bar-colours" });
    bar.style.background = colourGradient("to top");
    this.ticks = h("div", { class: "bar-ticks" });
    this.element = h(
      "div",
      { class: "colour-bar", role: "img", "aria-label": "Colour scale of intensity" },
      h("div", { class: "bar-title" }, "Intensity s [–]"),
      h("div", { class: "bar-body" }, bar, this.ticks),
    );
  }

  setRange(range: number): void {
    const { values, increment } = barTicks(range);
    this.element.hidden = !(range > 0);
    this.ticks.replaceChildren(
      ...values.map((value) => {
        const tick = h("span", {}, formatTick(value, increment));
        tick.style.bottom = `${range > 0 ? (100 * value) / range : 0}%`;
        return tick;
      }),
    );
    this.element.setAttribute("aria-label", `Colour scale of intensity from 0 to ${formatTick(range, range / 1000)}`);
  }
}
