// colouring.ts — what the body can be coloured by: where its numbers come from, their unit, and a range that stands still.
import type { LiveFrame } from "./protocol.ts";

export type ColourName = "intensity" | "shape" | "pressure" | "displacement" | "none";

export interface Colouring {
  name: ColourName;
  label: string;
  symbol: string;
  field: number; // that the program is asked for; 0: none, the page has what it needs
  units: readonly { unit: string; perUnit: number; upTo: number }[]; // the first that the range lies within
  rest: number; // value of a body at rest: colours begin there
  least: number; // span that the range has at least: noise at rest stays one colour; displacement: of the body's size
}

const plain = [{ unit: "–", perUnit: 1, upTo: Infinity }];

export const COLOURINGS: readonly Colouring[] = [
  {
    name: "intensity",
    label: "Equivalent shear strain s",
    symbol: "Equivalent shear strain s",
    field: 1,
    units: plain,
    rest: 0,
    least: 0.02,
  },
  { name: "shape", label: "Shape measure q", symbol: "Shape q", field: 2, units: plain, rest: 1, least: 0.002 },
  {
    name: "pressure",
    label: "Pressure p",
    symbol: "Pressure p",
    field: 3,
    units: [
      { unit: "Pa", perUnit: 1, upTo: 2000 },
      { unit: "kPa", perUnit: 1e-3, upTo: Infinity },
    ],
    rest: 0,
    least: 2,
  },
  {
    name: "displacement",
    label: "Displacement |u|",
    symbol: "|u|",
    field: 0,
    units: [{ unit: "mm", perUnit: 1e3, upTo: Infinity }],
    rest: 0,
    least: 2e-3,
  },
];
/** No field: the body looks as tissue. */
export const AS_TISSUE: Colouring = {
  name: "none",
  label: "Tissue",
  symbol: "",
  field: 0,
  units: plain,
  rest: 0,
  least: 1,
};

export const colouringOf = (name: string): Colouring => COLOURINGS.find((each) => each.name === name) ?? AS_TISSUE;

/** Unit for a range: that of the largest number in it. */
export function unitOf(colouring: Colouring, low: number, high: number): { unit: string; perUnit: number } {
  const most = Math.max(Math.abs(low), Math.abs(high));
  return colouring.units.find(({ upTo }) => most <= upTo) ?? colouring.units[colouring.units.length - 1]!;
}

const GROWS = 1.15; // beyond what is there: in steps, so that colours do not creep
const SHRINKS = 0.35; // when less than this share of the range has been used …
const FOR = 4000; // … so long [ms]

/** From which number to which the colours go: grown at once, shrunk when too wide for a while. */
export class ColourRange {
  low = 0;
  high = 0;
  private since = 0;

  /** Around the value at rest. */
  reset(colouring: Colouring, least: number): void {
    this.low = colouring.rest === 1 ? 1 - least : 0;
    this.high = colouring.rest === 1 ? 1 : least;
    this.since = 0;
  }

  /** Takes in what is there now; true where the range has become another. @param least  span it keeps */
  follow(low: number, high: number, rest: number, least: number, now: number): boolean {
    const [was, is] = [this.high - this.low, high - low];
    if (low < this.low || high > this.high) {
      if (low < this.low) this.low = rest + GROWS * (low - rest);
      if (high > this.high) this.high = rest + GROWS * (high - rest);
      this.since = now;
      return true;
    }
    if (is > SHRINKS * was || was <= 1.0001 * least) {
      this.since = now;
      return false;
    }
    if (now - this.since < FOR) return false;
    this.low = rest + GROWS * (low - rest);
    this.high = rest + GROWS * (high - rest);
    const missing = least - (this.high - this.low);
    if (missing > 0 && rest === 1) this.low -= missing;
    if (missing > 0 && rest !== 1) this.high += missing;
    this.since = now;
    return true;
  }
}

/** The numbers of a frame at each vertex, and between which they lie; null: this frame does not have them. */
export function valuesOf(
  colouring: Colouring,
  frame: LiveFrame,
  out: Float32Array,
): { low: number; high: number } | null {
  if (colouring.name === "displacement") return lengths(frame, out);
  if (colouring.name === "none" || frame.field !== colouring.field) return null;
  const perStep = (frame.high - frame.low) / 255;
  for (let i = 0; i < out.length; i++) out[i] = frame.low + (frame.values[i] ?? 0) * perStep;
  return { low: frame.low, high: frame.high };
}

function lengths(frame: LiveFrame, out: Float32Array): { low: number; high: number } {
  const { displacement: u } = frame;
  const perStep = frame.reach / 32767;
  let high = 0;
  for (let i = 0; i < out.length; i++) {
    out[i] = perStep * Math.hypot(u[3 * i] ?? 0, u[3 * i + 1] ?? 0, u[3 * i + 2] ?? 0);
    high = Math.max(high, out[i]!);
  }
  return { low: 0, high };
}
