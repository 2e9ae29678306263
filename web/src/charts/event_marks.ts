// event_marks.ts — vertical marks with labels where something happened: contact, puncture, drop, withdrawal.
import { interpolate } from "../mesh3d/interpolate.ts";
import { column } from "../data/columns.ts";
import type { VariantData } from "../report_data.ts";
import type { PlotBox } from "./draw_lines.ts";
import type { EventMark, Extent } from "./model.ts";

/** More than this many in one chart would be a hatching: none is shown. */
const MOST = 24;
const ROWS = 4;
const FONT_SIZE = 12; // CSS pixels
const GAP = 6;

/** Where the events of a variant lie along a column of its forces, in display units. */
export function eventMarks(variant: VariantData, name: string, scale: number): EventMark[] {
  const times = column(variant.forces, "time_s");
  const values = column(variant.forces, name);
  const place = (time: number): number => {
    if (name === "time_s") return time;
    return times && values ? interpolate(times, values, time) : NaN;
  };
  const marks = variant.events
    .map((event) => ({ variant: variant.name, x: scale * place(event.time_s), label: event.event }))
    .filter((mark) => Number.isFinite(mark.x));
  return marks.length > MOST ? [] : marks;
}

/** A label with its place: left end in pixels, and row from the top; row −1: no room, the mark stands alone. */
export interface PlacedLabel {
  mark: EventMark;
  at: number; // of the mark [px]
  left: number;
  row: number;
}

/** Gives each label the first row in which it meets no other; labels stay inside `width`. */
export function placeLabels(
  marks: readonly EventMark[],
  toPixels: (x: number) => number,
  widthOf: (label: string) => number,
  width: number,
  gap: number,
): PlacedLabel[] {
  const taken: [number, number][][] = Array.from({ length: ROWS }, () => []);
  return marks
    .map((mark) => ({ mark, at: toPixels(mark.x) }))
    .filter(({ at }) => at >= 0 && at <= width)
    .sort((a, b) => a.at - b.at)
    .map(({ mark, at }) => {
      const length = widthOf(mark.label);
      const left = at + gap + length <= width ? at + gap : Math.max(0, at - gap - length);
      const free = (spans: [number, number][]) =>
        spans.every(([from, to]) => left > to + gap || left + length < from - gap);
      const row = taken.findIndex(free);
      if (row >= 0) taken[row]!.push([left, left + length]);
      return { mark, at, left, row };
    });
}

/** Draws the marks of one variant over the box that shows `view`. */
export function drawEvents(
  context: CanvasRenderingContext2D,
  marks: readonly EventMark[],
  ink: string,
  view: Extent,
  box: PlotBox,
  ratio: number,
): void {
  if (marks.length === 0) return;
  const perX = box.width / (view.xMax - view.xMin);
  context.save();
  context.font = `${FONT_SIZE * ratio}px "Source Sans 3 Variable", system-ui, sans-serif`;
  context.textBaseline = "top";
  context.textAlign = "left";
  context.strokeStyle = context.fillStyle = ink;
  const placed = placeLabels(
    marks,
    (x) => (x - view.xMin) * perX,
    (label) => context.measureText(label).width,
    box.width,
    GAP * ratio,
  );
  for (const { mark, at, left, row } of placed) {
    const top = box.top + (row < 0 ? 0 : row * (FONT_SIZE + 3) * ratio);
    context.globalAlpha = 0.55;
    context.lineWidth = ratio;
    context.setLineDash([3 * ratio, 3 * ratio]);
    context.beginPath();
    context.moveTo(box.left + at, top);
    context.lineTo(box.left + at, box.top + box.height);
    context.stroke();
    context.globalAlpha = 0.9;
    if (row >= 0) context.fillText(mark.label, box.left + left, top);
  }
  context.restore();
}
