// drawing_speed.ts — how long drawing takes, which decides whether the fine look is worth it.
import type { Stage } from "./stage.ts";

/** One drawing may take this long [ms]: with more, 60 a second are out of reach. */
const AFFORDABLE = 20;
/** From one drawing to the next while something moves [ms]: beyond, it is seen to stutter. */
const LATE = 42;
const PATIENCE = 15; // late drawings, less those in time

let known: boolean | null = null; // of this page: its views share the graphics card

/** Whether the fine look can be drawn fast here: what has been found, else it is hoped. */
export const hopeForFine = (): boolean => known ?? true;

/** Draws twice and measures the second: the first also makes the shaders. A view that has no size tells nothing. */
export function fineIsFast(stage: Stage): boolean {
  if (known !== null) return known;
  const first = stage.timeDrawing();
  if (first === null) return true;
  known = first < AFFORDABLE || stage.timeDrawing()! < AFFORDABLE;
  return known;
}

/** Notices when drawings of something that moves come late again and again. */
export class Pace {
  private last = 0;
  private late = 0;

  /** To be told of each drawing; true once it has been too slow for too long. */
  tooSlow(now: number): boolean {
    const since = now - this.last;
    this.last = now;
    this.late = Math.max(0, this.late + (since > LATE && since < 1000 ? 1 : -1));
    if (this.late < PATIENCE) return false;
    this.late = 0;
    return true;
  }
}
