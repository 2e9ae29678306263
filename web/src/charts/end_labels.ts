// end_labels.ts — names of lines where they end, in a column beside the plot: many lines are told apart without a legend.
//
//   ─────────╮·· linear_fem      A label stands at the height of its line's end, or the nearest free place; a thin
//   ────╮····╰·· corotational    leader goes from the end to it.
//       ╰······· xpbd
import type { PlotBox } from "./draw_lines.ts";
import { type Extent, type Line, keyOf } from "./model.ts";
import type { Pen } from "./pen.ts";

export const FEWEST = 4; // entries: fewer are told apart by the legend
const NARROWEST = 460; // CSS pixels of a chart that can spare a column
const MOST_SHARE = 0.3; // of a chart's width for the column
const FONT_SIZE = 12; // CSS pixels
const LINE_HEIGHT = 14.5;
const LEADER = 16; // least length
const NEAR_END = 0.6; // of the width: a line that turns back before is named where it reached farthest

export interface EndLabel {
  key: string; // of what it names (keyOf)
  text: string;
  stroke: string;
  atX: number; // end of the line [canvas px]
  atY: number;
  y: number; // of the label
}

/** Whether a chart of this width names its lines at their ends. */
export function namesEnds(lines: readonly Line[], width: number): boolean {
  return width >= NARROWEST && new Set(lines.map(({ label }) => label)).size >= FEWEST;
}

/** Room for the column [CSS px]. */
export function columnWidth(lines: readonly Line[], width: number, widthOf: (text: string) => number): number {
  const longest = Math.max(0, ...lines.map((line) => widthOf(line.label)));
  return Math.min(longest + LEADER + 6, MOST_SHARE * width);
}

export const endFont = (family: string, ratio: number): string => `${FONT_SIZE * ratio}px ${family}`;

/** Where a line is to be named: its last point within the view, or the one farthest to the right; null: it is not in view. */
export function endOf(line: Line, view: Extent): { x: number; y: number } | null {
  let last: { x: number; y: number } | null = null;
  let farthest: { x: number; y: number } | null = null;
  for (let i = 0; i < Math.min(line.x.length, line.y.length); i++) {
    const [x, y] = [line.x[i]!, line.y[i]!];
    if (!(x >= view.xMin && x <= view.xMax && y >= view.yMin && y <= view.yMax)) continue;
    last = { x, y };
    if (!farthest || x > farthest.x) farthest = last;
  }
  const early = last && last.x < view.xMin + NEAR_END * (view.xMax - view.xMin);
  return early ? farthest : last;
}

/** Heights at which labels stand `step` apart at least, as near as possible to where they want to be, between top and bottom. */
export function spread(wanted: readonly number[], step: number, top: number, bottom: number): number[] {
  const order = wanted.map((_, i) => i).sort((a, b) => wanted[a]! - wanted[b]!);
  const gap = Math.min(step, order.length > 1 ? (bottom - top) / (order.length - 1) : step);
  const blocks: { from: number; count: number; middle: number }[] = []; // neighbours that touch, around their mean
  for (let i = 0; i < order.length; i++) {
    blocks.push({ from: i, count: 1, middle: wanted[order[i]!]! });
    for (let joined = true; joined;) {
      joined = false;
      const block = blocks[blocks.length - 1]!;
      const half = 0.5 * (block.count - 1) * gap;
      block.middle = Math.min(bottom - half, Math.max(top + half, block.middle));
      const before = blocks[blocks.length - 2];
      if (!before || before.middle + 0.5 * (before.count - 1) * gap + gap <= block.middle - half + 1e-9) continue;
      const count = before.count + block.count;
      const mean = (before.count * before.middle + block.count * block.middle) / count;
      blocks.splice(-2, 2, { from: before.from, count, middle: mean });
      joined = true;
    }
  }
  const places: number[] = new Array<number>(order.length);
  for (const { from, count, middle } of blocks) {
    for (let k = 0; k < count; k++) places[order[from + k]!] = middle + (k - 0.5 * (count - 1)) * gap;
  }
  return places;
}

/** One label a name, beside `box`. @param ratio  canvas pixels per CSS pixel */
export function placeEnds(
  lines: readonly Line[],
  strokeOf: (line: Line) => string,
  view: Extent,
  box: PlotBox,
  ratio: number,
): EndLabel[] {
  const labels: EndLabel[] = [];
  const named = new Set<string>();
  for (const line of lines) {
    const end = named.has(line.label) ? null : endOf(line, view);
    if (!end) continue;
    named.add(line.label);
    const atX = box.left + ((end.x - view.xMin) / (view.xMax - view.xMin)) * box.width;
    const atY = box.top + box.height * (1 - (end.y - view.yMin) / (view.yMax - view.yMin));
    labels.push({ key: keyOf(line), text: line.label, stroke: strokeOf(line), atX, atY, y: atY });
  }
  const wanted = labels.map((label) => label.atY);
  const ys = spread(wanted, LINE_HEIGHT * ratio, box.top + 4 * ratio, box.top + box.height - 2 * ratio);
  labels.forEach((label, i) => (label.y = ys[i]!));
  return labels;
}

/** @param column  width beside the box [canvas px] @param highlight  key that stands out; null: all are alike */
export function drawEnds(
  pen: Pen,
  labels: readonly EndLabel[],
  box: PlotBox,
  column: number,
  ratio: number,
  highlight: string | null,
  family: string,
): void {
  const left = box.left + box.width + LEADER * ratio;
  pen.save();
  pen.textBaseline = "middle";
  pen.textAlign = "left";
  for (const label of labels) {
    const faint = highlight !== null && label.key !== highlight;
    pen.strokeStyle = pen.fillStyle = label.stroke;
    pen.globalAlpha = faint ? 0.15 : label.key === highlight ? 0.9 : 0.45;
    pen.lineWidth = 0.9 * ratio;
    pen.beginPath();
    pen.moveTo(label.atX, label.atY);
    pen.lineTo(box.left + box.width + 3 * ratio, label.atX < box.left + box.width ? label.atY : label.y);
    pen.lineTo(left - 3 * ratio, label.y);
    pen.stroke();
    pen.globalAlpha = faint ? 0.35 : 1;
    pen.font = (label.key === highlight ? "600 " : "") + endFont(family, ratio);
    pen.fillText(shortened(pen, label.text, column - LEADER * ratio), left, label.y);
  }
  pen.restore();
}

/** A text cut to a width, with … in its middle: names of variants differ at either end. */
function shortened(pen: Pen, text: string, width: number): string {
  if (pen.measureText(text).width <= width) return text;
  for (let kept = text.length - 1; kept > 1; kept--) {
    const head = Math.ceil(0.5 * kept);
    const cut = `${text.slice(0, head).trimEnd()}…${text.slice(text.length - (kept - head)).trimStart()}`;
    if (pen.measureText(cut).width <= width) return cut;
  }
  return "…";
}

/** The label at a place beside the box [canvas px]; null: there is none. */
export function endAt(labels: readonly EndLabel[], box: PlotBox, x: number, y: number, ratio: number): EndLabel | null {
  if (x < box.left + box.width) return null;
  const near = labels.map((label) => ({ label, far: Math.abs(label.y - y) })).sort((a, b) => a.far - b.far)[0];
  return near && near.far <= 0.6 * LINE_HEIGHT * ratio ? near.label : null;
}
