// colouring.ts — the numbers of a streamed frame that colour the body, and a range that stands still.
import type { Colouring } from "../mesh3d/fields.ts";
import type { LiveFrame } from "./protocol.ts";
import { FIELDS } from "./wire.ts";

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

/** Number of the field that the program is asked for; none where the page has what it needs. */
export const fieldOf = ({ name }: Colouring): number =>
  name in FIELDS ? FIELDS[name as keyof typeof FIELDS] : FIELDS.none;

/** The numbers of a frame at each vertex, and between which they lie; null: this frame does not have them. */
export function valuesOf(
  colouring: Colouring,
  frame: LiveFrame,
  out: Float32Array,
): { low: number; high: number } | null {
  if (colouring.name === "displacement") return lengths(frame, out);
  if (colouring.name === "none" || frame.field !== fieldOf(colouring)) return null;
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
