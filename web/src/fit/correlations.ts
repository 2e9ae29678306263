// correlations.ts — which parameters can stand in for each other: matrix, and replicates of the closest pairs.
import { formatSignificant } from "../format/number.ts";
import { h } from "../page/dom.ts";
import { figure } from "../page/figure.ts";
import type { FitData } from "../report_data.ts";
import {
  type ShortName,
  nameElement,
  nameWithUnit,
  parameterUnit,
  plainName,
  shortNames,
  withSubscripts,
} from "./names.ts";
import { type Pair, closestPairs, correlationOf, strongWords } from "./pairs.ts";
import { plot } from "./plot/plot.ts";
import { scaleOf } from "./plot/scale.ts";

const MOST_PAIRS = 6;
/** Longer names do not stand over the columns of the matrix: numbers do. */
const MOST_LETTERS = 30;
/** A matrix of more rows than this takes the whole width. */
const MOST_BESIDE = 5;

/** Figures of a fit with two parameters or more; empty where nothing is known of their correlation. */
export function correlationFigures(fit: FitData): HTMLElement[] {
  const matrix = correlationOf(fit);
  if (fit.parameters.length < 2 || matrix.length === 0) return [];
  const names = shortNames(fit.parameters);
  const words = strongWords(matrix, names.map(plainName));
  const note = h("p", { class: "figure-note" }, ...withSubscripts(words));
  const figures = [
    figure(
      "Correlations",
      h("div", {}, matrixTable(matrix, names), note),
      null,
      names.length > MOST_BESIDE ? "figure-wide" : "figure-matrix",
    ),
  ];
  const pairs = fit.bootstrap ? closestPairs(matrix, MOST_PAIRS) : [];
  if (pairs.length > 0) {
    const plots = h("div", { class: "plots" }, ...pairs.map((pair) => scatter(fit, pair, names)));
    const about = h("span", { class: "figure-about" }, `${fit.bootstrap!.replicates} replicates; cross: the optimum`);
    figures.push(
      figure("Bootstrap, closest pairs", plots, about, names.length > MOST_BESIDE ? "figure-wide" : "figure-scatter"),
    );
  }
  return figures;
}

function matrixTable(matrix: readonly (readonly (number | null)[])[], names: readonly ShortName[]): HTMLElement {
  const numbered = names.map(plainName).join("").length > MOST_LETTERS;
  const head = names.map((name, at) =>
    h("th", { scope: "col", title: plainName(name) }, numbered ? String(at + 1) : nameElement(name)),
  );
  const rows = matrix.map((values, line) =>
    h(
      "tr",
      {},
      h("th", { scope: "row" }, numbered ? `${line + 1}  ` : null, nameElement(names[line]!)),
      ...values.map((value, at) => cell(value, at === line)),
    ),
  );
  return h(
    "div",
    { class: "table-scroll", tabindex: 0, role: "region", "aria-label": "Correlation matrix" },
    h("table", { class: "matrix" }, h("thead", {}, h("tr", {}, h("td", {}), ...head)), h("tbody", {}, ...rows)),
  );
}

function cell(value: number | null, diagonal: boolean): HTMLElement {
  if (diagonal) return h("td", { class: "diagonal" }, "1");
  if (value === null) return h("td", {}, "–");
  const strength = Math.round(100 * Math.min(1, Math.abs(value)) ** 1.5);
  return h(
    "td",
    { class: value < 0 ? "negative" : "positive", style: `--strength:${strength}%` },
    formatCorrelation(value),
  );
}

/** Two decimals, three where two would say 1. */
export function formatCorrelation(value: number): string {
  const size = Math.abs(value);
  const text = size.toFixed(size >= 0.995 && size < 1 ? 3 : 2);
  return value < 0 && /[1-9]/.test(text) ? `−${text}` : text;
}

function scatter(fit: FitData, pair: Pair, names: readonly ShortName[]): HTMLElement {
  const axis = (index: number) => {
    const parameter = fit.parameters[index]!;
    const { unit, factor } = parameterUnit(parameter);
    const values = fit.bootstrap!.values.map((row) => row[index]! * factor);
    const log = parameter.scale === "log";
    const optimum = parameter.value * factor;
    return {
      values,
      optimum,
      axis: { label: nameWithUnit(names[index]!, unit), scale: scaleOf([...values, optimum], 0.08, log), ticks: 3 },
    };
  };
  const [x, y] = [axis(pair.a), axis(pair.b)];
  const chart = plot({
    title: `Replicates of ${plainName(names[pair.a]!)} and ${plainName(names[pair.b]!)}`,
    x: x.axis,
    y: y.axis,
    marks: [
      { kind: "rule", className: "plot-rule", x: x.optimum },
      { kind: "rule", className: "plot-rule", y: y.optimum },
      { kind: "dots", className: "plot-cloud", x: x.values, y: y.values, name: "" },
    ],
    readout: (mark, index) => `${formatSignificant(mark.x[index]!, 4)} · ${formatSignificant(mark.y[index]!, 4)}`,
  });
  return h("div", { class: "plot-cell" }, chart, h("p", { class: "plot-words" }, `r = ${formatCorrelation(pair.r)}`));
}
