// model.ts — what a chart shows, in display units, without saying how it is drawn.
import type { LineStyle } from "./line_style.ts";

export interface Line {
  id: string; // unique in its chart
  variant: string | null; // lines of a variant are shown and hidden in all charts of a scene together
  entry?: string; // lines of the same variant and entry share one entry of the legend
  label: string;
  style: LineStyle;
  x: Float64Array; // NaN: gap
  y: Float64Array;
  times: Float64Array | null; // [s], for the mark of the mesh's playback
  points?: boolean; // circles at the points, no line
}

export interface ChartModel {
  title: string;
  xLabel: string; // with unit
  yLabel: string;
  lines: Line[];
  events: EventMark[];
  note: string;
  extent?: Extent; // to show first; without, that of its lines
  logX?: boolean; // x of the lines are decades: exponents of ten
  logY?: boolean; // y likewise
}

/** A moment of a variant that is worth a mark: where it is on the variant's line, and what it was. */
export interface EventMark {
  variant: string;
  x: number; // display units
  y: number | null; // on the line; null: the chart has no one line that it belongs to
  label: string;
}

/** What is highlighted together, in all charts of a scene: a variant, or lines of one name. */
export const keyOf = (line: Line): string => line.variant ?? line.label;

export interface Extent {
  xMin: number;
  xMax: number;
  yMin: number;
  yMax: number;
}

/** Numbers times a factor, as the plain array of doubles that charts draw from. */
export function scaled(values: readonly number[], factor: number): Float64Array {
  return Float64Array.from(values, (value) => value * factor);
}

/** Range to show: all points of the lines, zero included where it is near, a little air above and below. */
export function extentOf(lines: readonly Line[]): Extent {
  const [xLow, xHigh] = rangeOf(lines.map((line) => line.x));
  const [yLow, yHigh] = rangeOf(lines.map((line) => line.y));
  const [xMin, xEnd] = towardsZero(xLow, xHigh, 0.15);
  const xMax = roundUp(xEnd, xEnd - xMin);
  const [yNear, yFar] = towardsZero(yLow, yHigh, 0.5);
  const air = 0.06 * (yFar - yNear);
  return { xMin, xMax, yMin: yNear === 0 ? 0 : yNear - air, yMax: yFar === 0 ? 0 : yFar + air };
}

function rangeOf(lists: readonly Float64Array[]): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const values of lists) {
    for (const value of values) {
      if (value < low) low = value;
      if (value > high && value < Infinity) high = value;
    }
  }
  if (!(low <= high)) return [0, 1];
  if (low < high) return [low, high];
  const half = low === 0 ? 1 : 0.1 * Math.abs(low);
  return low === 0 ? [0, 1] : [low - half, high + half];
}

/** Ends a range at a round number where the next one is not farther than 4 % of its length. */
function roundUp(end: number, length: number): number {
  const power = 10 ** Math.floor(Math.log10(length));
  for (const step of [power, power / 2, power / 5, power / 10]) {
    const round = Math.ceil(end / step - 1e-9) * step;
    if (round - end <= 0.04 * length) return Number(round.toPrecision(12));
  }
  return end;
}

/** Extends a range to zero where zero lies within `share` of its length. */
function towardsZero(low: number, high: number, share: number): [number, number] {
  const reach = share * (high - low);
  if (low > 0 && low <= reach) return [0, high];
  if (high < 0 && -high <= reach) return [low, 0];
  return [low, high];
}
