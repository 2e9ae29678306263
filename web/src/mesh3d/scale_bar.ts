// scale_bar.ts — a bar of a round length, as long as that is on the screen at the distance one looks at.
import { h } from "../page/dom.ts";
import { formatSignificant } from "../format/number.ts";

const WIDEST = 110; // CSS pixels

/** The longest round length that fits, in metres and pixels. @param perPixel  metres of a pixel */
export function roundLength(perPixel: number, widest = WIDEST): { metres: number; pixels: number } {
  if (!(perPixel > 0) || !Number.isFinite(perPixel)) return { metres: 0, pixels: 0 };
  const most = perPixel * widest;
  const power = 10 ** Math.floor(Math.log10(most));
  const metres = [5, 2, 1].map((step) => step * power).find((length) => length <= most * 1.000001) ?? power;
  return { metres, pixels: metres / perPixel };
}

/** A round length with its unit. */
export function lengthText(metres: number): string {
  if (metres >= 1) return `${formatSignificant(metres, 1)}\u00a0m`;
  return metres >= 1e-3
    ? `${formatSignificant(1e3 * metres, 1)}\u00a0mm`
    : `${formatSignificant(1e6 * metres, 1)}\u00a0µm`;
}

export class ScaleBar {
  readonly element = h("div", { class: "scale-bar", role: "img" });
  private readonly bar = h("i", { "aria-hidden": "true" });
  private readonly text = h("span", {});
  private shown = "";
  /** What it shows now [m] and how long that is [CSS px]. */
  shownLength = { metres: 0, pixels: 0 };

  constructor() {
    this.element.append(this.bar, this.text);
  }

  /** @param width  of the view [CSS px] */
  show(perPixel: number, width: number): void {
    const { metres, pixels } = (this.shownLength = roundLength(perPixel, Math.min(WIDEST, 0.24 * width)));
    this.element.hidden = metres === 0;
    const now = `${metres} ${pixels.toFixed(1)}`;
    if (now === this.shown) return;
    this.shown = now;
    this.bar.style.width = `${pixels.toFixed(1)}px`;
    this.text.textContent = lengthText(metres);
    this.element.setAttribute("aria-label", `Scale: the bar is ${this.text.textContent} long`);
  }
}
