// legend.ts — the lines of a chart by name: a button each that shows or hides it, with its value at the cursor.
import { onTheme, currentTheme } from "../page/theme.ts";
import { h, svg } from "../page/dom.ts";
import { strokeOf } from "./line_style.ts";
import type { Line } from "./model.ts";

/** Id of the legend's entry of a line. */
export const entryOf = (line: Line) => line.entry ?? line.id;

/** Room for swatch and value beside a label, in letters. */
const VALUE_LETTERS = 9;

export class Legend {
  readonly element: HTMLElement;
  private readonly entries = new Map<string, { item: HTMLButtonElement; value: HTMLElement; line: Line }>();

  /**
   * @param onToggle  gets the line and whether only it is wanted (Shift held)
   * @param onPoint  gets the line that is pointed at or has the focus; null: none is
   */
  constructor(
    lines: readonly Line[],
    onToggle: (line: Line, only: boolean) => void,
    private readonly onPoint: (line: Line | null) => void = () => {},
  ) {
    this.element = h("div", { class: "legend", role: "group", "aria-label": "Lines of this chart" });
    const longest = Math.max(0, ...lines.map((line) => line.label.length));
    this.element.style.setProperty("--legend-column", `${longest + VALUE_LETTERS}ch`);
    for (const line of lines) if (!this.entries.has(entryOf(line))) this.element.append(this.entry(line, onToggle));
    this.colour(lines);
    onTheme(() => this.colour(lines));
  }

  private entry(line: Line, onToggle: (line: Line, only: boolean) => void): HTMLButtonElement {
    const value = h("span", { class: "legend-value" });
    const dashes = line.style.dash.join(" ");
    const swatch = svg(
      "svg",
      { class: "swatch", width: 30, height: 8, viewBox: "0 0 30 8", "aria-hidden": "true" },
      line.points
        ? svg("circle", { cx: 15, cy: 4, r: 3, fill: "none", "stroke-width": 1.5 })
        : svg("line", { x1: 0, y1: 4, x2: 30, y2: 4, "stroke-width": 2.25, "stroke-dasharray": dashes || null }),
    );
    const title = "Show or hide this line; with Shift, show only this line";
    const item = h(
      "button",
      { type: "button", class: "legend-item", "aria-pressed": "true", title },
      swatch,
      h("span", { class: "legend-label" }, line.label),
      value,
    );
    item.addEventListener("click", (event) => {
      this.onPoint(null); // what was chosen is to be seen, not what stands out
      onToggle(line, event.shiftKey);
    });
    for (const begin of ["mouseenter", "focus"]) item.addEventListener(begin, () => this.onPoint(line));
    for (const end of ["mouseleave", "blur"]) item.addEventListener(end, () => this.onPoint(null));
    this.entries.set(entryOf(line), { item, value, line });
    return item;
  }

  private colour(lines: readonly Line[]): void {
    for (const line of lines) {
      const stroke = strokeOf(line.style, currentTheme());
      this.entries.get(entryOf(line))?.item.querySelector("line, circle")?.setAttribute("stroke", stroke);
    }
  }

  setShown(id: string, shown: boolean): void {
    this.entries.get(id)?.item.setAttribute("aria-pressed", String(shown));
  }

  /** Entries that do not stand out are faint. */
  setHighlight(stands: (line: Line) => boolean): void {
    for (const { item, line } of this.entries.values()) item.classList.toggle("faint", !stands(line));
  }

  /** Values at the cursor; empty texts where there is none. */
  setValues(values: ReadonlyMap<string, string>): void {
    for (const [id, entry] of this.entries) entry.value.textContent = values.get(id) ?? "";
  }
}
