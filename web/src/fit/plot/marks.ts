// marks.ts — what a small chart shows: lines and dots, bands, rules.

/** Points with a name are read out at the cursor. */
export interface PointsMark {
  kind: "line" | "dots";
  className: string;
  x: ArrayLike<number>;
  y: ArrayLike<number>;
  name?: string;
}

export interface BandMark {
  kind: "band";
  className: string;
  x: readonly [number | null, number | null];
  y: readonly [number | null, number | null];
}

export interface RuleMark {
  kind: "rule";
  className: string;
  x?: number;
  y?: number;
  label?: string; // of a horizontal one, at its right end
}

export type PlotMark = PointsMark | BandMark | RuleMark;
