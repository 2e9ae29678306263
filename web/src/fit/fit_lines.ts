// fit_lines.ts — a fit in five plain lines: what was fitted, what came out, how well, how surely, and what to do next.
import { formatSignificant } from "../format/number.ts";
import type { FitData, FitParameter } from "../report_data.ts";
import { forceText } from "./force_unit.ts";
import { bestInterval, digitsFor, intervalText } from "./intervals.ts";
import { parameterUnit, plainName, shortNames } from "./names.ts";
import { closestPairs, correlationOf, STRONG } from "./pairs.ts";

export interface FitLine {
  name: string;
  words: string;
}

const MOST_VALUES = 4; // parameters that a line has room for
const count = (number: number, noun: string) => `${number} ${noun}${number === 1 ? "" : "s"}`;

/** "a", "a and b", "a, b and c". */
export function listed(words: readonly string[]): string {
  return words.length < 2 ? (words[0] ?? "") : `${words.slice(0, -1).join(", ")} and ${words[words.length - 1]!}`;
}

export function fitLines(fit: FitData): FitLine[] {
  const names = shortNames(fit.parameters).map(plainName);
  return [
    { name: "Fitted", words: fittedWords(fit) },
    { name: "Result", words: resultWords(fit, names) },
    { name: "Error", words: errorWords(fit) },
    { name: "Certainty", words: certaintyWords(fit, names) },
    { name: "Next", words: nextWords(fit, names) },
  ];
}

function fittedWords(fit: FitData): string {
  const heldOut = fit.curves.filter((curve) => curve.held_out).length;
  const law = fit.law ? ` of the law ${fit.law}` : "";
  const fitted = `${count(fit.parameters.length, "parameter")}${law} to ${count(fit.curves.length - heldOut, "curve")}`;
  return heldOut > 0 ? `${fitted}; ${count(heldOut, "curve")} held out to test it.` : `${fitted}; none held out.`;
}

function resultWords(fit: FitData, names: readonly string[]): string {
  if (fit.parameters.length === 0) return "no parameter.";
  const shown = fit.parameters.slice(0, MOST_VALUES).map((parameter, at) => valueWords(parameter, names[at]!));
  const more = fit.parameters.length - shown.length;
  return `${shown.join("; ")}${more > 0 ? `; ${more} more in the table below` : ""}.`;
}

/** "μ₁ = 1.19 kPa (1.13 – 1.25)". */
function valueWords(parameter: FitParameter, name: string): string {
  const { unit, factor } = parameterUnit(parameter);
  const interval = bestInterval(parameter);
  const digits = digitsFor(parameter.value, interval);
  const value = formatSignificant(parameter.value * factor, digits) + (unit ? `\u00a0${unit}` : "");
  return `${name} = ${value}${interval ? ` (95 %: ${intervalText(interval, factor, digits)})` : ""}`;
}

function errorWords(fit: FitData): string {
  const parts = [`${forceText(fit.rms_fit, fit.y)} rms on the fitted curves`];
  if (fit.rms_heldout !== null) parts.push(`${forceText(fit.rms_heldout, fit.y)} on those held out`);
  const spread = fit.spread_N === null ? "" : `; repetitions of a test differ by ${forceText(fit.spread_N, fit.y)}`;
  return `${parts.join(", ")}${spread}.`;
}

function certaintyWords(fit: FitData, names: readonly string[]): string {
  const having = (...verdicts: FitParameter["verdict"][]) =>
    names.filter((_, at) => verdicts.includes(fit.parameters[at]!.verdict));
  const [open, weak, bound] = [having("not identifiable"), having("weak"), having("at bound")];
  const parts: string[] = [];
  if (open.length > 0) parts.push(`the curves do not determine ${listed(open)}`);
  if (weak.length > 0) parts.push(`${listed(weak)} ${weak.length === 1 ? "is" : "are"} known only roughly`);
  if (bound.length > 0) parts.push(`${listed(bound)} ${bound.length === 1 ? "lies" : "lie"} at a bound: widen it`);
  if (parts.length === 0)
    parts.push(fit.parameters.length === 1 ? "the curves determine it" : "the curves determine all of them");
  const pair = closestPairs(correlationOf(fit), 1)[0];
  if (pair && Math.abs(pair.r) >= STRONG)
    parts.push(`${names[pair.a]!} and ${names[pair.b]!} can make up for each other (correlation ${signed(pair.r)})`);
  return `${capitalised(parts.join("; "))}.`;
}

/** Latin letters alone: μ would become another letter to the eye. */
const capitalised = (text: string): string => text.replace(/^[a-z]/, (letter) => letter.toUpperCase());

const signed = (value: number): string => value.toFixed(2).replace("-", "−");

function nextWords(fit: FitData, names: readonly string[]): string {
  const design = fit.designs[0];
  const name = design ? names[fit.parameters.findIndex((parameter) => parameter.name === design.parameter)] : undefined;
  const share = design ? design.width_after / design.width_now : NaN;
  if (design && name && share < 1)
    return `${capitalised(design.what)}: the interval of ${name} would shrink to ${Math.round(100 * share)} % of its width.`;
  if (!fit.complete) return "Let the fit run to its end: the same command goes on from here.";
  const best = fit.basins.find((basin) => basin.best) ?? fit.basins[0];
  if (best && best.found < 2 && fit.starts > 1) return "More starts: the best optimum was found once only.";
  return "Nothing that these tests could tell better is known; a test of another kind would check the law.";
}
