// units.ts — chooses the SI prefix in which a set of numbers reads best.
import { formatInteger, formatSignificant } from "./number.ts";

export interface DisplayUnit {
  unit: string; // with prefix
  factor: number; // display = SI value × factor
}

const PREFIXES: readonly [number, string][] = [
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
  [1e-12, "p"],
  [1e-15, "f"],
  [1e-18, "a"],
];

/**
 * Prefixed unit in which `largest` is at least 1; the plain unit already from a tenth of it, as people say
 * 0.5 N, not 500 mN. Metres are the exception: tissue is measured in millimetres up to half a metre.
 */
export function displayUnit(unit: string, largest: number): DisplayUnit {
  if (unit === "-" || unit === "") return { unit: "-", factor: 1 };
  if (!Number.isFinite(largest) || largest <= 0) return { unit, factor: 1 };
  for (const [size, prefix] of PREFIXES) {
    if (unit !== "Pa" && unit !== "Hz" && unit !== "W" && size > 1) continue;
    const limit = size === 1 ? (unit === "m" ? 0.5 : 0.1) : 0.9995;
    if (largest >= size * limit) return { unit: prefix + unit, factor: 1 / size };
  }
  return { unit: "a" + unit, factor: 1e18 };
}

/** Largest finite magnitude in any of the lists, 0 where there is none. */
export function largestMagnitude(...lists: (readonly number[] | Float32Array)[]): number {
  let largest = 0;
  for (const values of lists) {
    for (const value of values) {
      const size = Math.abs(value);
      if (size > largest && size < Infinity) largest = size;
    }
  }
  return largest;
}

/** One number with its own prefix, e.g. "1.234 ms". */
export function formatQuantity(value: number, unit: string, digits = 4): string {
  if (!Number.isFinite(value)) return "–";
  if (unit === "") return Number.isInteger(value) ? formatInteger(value) : formatSignificant(value, digits);
  const { unit: shown, factor } = displayUnit(unit, Math.abs(value));
  return `${formatSignificant(value * factor, digits)}\u00a0${shown}`;
}

/** The unit in the brackets of a label such as "depth [mm]", or "". */
export function unitOfLabel(label: string): string {
  const unit = /\[([^\]]*)\]\s*$/.exec(label)?.[1] ?? "";
  return unit === "-" || unit === "–" ? "" : unit;
}

/** A label as axes show it: words start with a capital (symbols such as "s" stay), a missing unit is a dash. */
export function axisLabel(label: string): string {
  const shown = label.replace("[-]", "[–]");
  return /^[a-z]{3}/.test(shown) ? shown.charAt(0).toUpperCase() + shown.slice(1) : shown;
}

/** A label without the unit at its end. */
export function nameOfLabel(label: string): string {
  return label.replace(/\s*\[[^\]]*\]\s*$/, "");
}
