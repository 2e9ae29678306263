// fit_head.ts — a fit in five plain lines; and, for below, its conclusions, what was done and what it cost.
import { formatInteger, formatSignificant } from "../format/number.ts";
import { formatQuantity } from "../format/units.ts";
import { h } from "../page/dom.ts";
import { icon } from "../page/icons.ts";
import type { FitData } from "../report_data.ts";
import { fitLines } from "./fit_lines.ts";
import { forceText } from "./force_unit.ts";
import { plainName, shortNames, withSubscripts } from "./names.ts";

/** @param titled  whether the page's own title already is the fit's */
export function fitHead(fit: FitData, id: string, titled: boolean): HTMLElement {
  return h(
    "header",
    { class: "fit-head" },
    h("h2", { id: `${id}-title`, class: titled ? "visually-hidden" : null }, fit.title),
    fit.complete ? null : interrupted(fit),
    h(
      "dl",
      { class: "fit-lines", "aria-label": "In short" },
      ...fitLines(fit).map(({ name, words }) => h("div", {}, h("dt", {}, name), h("dd", {}, ...withSubscripts(words)))),
    ),
  );
}

/** All that was concluded, what was done, and what it cost. */
export function fitConclusions(fit: FitData): HTMLElement {
  const paragraphs = fit.description.split(/\n\s*\n/).filter((text) => text.trim() !== "");
  return h(
    "section",
    { class: "fit-conclusions", "aria-label": "Conclusions" },
    h(
      "div",
      { class: "fit-words" },
      conclusions(fit),
      h(
        "div",
        { class: "fit-what" },
        ...paragraphs.map((text) => h("p", {}, text)),
        fit.law ? h("p", {}, `Law: ${fit.law}. ${fittedText(fit)}`) : h("p", {}, fittedText(fit)),
        forwardText(fit) ? h("p", {}, forwardText(fit)) : null,
      ),
    ),
    keyFigures(fit),
  );
}

function interrupted(fit: FitData): HTMLElement {
  const left = fit.starts_planned - fit.starts;
  const words =
    left > 0
      ? `${fit.starts} of ${fit.starts_planned} starts were run; the results are the best so far.`
      : "The results are the best so far; parts of the uncertainty analysis are missing.";
  return h(
    "p",
    { class: "banner", role: "note" },
    icon("weak"),
    h("span", {}, h("strong", {}, "Interrupted. "), words),
  );
}

function conclusions(fit: FitData): HTMLElement | null {
  if (fit.conclusions.length === 0) return null;
  const items = readable(fit.conclusions, fit).map((text) => h("li", {}, ...withSubscripts(text)));
  return h("ul", { class: "conclusions", "aria-label": "Conclusions" }, ...items);
}

/** Sentences with parameters as people write them, in place of their keys in a scene. */
export function readable(sentences: readonly string[], fit: FitData): string[] {
  const names = shortNames(fit.parameters).map(plainName);
  const keys = fit.parameters.map(({ name }, at) => ({ name, short: names[at]! }));
  keys.sort((a, b) => b.name.length - a.name.length); // a key may begin as another one does
  return sentences.map((text) => keys.reduce((words, { name, short }) => words.replaceAll(name, short), text));
}

const count = (number: number, noun: string) => `${number} ${noun}${number === 1 ? "" : "s"}`;

/** "3 parameters fitted to 3 curves, 2 curves held out." */
export function fittedText(fit: FitData): string {
  const heldOut = fit.curves.filter((curve) => curve.held_out).length;
  const fitted = `${count(fit.parameters.length, "parameter")} fitted to ${count(fit.curves.length - heldOut, "curve")}`;
  return `${fitted}, ${heldOut === 0 ? "none" : count(heldOut, "curve")} held out.`;
}

function forwardText(fit: FitData): string {
  const error =
    fit.forward_error_N === null
      ? ""
      : `Its largest difference from the finest one is ${forceText(fit.forward_error_N, fit.y)}.`;
  return `${fit.forward} ${error}`.trim();
}

interface KeyFigure {
  name: string;
  value: string;
  note?: string;
}

export function keyFigureTexts(fit: FitData): KeyFigure[] {
  const best = fit.basins.find((basin) => basin.best) ?? fit.basins[0];
  const figures: (KeyFigure | null)[] = [
    { name: "Error of fitted curves, rms", value: forceText(fit.rms_fit, fit.y) },
    {
      name: "Error of held-out curves, rms",
      value: fit.rms_heldout === null ? "none held out" : forceText(fit.rms_heldout, fit.y),
    },
    fit.spread_N === null
      ? { name: "Spread of repetitions", value: "none repeated" }
      : { name: "Spread of repetitions", value: forceText(fit.spread_N, fit.y) },
    best
      ? {
          name: "Best optimum found by",
          value: `${best.found} of ${count(fit.starts, "start")}`,
          note: optimaNote(fit),
        }
      : null,
    { name: "Forward runs", value: formatInteger(fit.forward_runs) },
    { name: "Wall time", value: wallText(fit.wall_s), note: costNote(fit) },
  ];
  return figures.filter((figure): figure is KeyFigure => figure !== null);
}

function optimaNote(fit: FitData): string {
  if (fit.basins.length === 1) return "no other optimum";
  return `${fit.basins.length - 1} other ${fit.basins.length === 2 ? "optimum" : "optima"}`;
}

function costNote(fit: FitData): string {
  const each = fit.wall_s / fit.forward_runs;
  return Number.isFinite(each) && fit.forward_runs > 0 ? `${formatQuantity(each, "s", 3)} a run` : "";
}

/** "41.3 s", "3 min 20 s", "2 h 5 min". */
export function wallText(seconds: number): string {
  if (!(seconds >= 120)) return Number.isFinite(seconds) ? `${formatSignificant(seconds, 3)}\u00a0s` : "–";
  const whole = Math.round(seconds);
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor((whole % 3600) / 60)];
  return hours > 0 ? `${hours}\u00a0h ${minutes}\u00a0min` : `${minutes}\u00a0min ${whole % 60}\u00a0s`;
}

function keyFigures(fit: FitData): HTMLElement {
  return h(
    "dl",
    { class: "key-figures" },
    ...keyFigureTexts(fit).map(({ name, value, note }) =>
      h("div", {}, h("dt", {}, name), h("dd", {}, value, note ? h("small", {}, note) : null)),
    ),
  );
}
