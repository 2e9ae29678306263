// panels.ts — curves of a fit put into charts: a chart for each group and use, all on the same axes.
import type { ChartModel, Extent, Line } from "../charts/model.ts";
import { extentOf, scaled } from "../charts/model.ts";
import { FIT_STYLE, MEASURED_STYLE, TOTAL_STYLE } from "../charts/line_style.ts";
import { axisLabel } from "../format/units.ts";
import type { FitCurve, FitData, FitGroup } from "../report_data.ts";

export const MEASURED = "measured";
export const SIMULATED = "simulated";
export const FURTHER = "further";

export interface Panel {
  group: FitGroup;
  curves: FitCurve[];
}

/** Groups that have curves, fitted ones first, in their own order. */
export function panelsOf(fit: FitData): Panel[] {
  const panels = fit.groups.map((group) => ({
    group,
    curves: fit.curves.filter((curve) => curve.group === group.name && curve.held_out === group.held_out),
  }));
  return panels
    .filter((panel) => panel.curves.length > 0)
    .sort((a, b) => Number(a.group.held_out) - Number(b.group.held_out));
}

/** Models of the charts; where their axes are the same on one common range, unless that would flatten one of them. */
export function curveCharts(panels: readonly Panel[]): ChartModel[] {
  const models = panels.map(curveChart);
  const alike = new Set(models.map((model) => `${model.xLabel} ${model.yLabel}`)).size === 1;
  const common = alike ? commonExtent(models.map((model) => extentOf(model.lines))) : null;
  if (common) for (const model of models) model.extent = common;
  return models;
}

/** Where the points of a curve lie along x, in the unit of its axis. */
export function along(curve: FitCurve): Float64Array {
  return scaled(curve.x.of === "time" ? curve.time_s : curve.drive, curve.x.scale);
}

/** The same as a chart takes it: exponents of ten where its axis counts decades. */
function placed(curve: FitCurve): Float64Array {
  return curve.x.log ? along(curve).map(Math.log10) : along(curve);
}

function curveChart(panel: Panel): ChartModel {
  const count = panel.curves.length;
  const lines = (["measured", "fitted"] as const).flatMap((column) =>
    panel.curves.map((curve): Line => {
      const measured = column === "measured";
      const kind = measured ? MEASURED : SIMULATED;
      return {
        id: `${kind} ${curve.name}`,
        variant: kind,
        entry: kind,
        label: measured && count > 1 ? `${MEASURED}, ${count} repetitions` : kind,
        style: measured ? MEASURED_STYLE : TOTAL_STYLE,
        x: placed(curve),
        y: scaled(curve[column], curve.y.scale),
        times: null,
      };
    }),
  );
  lines.push(...furtherLines(panel));
  return {
    title: panelTitle(panel),
    logX: panel.curves[0]!.x.log,
    xLabel: axisLabel(panel.curves[0]!.x.label),
    yLabel: axisLabel(panel.curves[0]!.y.label),
    lines,
    events: [],
    note: "",
  };
}

/** Between which forces a further specimen is expected, at the instants of the longest curve. */
function furtherLines(panel: Panel): Line[] {
  const curve = panel.curves.reduce((a, b) => (b.further_low.length > a.further_low.length ? b : a));
  return (["further_low", "further_high"] as const)
    .filter((column) => curve[column].length > 0)
    .map((column) => ({
      id: `${FURTHER} ${column}`,
      variant: FURTHER,
      entry: FURTHER,
      label: "95 % of further specimens",
      style: FIT_STYLE,
      x: placed(curve),
      y: scaled(curve[column], curve.y.scale),
      times: null,
    }));
}

export function panelTitle(panel: Panel): string {
  return panel.group.name || panel.curves[0]?.name || "Curves";
}

/** The range that holds all; null where the smallest chart would fill less than a quarter of it. */
export function commonExtent(extents: readonly Extent[]): Extent | null {
  if (extents.length === 0) return null;
  const common = {
    xMin: Math.min(...extents.map((extent) => extent.xMin)),
    xMax: Math.max(...extents.map((extent) => extent.xMax)),
    yMin: Math.min(...extents.map((extent) => extent.yMin)),
    yMax: Math.max(...extents.map((extent) => extent.yMax)),
  };
  const fills = (extent: Extent) =>
    extent.xMax - extent.xMin >= 0.25 * (common.xMax - common.xMin) &&
    extent.yMax - extent.yMin >= 0.25 * (common.yMax - common.yMin);
  return extents.every(fills) ? common : null;
}
