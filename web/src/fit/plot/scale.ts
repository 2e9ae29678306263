// scale.ts — where numbers lie along an axis, linear or logarithmic, and at which numbers it has ticks.

export interface Scale {
  low: number;
  high: number;
  log: boolean;
}

export interface Tick {
  value: number;
  text: string;
}

/** A scale over `low` … `high`; logarithmic only where both are positive, and never of no length. */
export function makeScale(low: number, high: number, log = false): Scale {
  if (!(low < high)) {
    const half = Number.isFinite(low) && low !== 0 ? 0.1 * Math.abs(low) : 1;
    const centre = Number.isFinite(low) ? low : 0;
    return { low: centre - half, high: centre + half, log: log && centre > 0 };
  }
  return { low, high, log: log && low > 0 };
}

/** Share of the way from low to high, 0 … 1 inside the scale. */
export function place(scale: Scale, value: number): number {
  if (!scale.log) return (value - scale.low) / (scale.high - scale.low);
  return Math.log(value / scale.low) / Math.log(scale.high / scale.low);
}

/** The number at a share of the way: the inverse of `place`. */
export function valueAt(scale: Scale, share: number): number {
  if (!scale.log) return scale.low + share * (scale.high - scale.low);
  return scale.low * (scale.high / scale.low) ** share;
}

/** Smallest scale that holds all finite numbers, with a share of air at both ends. */
export function scaleOf(values: Iterable<number>, air = 0.06, log = false): Scale {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (!Number.isFinite(value) || (log && value <= 0)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (low > high) return makeScale(0, 1);
  const bare = makeScale(low, high, log);
  return makeScale(valueAt(bare, -air), valueAt(bare, 1 + air), log);
}

/** Round numbers inside the scale, about `count` of them, at steps of 1, 2 or 5 × 10ⁿ, or at decades. */
export function tickValues(scale: Scale, count: number): number[] {
  const decades = scale.log ? Math.log10(scale.high / scale.low) : 0;
  if (decades < 1) return linearTicks(scale, count);
  const factors = decades > count ? [1] : decades > count / 2.5 ? [1] : decades > count / 4 ? [1, 3] : [1, 2, 5];
  const every = Math.max(1, Math.ceil(decades / count));
  const ticks: number[] = [];
  for (let n = Math.floor(Math.log10(scale.low)); n <= Math.ceil(Math.log10(scale.high)); n++) {
    if (n % every !== 0) continue;
    for (const factor of factors) ticks.push(Number((factor * 10 ** n).toPrecision(3)));
  }
  return ticks.filter((value) => value >= scale.low * (1 - 1e-9) && value <= scale.high * (1 + 1e-9));
}

function linearTicks(scale: Scale, count: number): number[] {
  const step = roundStep((scale.high - scale.low) / count);
  const first = Math.ceil(scale.low / step - 1e-9);
  const last = Math.floor(scale.high / step + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, at) =>
    Number(((first + at) * step).toPrecision(12)),
  );
}

/** Least of 1, 2, 5 × 10ⁿ that is not smaller. */
export function roundStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  for (const factor of [1, 2, 5]) if (factor * power >= least * (1 - 1e-9)) return factor * power;
  return 10 * power;
}
