// law_figures.ts — what the fitted law says beyond the tests: stress against stretch and shear; the laws by their size.
import { Chart } from "../charts/chart.ts";
import { lawCharts } from "../charts/law_charts.ts";
import { SceneState } from "../charts/scene_state.ts";
import { formatSignificant } from "../format/number.ts";
import { h } from "../page/dom.ts";
import { figure } from "../page/figure.ts";
import type { FitData, FitDiscovered } from "../report_data.ts";
import { plot } from "./plot/plot.ts";
import { makeScale, scaleOf } from "./plot/scale.ts";

/** Costs that differ by more than this factor are shown on a logarithmic axis. */
const LOG_FROM = 30;

export function lawFigures(fit: FitData): HTMLElement[] {
  const label = fit.law || "the fitted law";
  const state = new SceneState([label]);
  return lawCharts([{ name: label, label, law_curves: fit.law_curves }]).map((model) =>
    figure(model.title, new Chart(model, state).element),
  );
}

/** Cost over the number of terms: every law that was looked at, and the best of each size; null where none was looked for. */
export function discoveryFigure(fit: FitData): HTMLElement | null {
  const laws = fit.discovered.filter((law) => Number.isFinite(law.cost) && law.cost > 0);
  const sizes = [...new Set(laws.map((law) => law.terms))].sort((a, b) => a - b);
  if (sizes.length < 2) return null;
  const best = sizes.map((size) => leastCost(laws.filter((law) => law.terms === size)));
  const taken = laws.filter((law) => law.taken);
  const costs = laws.map((law) => law.cost);
  const log = Math.max(...costs) / Math.min(...costs) > LOG_FROM;
  const marks = [
    dots("plot-dots other", laws),
    { kind: "line" as const, className: "plot-line", x: best.map((law) => law.terms), y: best.map((law) => law.cost) },
    dots("plot-dots large", taken),
  ];
  const named = [laws, best, taken];
  const element = plot({
    title: "Cost of the laws by their number of terms",
    x: { label: "Terms", scale: makeScale(sizes[0]! - 0.3, sizes[sizes.length - 1]! + 0.3), ticks: sizes.length },
    y: { label: log ? "Cost, logarithmic" : "Cost", scale: scaleOf(costs, 0.1, log) },
    marks,
    readout: (mark, index) => {
      const law = named[marks.findIndex((one) => one === mark)]?.[index];
      return law ? `${law.name}: ${formatSignificant(law.cost, 5)}` : "";
    },
  });
  const about = h("span", { class: "figure-about" }, "Line: best of each size; large: compared by data left out");
  return figure("Laws found, by their number of terms", element, about, "figure-discovered");
}

function dots(className: string, laws: readonly FitDiscovered[]) {
  return {
    kind: "dots" as const,
    className,
    name: "law",
    x: laws.map((law) => law.terms),
    y: laws.map((law) => law.cost),
  };
}

function leastCost(laws: readonly FitDiscovered[]): FitDiscovered {
  return laws.reduce((least, law) => (law.cost < least.cost ? law : least));
}
