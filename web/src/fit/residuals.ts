// residuals.ts — what the simulation leaves of the measured force, against the band of its noise.
import { h } from "../page/dom.ts";
import { figure } from "../page/figure.ts";
import { axisLabel, nameOfLabel, unitOfLabel } from "../format/units.ts";
import type { FitAxis, FitCurve, FitData } from "../report_data.ts";
import { type Panel, along, panelTitle, panelsOf } from "./panels.ts";
import type { PlotMark } from "./plot/marks.ts";
import { plot } from "./plot/plot.ts";
import { type Scale, makeScale, scaleOf } from "./plot/scale.ts";
import { use } from "./verdicts.ts";

/** Points read out per curve; more would make the arrow keys useless. */
const MOST_READ = 60;

export function residualFigures(fit: FitData): HTMLElement | null {
  const panels = panelsOf(fit);
  if (panels.length === 0) return null;
  const plots = panels.map((panel) =>
    h(
      "div",
      { class: "plot-cell" },
      h("p", { class: "plot-title" }, h("span", {}, panelTitle(panel)), use(panel.group.held_out)),
      residualPlot(panel, residualScale(fit, panel.curves[0]!.y)),
    ),
  );
  const about = h("span", { class: "figure-about" }, "Measured − simulated; grey band: ± 2 sd of the noise");
  return figure("Residuals", h("div", { class: "plots plots-large" }, ...plots), about, "figure-wide");
}

/** Residuals of a curve in the unit of the charts. */
export function residualsOf(curve: FitCurve): number[] {
  return curve.measured.map((measured, at) => (measured - curve.fitted[at]!) * curve.y.scale);
}

/** One scale for all of one axis: symmetric, and wide enough for the noise. */
export function residualScale(fit: FitData, axis: FitAxis): Scale {
  let size = 0;
  for (const curve of fit.curves.filter((curve) => curve.y.label === axis.label)) {
    size = Math.max(size, 2.2 * curve.noise * Math.abs(curve.y.scale));
    for (const residual of residualsOf(curve)) {
      if (Number.isFinite(residual)) size = Math.max(size, Math.abs(residual));
    }
  }
  return makeScale(-1.08 * size, 1.08 * size);
}

function residualPlot(panel: Panel, y: Scale): HTMLElement {
  const axes = panel.curves[0]!;
  const unit = unitOfLabel(axes.y.label);
  const noise = Math.max(...panel.curves.map((curve) => curve.noise)) * Math.abs(axes.y.scale);
  const xs = panel.curves.map((curve) => Array.from(along(curve)));
  const residuals = panel.curves.map(residualsOf);
  const marks: PlotMark[] = [
    { kind: "band", className: "plot-noise", x: [null, null], y: [-2 * noise, 2 * noise] },
    { kind: "rule", className: "plot-rule", y: 0 },
    ...panel.curves.map((_, at): PlotMark => ({
      kind: "line",
      className: "plot-residual",
      x: xs[at]!,
      y: residuals[at]!,
    })),
    ...panel.curves.map((curve, at): PlotMark => {
      const every = Math.max(1, Math.ceil(xs[at]!.length / MOST_READ));
      const thin = (values: readonly number[]) => values.filter((_, index) => index % every === 0);
      return { kind: "line", className: "plot-hidden", name: curve.name, x: thin(xs[at]!), y: thin(residuals[at]!) };
    }),
  ];
  return plot({
    title: `Residuals of ${panelTitle(panel)}`,
    x: { label: axisLabel(axes.x.label), scale: scaleOf(xs.flat(), 0, axes.x.log) },
    y: { label: unit ? `Residual [${unit}]` : `Residual of ${nameOfLabel(axes.y.label)}`, scale: y },
    marks,
  });
}
