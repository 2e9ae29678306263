// history.ts — forces of the body there is now, frame by frame; another body starts them anew. Force against depth is kept as a path
// of its own: a tool that stands still adds nothing to it, however long it does.
import type { Samples } from "./protocol.ts";

const MOST = 120_000; // two minutes of frames
const STILL = 1e-7; // m: a tool that moves less between two frames stands

/** Force against depth of one tool, without repetitions. */
export interface ForcePath {
  depth: number[];
  force: number[];
}

/** Where the tool stands, the force that comes last takes the place of those since it stopped. */
function extend({ depth, force }: ForcePath, toDepth: number, toForce: number): void {
  const last = depth.length - 1;
  const stands = (at: number) => Math.abs(depth[at]! - toDepth) < STILL;
  if (last >= 1 && stands(last) && stands(last - 1)) force[last] = toForce;
  else {
    depth.push(toDepth);
    force.push(toForce);
  }
  if (depth.length > 1.1 * MOST) [depth, force].forEach((column) => column.splice(0, column.length - MOST));
}

export class History {
  readonly time: number[] = [];
  readonly depth: number[][];
  readonly force: number[][];
  readonly paths: ForcePath[];
  epoch = -1;

  constructor(private readonly tools: number) {
    this.depth = Array.from({ length: tools }, () => []);
    this.force = Array.from({ length: tools }, () => []);
    this.paths = Array.from({ length: tools }, () => ({ depth: [], force: [] }));
  }

  add(samples: Samples): void {
    for (const row of samples.rows) {
      if (row.epoch < this.epoch) continue;
      if (row.epoch > this.epoch) this.clear(row.epoch);
      if (row.time <= (this.time[this.time.length - 1] ?? -1)) continue; // had before the line was cut
      this.time.push(row.time);
      for (let i = 0; i < this.tools; i++) {
        this.depth[i]!.push(row.depth[i] ?? 0);
        this.force[i]!.push(row.force[i] ?? 0);
        extend(this.paths[i]!, row.depth[i] ?? 0, row.force[i] ?? 0);
      }
    }
    if (this.time.length > 1.1 * MOST) this.columns().forEach((column) => column.splice(0, column.length - MOST));
  }

  /** Number of the sample nearest before a time [s], −1 where there is none. */
  indexAt(time: number): number {
    let [low, high] = [0, this.time.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.time[middle]! <= time) low = middle + 1;
      else high = middle;
    }
    return Math.min(this.time.length - 1, Math.max(0, low - 1));
  }

  clear(epoch: number): void {
    this.epoch = epoch;
    this.columns().forEach((column) => (column.length = 0));
    for (const { depth, force } of this.paths) depth.length = force.length = 0;
  }

  private columns(): number[][] {
    return [this.time, ...this.depth, ...this.force];
  }

  /** As a table: SI units in the names of its columns, as forces.csv has them. */
  csv(names: readonly string[]): string {
    const head = ["time_s", ...names.flatMap((name) => [`${name}_depth_m`, `${name}_force_N`])];
    const rows = this.time.map((time, i) =>
      [time, ...names.flatMap((_, k) => [this.depth[k]![i], this.force[k]![i]])].join(","),
    );
    return [head.join(","), ...rows].join("\n") + "\n";
  }
}
