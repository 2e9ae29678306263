// pairs.ts — correlation of parameters: from the fit, or from its replicates; and the pairs that move together.
import type { FitData } from "../report_data.ts";

export interface Pair {
  a: number; // index of a parameter, less than b
  b: number;
  r: number;
}

export type Matrix = readonly (readonly (number | null)[])[];

export const STRONG = 0.9;

/** The fit's own correlation; without, that of its replicates; empty without both. */
export function correlationOf(fit: FitData): Matrix {
  if (fit.correlation.length > 0) return fit.correlation;
  const rows = fit.bootstrap?.values ?? [];
  if (rows.length < 3) return [];
  const columns = fit.parameters.map((parameter, at) =>
    rows.map((row) => (parameter.scale === "log" ? Math.log(row[at]!) : row[at]!)),
  );
  return columns.map((a) => columns.map((b) => pearson(a, b)));
}

/** Pearson's correlation; null where one list does not vary. */
export function pearson(a: readonly number[], b: readonly number[]): number | null {
  const mean = (values: readonly number[]) => values.reduce((sum, value) => sum + value, 0) / values.length;
  const [meanA, meanB] = [mean(a), mean(b)];
  let [ab, aa, bb] = [0, 0, 0];
  for (let at = 0; at < a.length; at++) {
    const [da, db] = [a[at]! - meanA, b[at]! - meanB];
    ab += da * db;
    aa += da * da;
    bb += db * db;
  }
  const r = ab / Math.sqrt(aa * bb);
  return Number.isFinite(r) ? r : null;
}

/** Pairs in order of the size of their correlation, the first `most`. */
export function closestPairs(matrix: Matrix, most: number): Pair[] {
  const pairs = matrix.flatMap((row, a) => row.map((r, b) => ({ a, b, r })));
  return pairs
    .filter((pair): pair is Pair => pair.a < pair.b && pair.r !== null)
    .sort((p, q) => Math.abs(q.r) - Math.abs(p.r))
    .slice(0, most);
}

/** Names the pairs of which one can make up for the other; at most three of them. */
export function strongWords(matrix: Matrix, names: readonly string[]): string {
  const strong = closestPairs(matrix, Infinity).filter((pair) => Math.abs(pair.r) >= STRONG);
  if (strong.length === 0)
    return `No two parameters are correlated by ${STRONG} or more: each has its own effect on the curves.`;
  const named = strong.slice(0, 3).map(({ a, b }) => `${names[a]!} and ${names[b]!}`);
  const rest = strong.length > 3 ? `, and ${strong.length - 3} more` : "";
  const subject = `${named.join("; ")}${rest}`;
  return `Correlated by ${STRONG} or more: ${subject}. One can compensate the other, so the curves determine their combination better than each alone.`;
}
