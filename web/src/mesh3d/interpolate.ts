// interpolate.ts — a sampled quantity at a time between its samples.

/** Linear between the samples around `at`, the end values outside; NaN where there are none. */
export function interpolate(x: readonly number[], y: readonly number[], at: number): number {
  const count = Math.min(x.length, y.length);
  if (count === 0) return NaN;
  if (at <= x[0]!) return y[0]!;
  if (at >= x[count - 1]!) return y[count - 1]!;
  let low = 0;
  let high = count - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle]! <= at) low = middle;
    else high = middle;
  }
  const span = x[high]! - x[low]!;
  const share = span > 0 ? (at - x[low]!) / span : 0;
  return y[low]! * (1 - share) + y[high]! * share;
}
