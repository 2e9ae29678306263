// starts.ts — where the starts ended: costs in rising order, and the optima they found.
import { formatColumn, formatSignificant } from "../format/number.ts";
import { h } from "../page/dom.ts";
import { figure } from "../page/figure.ts";
import type { FitBasin, FitData } from "../report_data.ts";
import { digitsFor } from "./intervals.ts";
import { nameElement, parameterUnit, shortNames } from "./names.ts";
import { plot } from "./plot/plot.ts";
import { makeScale, scaleOf } from "./plot/scale.ts";

/** Optima shown in the table. */
const MOST_OPTIMA = 10;
/** Costs that differ by more than this factor are shown on a logarithmic axis. */
const LOG_FROM = 30;

export function startFigures(fit: FitData): HTMLElement[] {
  const ends = startEnds(fit);
  const figures: HTMLElement[] = [];
  if (ends.length > 1) figures.push(figure("Where the starts ended", waterfall(ends), null, "figure-starts"));
  if (fit.basins.length > 0) figures.push(figure("Optima", basinTable(fit), null, "figure-basins"));
  return figures;
}

export interface StartEnd {
  cost: number;
  best: boolean;
}

/** All starts by cost; from the optima where the starts themselves are not known. */
export function startEnds(fit: FitData): StartEnd[] {
  const known = fit.start_costs.map(({ cost, basin }) => ({ cost, best: fit.basins[basin]?.best ?? false }));
  const ends =
    known.length > 0
      ? known
      : fit.basins.flatMap(({ cost, found, best }) => Array.from({ length: found }, () => ({ cost, best })));
  return ends.filter((end) => Number.isFinite(end.cost)).sort((a, b) => a.cost - b.cost);
}

function waterfall(ends: readonly StartEnd[]): HTMLElement {
  const costs = ends.map((end) => end.cost);
  const log = costs[0]! > 0 && costs[costs.length - 1]! / costs[0]! > LOG_FROM;
  const flat = costs[costs.length - 1]! - costs[0]! < 1e-3 * Math.abs(costs[0]!);
  const centre = Math.abs(costs[0]!) || 1;
  const marks = [true, false].map((best) => {
    const chosen = ends.map((end, at) => ({ ...end, rank: at + 1 })).filter((end) => end.best === best);
    return {
      kind: "dots" as const,
      className: best ? "plot-dots large" : "plot-dots large other",
      name: best ? "best optimum" : "another optimum",
      x: chosen.map((end) => end.rank),
      y: chosen.map((end) => end.cost),
    };
  });
  return plot({
    title: "Cost of all starts",
    x: { label: "Start, in order of cost", scale: makeScale(0.2, ends.length + 0.8), ticks: Math.min(8, ends.length) },
    y: {
      label: log ? "Cost, logarithmic" : "Cost",
      scale: flat ? makeScale(costs[0]! - 0.1 * centre, costs[0]! + 0.1 * centre) : scaleOf(costs, 0.1, log),
    },
    marks,
    readout: (mark, index) => `${mark.name}: ${formatSignificant(mark.y[index]!, 6)}`,
  });
}

function basinTable(fit: FitData): HTMLElement {
  const names = shortNames(fit.parameters);
  const units = fit.parameters.map(parameterUnit);
  const costs = formatColumn(
    fit.basins.slice(0, MOST_OPTIMA).map((basin) => basin.cost),
    5,
  );
  const more = fit.basins.length - MOST_OPTIMA;
  const heads = names.map((name, at) =>
    h(
      "th",
      { scope: "col", class: "number" },
      nameElement(name),
      units[at]!.unit ? h("span", { class: "unit" }, ` [${units[at]!.unit}]`) : null,
    ),
  );
  const row = (basin: FitBasin, at: number) =>
    h(
      "tr",
      { class: basin.best ? "best" : null },
      h("th", { scope: "row" }, basin.best ? "best" : `${at + 1}`),
      h("td", { class: "number" }, costs[at]),
      h("td", { class: "number" }, `${basin.found} of ${fit.starts}`),
      ...fit.parameters.map((parameter, index) => {
        const digits = digitsFor(parameter.value, parameter.ci95_curvature);
        return h(
          "td",
          { class: "number" },
          formatSignificant((basin.values[index] ?? NaN) * units[index]!.factor, digits),
        );
      }),
    );
  return h(
    "div",
    { class: "table-scroll", tabindex: 0, role: "region", "aria-label": "Optima" },
    h(
      "table",
      { class: "fit-table" },
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          h("th", { scope: "col" }, "Optimum"),
          h("th", { scope: "col", class: "number" }, "Cost"),
          h("th", { scope: "col", class: "number" }, "Found by"),
          ...heads,
        ),
      ),
      h("tbody", {}, ...fit.basins.slice(0, MOST_OPTIMA).map(row)),
    ),
    more > 0 ? h("p", { class: "figure-note" }, `And ${more} more of higher cost; all are in the CSV.`) : null,
  );
}
