// event_marks.ts — marks where something happened: contact, puncture, drop, withdrawal. In a chart of an instrument's force a mark is
// a ring on the line of the variant that it happened to, hung from its label; where no one line is meant, a rule over the height.
import { interpolate } from "../mesh3d/interpolate.ts";
import { column } from "../data/columns.ts";
import type { Columns, VariantData } from "../report_data.ts";
import type { PlotBox } from "./draw_lines.ts";
import type { EventMark, Extent } from "./model.ts";
import type { Pen } from "./pen.ts";

/** More than this many in one chart would be a hatching: none is shown. */
const MOST = 24;
const ROWS = 4;
const FONT_SIZE = 12; // CSS pixels
const GAP = 6;
const RADIUS = 3.5; // CSS pixels

/** What of a variant's events a chart shows. */
export interface MarkPlace {
  table: Columns; // with the columns of the chart
  x: { column: string; scale: number };
  y: { column: string; scale: number } | null; // null: many lines, none of them meant
  instrument: string | null; // whose events alone belong here; null: those of all
}

/** Where the events of a variant lie in a chart, in display units. */
export function eventMarks(variant: VariantData, { table, x, y, instrument }: MarkPlace): EventMark[] {
  const times = column(variant.forces, "time_s");
  const at = (axis: { column: string; scale: number }, time: number): number => {
    if (axis.column === "time_s") return axis.scale * time;
    const values = column(table, axis.column) ?? column(variant.probes, axis.column);
    return times && values ? axis.scale * interpolate(times, values, time) : NaN;
  };
  const marks = variant.events
    .filter((event) => instrument === null || event.instrument === "" || event.instrument === instrument)
    .map((event) => ({
      variant: variant.name,
      x: at(x, event.time_s),
      y: y ? at(y, event.time_s) : null,
      label: event.event,
    }))
    .filter((mark) => Number.isFinite(mark.x) && (mark.y === null || Number.isFinite(mark.y)));
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

/** Rings on the lines of variants, without words. */
export function drawRings(
  pen: Pen,
  marks: readonly EventMark[],
  strokeOf: (variant: string) => string,
  paper: string,
  view: Extent,
  box: PlotBox,
  ratio: number,
  alpha = 1,
): void {
  pen.save();
  pen.globalAlpha = alpha;
  pen.lineWidth = 1.5 * ratio;
  for (const mark of marks) {
    if (mark.y === null || !holds(view, mark.x, mark.y)) continue;
    pen.strokeStyle = strokeOf(mark.variant);
    pen.fillStyle = paper;
    pen.beginPath();
    pen.arc(...toPixels(mark.x, mark.y, view, box), RADIUS * ratio, 0, 2 * Math.PI);
    pen.fill();
    pen.stroke();
  }
  pen.restore();
}

/** Names the marks of one variant over the box that shows `view`. */
export function drawEvents(
  context: Pen,
  marks: readonly EventMark[],
  ink: string,
  view: Extent,
  box: PlotBox,
  ratio: number,
  family: string,
): void {
  if (marks.length === 0) return;
  const perX = box.width / (view.xMax - view.xMin);
  context.save();
  context.font = `${FONT_SIZE * ratio}px ${family}`;
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
    const end = mark.y === null ? box.top + box.height : toPixels(mark.x, mark.y, view, box)[1] - RADIUS * ratio;
    context.globalAlpha = 0.55;
    context.lineWidth = ratio;
    context.setLineDash([3 * ratio, 3 * ratio]);
    context.beginPath();
    context.moveTo(box.left + at, top);
    context.lineTo(box.left + at, Math.min(box.top + box.height, end));
    if (end > top) context.stroke();
    context.globalAlpha = 0.9;
    if (row >= 0) context.fillText(mark.label, box.left + left, top);
  }
  context.restore();
}

const holds = (view: Extent, x: number, y: number): boolean =>
  x >= view.xMin && x <= view.xMax && y >= view.yMin && y <= view.yMax;

const toPixels = (x: number, y: number, view: Extent, box: PlotBox): [number, number] => [
  box.left + ((x - view.xMin) / (view.xMax - view.xMin)) * box.width,
  box.top + box.height * (1 - (y - view.yMin) / (view.yMax - view.yMin)),
];
