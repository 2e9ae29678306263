// intervals.ts — 95 % intervals: their digits, their words, their place within the bounds.
import { formatSignificant } from "../format/number.ts";
import type { FitParameter } from "../report_data.ts";
import { makeScale, place } from "./plot/scale.ts";

export type Interval = readonly [number | null, number | null];

const MOST_DIGITS = 6;
const LEAST_DIGITS = 3;

/** Significant digits that a value of this uncertainty deserves: two of the half width of its interval. */
export function digitsFor(value: number, interval: Interval | null): number {
  const [low, high] = interval ?? [null, null];
  if (low === null || high === null || !(high > low) || value === 0) return 4;
  const ratio = (2 * Math.abs(value)) / (high - low);
  return Math.min(MOST_DIGITS, Math.max(LEAST_DIGITS, Math.floor(Math.log10(ratio)) + 3));
}

/** "1.21 – 1.26"; with an open end "above 1.21"; null: "–". */
export function intervalText(interval: Interval | null, factor: number, digits: number): string {
  if (interval === null) return "–";
  const [low, high] = interval;
  const text = (value: number) => formatSignificant(value * factor, digits);
  if (low === null && high === null) return "open";
  if (high === null) return `above ${text(low!)}`;
  if (low === null) return `below ${text(high)}`;
  return `${text(low)} – ${text(high)}`;
}

/** The interval to trust first: of the profile, else of the curvature, else of the bootstrap. */
export function bestInterval(parameter: FitParameter): Interval | null {
  return parameter.ci95_profile ?? parameter.ci95_curvature ?? parameter.ci95_bootstrap;
}

export interface BarPart {
  start: number; // shares of the way from the lower to the upper bound, within 0 … 1
  end: number;
  openLow: boolean;
  openHigh: boolean;
}

/** Where an interval lies between the bounds of its parameter; ends beyond a bound are cut there. */
export function barPart(parameter: FitParameter, interval: Interval): BarPart {
  const scale = makeScale(parameter.low, parameter.high, parameter.scale === "log");
  const share = (value: number | null, otherwise: number) => {
    if (value === null) return otherwise;
    const at = scale.log && value <= 0 ? 0 : place(scale, value);
    return Number.isFinite(at) ? Math.min(1, Math.max(0, at)) : otherwise;
  };
  return {
    start: share(interval[0], 0),
    end: share(interval[1], 1),
    openLow: interval[0] === null,
    openHigh: interval[1] === null,
  };
}

/** Place of the value between the bounds, 0 … 1. */
export function valueShare(parameter: FitParameter): number {
  return barPart(parameter, [parameter.value, parameter.value]).start;
}
