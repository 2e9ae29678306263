// colour_bar.ts — the scale beside the mesh: colours with numbers.
import { formatTick } from "../format/number.ts";
import { h } from "../page/dom.ts";
import { colourGradient } from "./colour_map.ts";

/** Round numbers from `low` to `high`, four to seven of them, these two not among them unless round. */
export function barTicks(high: number, low = 0): { values: number[]; increment: number } {
  if (!(high > low)) return { values: [low], increment: 1 };
  const rough = (high - low) / 4.5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const increment = [1, 2, 2.5, 5, 10].map((step) => step * power).find((step) => step >= rough * 0.999) ?? 10 * power;
  const values: number[] = [];
  const room = 0.0001 * (high - low);
  for (let i = Math.ceil((low - room) / increment); i * increment <= high + room; i++) values.push(i * increment || 0);
  return { values, increment };
}

export class ColourBar {
  readonly element: HTMLElement;
  private readonly ticks: HTMLElement;
  private readonly title = h("div", { class: "bar-title" }, "Equivalent shear strain s [–]");
  private name = "equivalent shear strain";

  constructor() {
    const bar = h("div", { class: "bar-colours" });
    bar.style.background = colourGradient("to top");
    this.ticks = h("div", { class: "bar-ticks" });
    this.element = h(
      "div",
      { class: "colour-bar", role: "img", "aria-label": "Colour scale of equivalent shear strain" },
      this.title,
      h("div", { class: "bar-body" }, bar, this.ticks),
    );
  }

  /** What the colours stand for, with its unit. */
  describe(name: string, title: string): void {
    this.name = name;
    this.title.textContent = title;
  }

  /** @param high  where the bar ends @param low  where it begins, at the bottom @param down  high is at the bottom */
  setRange(high: number, low = 0, down = false): void {
    const { values, increment } = barTicks(high, low);
    this.element.hidden = !(high > low);
    this.ticks.replaceChildren(
      ...values.map((value) => {
        const tick = h("span", {}, formatTick(value, increment));
        const place = high > low ? (100 * (value - low)) / (high - low) : 0;
        tick.style.bottom = `${down ? 100 - place : place}%`;
        return tick;
      }),
    );
    const ends = [low, high].map((end) => formatTick(end, (high - low) / 1000));
    this.element.setAttribute(
      "aria-label",
      `Colour scale of ${this.name} from ${low === 0 ? "0" : ends[0]} to ${ends[1]}`,
    );
  }
}
