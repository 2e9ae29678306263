// nearest.ts — the point of a line that the cursor means.

/** True where x never falls (gaps aside), so that one x has one y. */
export function isRising(x: Float64Array): boolean {
  let last = -Infinity;
  for (const value of x) {
    if (value < last) return false;
    if (value === value) last = value;
  }
  return true;
}

/** Index of the point nearest in x of a rising line, −1 where x lies outside it by more than `reach`. */
export function nearestInX(x: Float64Array, at: number, reach: number): number {
  let low = 0;
  let high = x.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle]! <= at) low = middle;
    else high = middle;
  }
  if (high < 0) return -1;
  const best = Math.abs(x[low]! - at) <= Math.abs(x[high]! - at) ? low : high;
  return Math.abs(x[best]! - at) <= reach ? best : -1;
}

/**
 * Index of the point nearest on the screen; x counts more than y, so that the point keeps to the cursor's
 * column where a line turns back on itself.
 * @param perX  pixels per unit of x (per unit of y: perY)
 */
export function nearestOnScreen(
  x: Float64Array,
  y: Float64Array,
  atX: number,
  atY: number,
  perX: number,
  perY: number,
): number {
  let best = -1;
  let bestDistance = Infinity;
  for (let i = 0; i < x.length; i++) {
    const distance = ((x[i]! - atX) * perX) ** 2 + 0.1 * ((y[i]! - atY) * perY) ** 2;
    if (distance < bestDistance) {
      bestDistance = distance;
      best = i;
    }
  }
  return best;
}
