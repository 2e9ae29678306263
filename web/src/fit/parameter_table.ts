// parameter_table.ts — every parameter: value, its intervals, where they lie within the bounds, verdict.
//
//   name   value [unit]   95 % by profile, curvature, bootstrap, of a further specimen   low ──▬▬●▬▬───── high   ✓ Identified: why
import { formatSignificant } from "../format/number.ts";
import { h, svg } from "../page/dom.ts";
import type { FitData, FitParameter } from "../report_data.ts";
import { type Interval, barPart, bestInterval, digitsFor, intervalText, valueShare } from "./intervals.ts";
import { type ShortName, nameElement, parameterUnit, plainName, shortNames } from "./names.ts";
import { verdictSign, verdictTone } from "./verdicts.ts";

const KINDS = [
  { key: "ci95_profile", name: "profile" },
  { key: "ci95_curvature", name: "curvature" },
  { key: "ci95_bootstrap", name: "bootstrap" },
  { key: "further95", name: "further specimen" },
  { key: "further_batch95", name: "further batch" },
] as const;

export function parameterTable(fit: FitData): HTMLElement | null {
  if (fit.parameters.length === 0) return null;
  const names = shortNames(fit.parameters);
  const used = KINDS.filter(({ key }) => fit.parameters.some((parameter) => parameter[key] !== null));
  const head = ["Parameter", "Value", "95 % interval", "Within its bounds", "Verdict"];
  return h(
    "section",
    { class: "parameters", "aria-label": "Parameters" },
    h("header", { class: "block-head" }, h("h3", {}, "Parameters")),
    h(
      "table",
      { class: "parameter-table" },
      h("thead", {}, h("tr", {}, ...head.map((name) => h("th", { scope: "col" }, name)))),
      h("tbody", {}, ...fit.parameters.map((parameter, at) => row(parameter, names[at]!, used))),
    ),
  );
}

type Kinds = readonly (typeof KINDS)[number][];

function row(parameter: FitParameter, name: ShortName, kinds: Kinds): HTMLElement {
  const { unit, factor } = parameterUnit(parameter);
  const digits = digitsFor(parameter.value, bestInterval(parameter));
  const value = formatSignificant(parameter.value * factor, digits);
  return h(
    "tr",
    {},
    h("th", { scope: "row" }, nameElement(name), h("code", { class: "key" }, ...breakable(parameter.name))),
    h("td", { class: "value" }, h("strong", {}, value), unit ? h("span", { class: "unit" }, `\u00a0${unit}`) : null),
    h("td", { "data-label": "95 % interval" }, intervalList(parameter, kinds, factor, digits)),
    h(
      "td",
      { class: "bounds", "data-label": "Within its bounds" },
      boundsBar(parameter, plainName(name), kinds, unit, factor),
    ),
    h("td", { class: "verdict-cell" }, verdictSign(parameter.verdict), h("p", {}, parameter.words)),
  );
}

/** A key that may break after its dots and before its brackets. */
function breakable(key: string): (string | Node)[] {
  return key.split(/(?<=\.)|(?=\[)/).flatMap((part, at) => (at === 0 ? [part] : [h("wbr"), part]));
}

function intervalList(parameter: FitParameter, kinds: Kinds, factor: number, digits: number): HTMLElement {
  if (kinds.length === 0) return h("span", { class: "muted" }, "not known");
  return h(
    "dl",
    { class: "intervals" },
    ...kinds.map(({ key, name }) => {
      const text = intervalText(parameter[key], factor, digits);
      return h("div", {}, h("dt", {}, name), h("dd", {}, text === "open" ? "open on both sides" : text));
    }),
  );
}

/** Bars of all intervals, one below the other, with the value across them, between the bounds. */
function boundsBar(parameter: FitParameter, name: string, kinds: Kinds, unit: string, factor: number): HTMLElement {
  const given = kinds.map(({ key }) => parameter[key]);
  const text = (value: number) => formatSignificant(value * factor, 3);
  const scale = parameter.scale === "log" ? ", logarithmic" : "";
  const label = `${name} between ${text(parameter.low)} and ${text(parameter.high)} ${unit}${scale}`;
  return h(
    "div",
    { class: `bounds-bar ${verdictTone(parameter.verdict)}`, role: "img", "aria-label": label },
    bars(parameter, given),
    h(
      "div",
      { class: "bounds-ends", "aria-hidden": "true" },
      h("span", {}, text(parameter.low)),
      h("span", {}, parameter.scale),
      h("span", {}, text(parameter.high)),
    ),
  );
}

/** Share of the way between the bounds that the narrowest bar takes, so that it shows beside the value. */
const LEAST_WIDTH = 0.018;
const BAR = { height: 5, step: 8, top: 3 };

function bars(parameter: FitParameter, intervals: readonly (Interval | null)[]): SVGElement {
  const percent = (share: number) => `${(100 * share).toFixed(2)}%`;
  const height = BAR.top * 2 + Math.max(1, intervals.length) * BAR.step;
  const drawing = svg("svg", { class: "bounds-drawing", width: "100%", height, "aria-hidden": "true" });
  drawing.append(svg("rect", { class: "track", x: 0, y: 0, width: "100%", height, rx: 2 }));
  intervals.forEach((interval, at) => {
    if (interval === null) return;
    const part = barPart(parameter, interval);
    const open = part.openLow || part.openHigh ? " open" : "";
    const y = BAR.top + at * BAR.step + (BAR.step - BAR.height) / 2;
    const width = Math.max(LEAST_WIDTH, part.end - part.start);
    const x = percent(Math.min(1 - width, Math.max(0, (part.start + part.end - width) / 2)));
    drawing.append(
      svg("rect", { class: `part part-${at}${open}`, x, y, width: percent(width), height: BAR.height, rx: 1 }),
    );
  });
  const at = percent(valueShare(parameter));
  drawing.append(svg("line", { class: "value-mark", x1: at, x2: at, y1: 0, y2: height }));
  return drawing;
}
