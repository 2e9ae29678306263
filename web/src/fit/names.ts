// names.ts — keys of a scene as people write parameters: "tissue.hyperelastic.mu_Pa[0]" is μ with index 1.
import { displayUnit } from "../format/units.ts";
import type { DisplayUnit } from "../format/units.ts";
import { h } from "../page/dom.ts";
import type { FitParameter } from "../report_data.ts";

export interface ShortName {
  base: string;
  index: string; // "" without
}

const KNOWN: Record<string, string> = {
  alpha: "α",
  beta: "β",
  gamma: "γ",
  eta: "η",
  kappa: "κ",
  lambda: "λ",
  mu: "μ",
  nu: "ν",
  rho: "ρ",
  sigma: "σ",
  tau: "τ",
  poisson_ratio: "Poisson’s ratio",
  youngs_modulus: "Young’s modulus",
};
const UNIT_END = /_(?:k?Pa(?:_s)?|Pa_per_m|m?N(?:_per_m+)?|k?m|mm|m?s|J(?:_per_m2)?|kg(?:_m3)?|per_s|Hz|deg|rad)$/;

/** Last part of a key without its unit; an element of a list is counted from 1. */
export function shortName(key: string): ShortName {
  const last = key.split(".").pop() ?? key;
  const [, word = last, element] = /^(.*?)(?:\[(\d+)\])?$/.exec(last) ?? [];
  const bare = word.replace(UNIT_END, "");
  const base = KNOWN[bare] ?? bare.replaceAll("_", " ");
  return { base, index: element === undefined ? "" : String(Number(element) + 1) };
}

/** Short names of all parameters; whole keys where two would be called the same. */
export function shortNames(parameters: readonly { name: string }[]): ShortName[] {
  const short = parameters.map((parameter) => shortName(parameter.name));
  const same = (a: ShortName, b: ShortName) => a.base === b.base && a.index === b.index;
  return short.map((name, at) =>
    short.some((other, index) => index !== at && same(name, other)) ? twoParts(parameters[at]!.name) : name,
  );
}

function twoParts(key: string): ShortName {
  const parts = key.split(".");
  if (parts.length < 2) return { base: key, index: "" };
  const { base, index } = shortName(key);
  return { base: `${parts[parts.length - 2]!.replaceAll("_", " ")} ${base}`, index };
}

/** As one line of plain text. */
export function plainName(name: ShortName): string {
  const subscript = [...name.index].map((digit) => String.fromCharCode(0x2080 + Number(digit))).join("");
  return name.base + subscript;
}

/** Text with its subscripts as markup: the page's typeface has no subscript figures of its own. */
export function withSubscripts(text: string): (string | Node)[] {
  const plain = (digits: string) => [...digits].map((digit) => String(digit.charCodeAt(0) - 0x2080)).join("");
  return text.split(/([₀-₉]+)/).map((part) => (/^[₀-₉]/.test(part) ? h("sub", {}, plain(part)) : part));
}

/** As markup, with a true subscript. */
export function nameElement(name: ShortName): HTMLElement {
  return h("span", { class: "symbol" }, name.base, name.index ? h("sub", {}, name.index) : null);
}

const PREFIXED: ReadonlySet<string> = new Set(["Pa", "N", "m", "s", "J", "W", "Hz", "Pa·s", "N·s", "N/m", "m/s"]);

/** Unit in which a parameter's numbers read best; prefixes only where they mean what they seem to (not for m²). */
export function parameterUnit(parameter: Pick<FitParameter, "unit" | "value">): DisplayUnit {
  const { unit, value } = parameter;
  if (unit === "" || unit === "-" || unit === "–" || unit === "1") return { unit: "", factor: 1 };
  return PREFIXED.has(unit) ? displayUnit(unit, Math.abs(value)) : { unit, factor: 1 };
}

/** A label for an axis: name with unit. */
export function nameWithUnit(name: ShortName, unit: string): string {
  return unit ? `${plainName(name)} [${unit}]` : plainName(name);
}
