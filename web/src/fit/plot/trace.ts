// trace.ts — numbers into SVG path data on a canvas of SIZE × SIZE that is stretched over the plot.
import { type Scale, place } from "./scale.ts";

export const SIZE = 1000;
/** Points closer to the last one than this along both axes would not be told apart and are left out. */
const LEAST_STEP = 1.2;

const text = (value: number) => String(Math.round(value * 10) / 10);
const across = (scale: Scale, value: number) => SIZE * place(scale, value);
const down = (scale: Scale, value: number) => SIZE * (1 - place(scale, value));
/** Far outside the canvas paths are cut off, since browsers draw huge coordinates wrongly. */
const near = (value: number) => Math.min(20 * SIZE, Math.max(-20 * SIZE, value));

/** A polyline; gaps where a number is not finite. */
export function linePath(x: ArrayLike<number>, y: ArrayLike<number>, xScale: Scale, yScale: Scale): string {
  const parts: string[] = [];
  let lastX = NaN;
  let lastY = NaN;
  const count = Math.min(x.length, y.length);
  for (let at = 0; at < count; at++) {
    const px = near(across(xScale, x[at]!));
    const py = near(down(yScale, y[at]!));
    if (px !== px || py !== py) {
      lastX = NaN;
      continue;
    }
    const close = Math.abs(px - lastX) < LEAST_STEP && Math.abs(py - lastY) < LEAST_STEP;
    if (close && at < count - 1) continue;
    parts.push(`${lastX === lastX ? "L" : "M"}${text(px)} ${text(py)}`);
    lastX = px;
    lastY = py;
  }
  return parts.join("");
}

/** A dot at every point: lines of no length, which a round cap makes round however the canvas is stretched. */
export function dotPath(x: ArrayLike<number>, y: ArrayLike<number>, xScale: Scale, yScale: Scale): string {
  const parts: string[] = [];
  for (let at = 0; at < Math.min(x.length, y.length); at++) {
    const px = across(xScale, x[at]!);
    const py = down(yScale, y[at]!);
    if (px === px && py === py && Math.abs(px) < 2 * SIZE && Math.abs(py) < 2 * SIZE) {
      parts.push(`M${text(px)} ${text(py)}h0`);
    }
  }
  return parts.join("");
}

/** A rectangle between two numbers of each axis; null: to the end of the axis. */
export function bandPath(
  x: readonly [number | null, number | null],
  y: readonly [number | null, number | null],
  xScale: Scale,
  yScale: Scale,
): string {
  const inside = (value: number) => Math.min(SIZE, Math.max(0, value));
  const left = x[0] === null ? 0 : inside(across(xScale, x[0]));
  const right = x[1] === null ? SIZE : inside(across(xScale, x[1]));
  const bottom = y[0] === null ? SIZE : inside(down(yScale, y[0]));
  const top = y[1] === null ? 0 : inside(down(yScale, y[1]));
  return `M${text(left)} ${text(bottom)}H${text(right)}V${text(top)}H${text(left)}Z`;
}
