// number.ts — numbers for people: a true minus sign, powers as ×10ⁿ, no more digits than mean something.

const SUPERSCRIPTS: Record<string, string> = {
  "-": "⁻",
  "0": "⁰",
  "1": "¹",
  "2": "²",
  "3": "³",
  "4": "⁴",
  "5": "⁵",
  "6": "⁶",
  "7": "⁷",
  "8": "⁸",
  "9": "⁹",
};
const THIN_SPACE = "\u202f";

/** 10ⁿ written out. */
export function powerOfTen(exponent: number): string {
  return "10" + [...String(exponent)].map((digit) => SUPERSCRIPTS[digit] ?? digit).join("");
}

/** Thin spaces between groups of three where the whole part has five digits or more. */
function group(fixed: string): string {
  const [whole = "", fraction] = fixed.split(".");
  const grouped = whole.length < 5 ? whole : whole.replace(/\B(?=(\d{3})+$)/g, THIN_SPACE);
  return fraction === undefined ? grouped : `${grouped}.${fraction}`;
}

function withSign(value: number, magnitude: string): string {
  return value < 0 && /[1-9]/.test(magnitude) ? "−" + magnitude : magnitude;
}

/** A whole number, grouped. */
export function formatInteger(value: number): string {
  if (!Number.isFinite(value)) return "–";
  return withSign(value, group(Math.abs(Math.round(value)).toFixed(0)));
}

/** A number with `digits` significant digits; ×10ⁿ outside 1e-3 … 1e6. */
export function formatSignificant(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const magnitude = Math.abs(value);
  const exponent = Math.floor(Math.log10(Number(magnitude.toPrecision(digits))));
  if (exponent < -3 || exponent >= 6) {
    const mantissa = (magnitude / 10 ** exponent).toFixed(Math.max(0, digits - 1));
    return withSign(value, `${mantissa.replace(/\.?0+$/, "")}${THIN_SPACE}×${THIN_SPACE}${powerOfTen(exponent)}`);
  }
  return withSign(value, group(magnitude.toFixed(Math.max(0, digits - 1 - exponent))));
}

/** A label of an axis whose ticks are `increment` apart. */
export function formatTick(value: number, increment: number): string {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || increment < 1e-4) return formatSignificant(value, 3);
  return withSign(value, group(size.toFixed(Math.min(decimalsOf(increment, 3), 6))));
}

/**
 * Cells of a table's column: numbers with the same count of decimals, as many as the cell with most needs for
 * `digits` significant digits; texts as they are.
 */
export function formatColumn(cells: readonly (number | string)[], digits = 6): string[] {
  const numbers = cells.filter((cell): cell is number => typeof cell === "number" && Number.isFinite(cell));
  const extreme = numbers.some((value) => value !== 0 && (Math.abs(value) >= 1e7 || Math.abs(value) < 1e-4));
  const decimals = Math.max(0, ...numbers.map((value) => decimalsOf(value, digits)));
  return cells.map((cell) => {
    if (typeof cell === "string") return cell;
    if (!Number.isFinite(cell)) return "–";
    return extreme ? formatSignificant(cell, 4) : withSign(cell, group(Math.abs(cell).toFixed(decimals)));
  });
}

/** Decimals of a number rounded to so many significant digits, trailing zeros left out. */
function decimalsOf(value: number, digits: number): number {
  const [mantissa = "", exponent = "0"] = value.toExponential(digits - 1).split("e");
  const fraction = mantissa.includes(".") ? mantissa.split(".")[1]!.replace(/0+$/, "").length : 0;
  return Math.max(0, fraction - Number(exponent));
}
