// placing.ts — leads a tool to before a point of the surface: out of the body, aside in front of it, and down to the point.
//
//        ①  out ↑   ②  aside →   ③  ↓ to a little before the point
//
// Each leg begins where the tool has reached the end of the one before it.
import type { ToolInfo, ToolState } from "./protocol.ts";

const NEAR = 5e-4; // m from the end of a leg at which the next begins
const CLEAR = 0.03; // of the body's size, before the surface
const QUICK = 0.15; // m/s outside the body

export interface Leg {
  depth: number; // [m]
  aside: [number, number]; // along the tool's own x and y [m]
  quick: boolean;
}

const along = (a: readonly number[], b: readonly number[]): number => a.reduce((sum, x, i) => sum + x * b[i]!, 0);

/** Where the tip was when the tool started [m]; null where a tool has no tip. */
export function startOf(info: ToolInfo, state: ToolState): number[] | null {
  const tip = state.points.slice(-3);
  if (tip.length !== 3) return null;
  return tip.map(
    (x, k) => x - state.depth * info.direction[k]! - state.aside[0]! * info.side[k]! - state.aside[1]! * info.third[k]!,
  );
}

/** The legs to a point. @param before  depth at which the tip is before all of the body [m] @param size  of the body [m] */
export function legsTo(
  point: readonly number[],
  info: ToolInfo,
  state: ToolState,
  before: number,
  size: number,
): Leg[] {
  const start = startOf(info, state);
  if (!start) return [];
  const way = point.map((x, k) => x - start[k]!);
  const aside: [number, number] = [along(way, info.side), along(way, info.third)];
  const bounded = (depth: number) => Math.min(info.most_m, Math.max(info.least_m, depth));
  const out = bounded(before - CLEAR * size);
  const here: [number, number] = [state.aside[0]!, state.aside[1]!];
  return [
    { depth: Math.min(out, state.depth), aside: here, quick: false },
    { depth: Math.min(out, state.depth), aside, quick: true },
    { depth: bounded(along(way, info.direction) - CLEAR * size), aside, quick: true },
  ];
}

/** Sends the legs one by one. */
export class Placing {
  private legs: Leg[] = [];

  /** @param go  leads the tool @param speed  sets its speed; null: that of before */
  constructor(
    private readonly go: (leg: Leg) => void,
    private readonly speed: (metresPerSecond: number | null) => void,
  ) {}

  get busy(): boolean {
    return this.legs.length > 0;
  }

  begin(legs: readonly Leg[]): void {
    this.stop();
    this.legs = [...legs];
    this.send();
  }

  stop(): void {
    if (this.busy) this.speed(null);
    this.legs = [];
  }

  /** To be told where the tool is. */
  follow(state: ToolState): void {
    const leg = this.legs[0];
    if (!leg) return;
    const far = Math.hypot(state.depth - leg.depth, state.aside[0]! - leg.aside[0], state.aside[1]! - leg.aside[1]);
    if (far > NEAR) return;
    this.legs.shift();
    if (this.busy) this.send();
    else this.speed(null);
  }

  private send(): void {
    const leg = this.legs[0];
    if (!leg) return;
    this.speed(leg.quick ? QUICK : null);
    this.go(leg);
  }
}
