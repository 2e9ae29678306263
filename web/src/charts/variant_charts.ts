// variant_charts.ts — charts with one line a variant: those the scene asks for, or force on depth and on time.
import { column, depthColumn, forceColumn } from "../data/columns.ts";
import { axisLabel, displayUnit, largestMagnitude } from "../format/units.ts";
import type { ChartSpec, SceneData, VariantData } from "../report_data.ts";
import { FIT_STYLE, TOTAL_STYLE, lineStyle } from "./line_style.ts";
import { eventMarks } from "./event_marks.ts";
import { type ChartModel, type Line, scaled } from "./model.ts";

/** The charts of a scene that compare its variants; empty where no variant has forces. */
export function variantCharts(scene: SceneData): ChartModel[] {
  const specs = scene.charts.length > 0 ? scene.charts.filter((spec) => !spec.map) : defaultSpecs(scene.variants);
  return specs.map((spec) => chartOf(spec, scene)).filter((model) => model.lines.length > 0);
}

function chartOf(spec: ChartSpec, scene: SceneData): ChartModel {
  const lines: Line[] = [];
  scene.variants.forEach((variant, index) => {
    if (spec.variants !== null && !spec.variants.includes(variant.name)) return;
    const x = column(variant.forces, spec.x.column) ?? column(variant.probes, spec.x.column);
    const y = column(variant.forces, spec.y.column) ?? column(variant.probes, spec.y.column);
    if (!x || !y) return;
    const time = column(variant.forces, "time_s");
    lines.push({
      id: variant.name,
      variant: variant.name,
      label: variant.label,
      style: lineStyle(index),
      x: scaled(x, spec.x.scale),
      y: scaled(y, spec.y.scale),
      times: time ? scaled(time, 1) : null,
    });
  });
  (spec.points ?? []).forEach((measured, index) => {
    lines.push({
      id: `points ${index}`,
      variant: null,
      label: measured.label || "measured",
      style: TOTAL_STYLE,
      x: scaled(measured.x, 1),
      y: scaled(measured.y, 1),
      times: null,
      points: true,
    });
  });
  (spec.fits ?? []).forEach((fit, index) => {
    lines.push({
      id: `fit ${index}`,
      variant: null,
      label: fit.label,
      style: { ...FIT_STYLE, dash: FIT_DASHES[index % 3]! },
      x: scaled(fit.x, 1),
      y: scaled(fit.y, 1),
      times: null,
    });
  });
  const own = lines.filter((line) => !line.points).length;
  (spec.lines ?? []).forEach((line, index) => {
    lines.push({
      id: `line ${index}`,
      variant: null,
      label: line.label,
      style: lineStyle(own + index),
      x: scaled(line.x, 1),
      y: scaled(line.y, 1),
      times: null,
    });
  });
  const logX = spec.log_x === true;
  const logY = spec.log_y === true;
  if (logX) lines.forEach((line) => (line.x = line.x.map(Math.log10)));
  if (logY) lines.forEach((line) => (line.y = line.y.map(Math.log10)));
  return {
    title: spec.title || `${spec.y.label} against ${spec.x.label}`,
    xLabel: axisLabel(spec.x.label),
    yLabel: axisLabel(spec.y.label),
    lines,
    events: scene.variants.flatMap((variant) => eventMarks(variant, spec.x.column, spec.x.scale)),
    note: "",
    logX,
    logY,
  };
}

const FIT_DASHES: readonly (readonly number[])[] = [
  [4, 4],
  [1.5, 3],
  [9, 3, 1.5, 3],
];

function defaultSpecs(variants: readonly VariantData[]): ChartSpec[] {
  const first = variants.find((variant) => forceColumn(variant.forces) !== null);
  const forceName = first ? forceColumn(first.forces) : null;
  if (!first || !forceName) return [];
  const depthName = depthColumn(first.forces);
  const axis = (name: string, label: string, unit: string) => {
    const shown = displayUnit(unit, largestMagnitude(...variants.map((variant) => column(variant.forces, name) ?? [])));
    return { column: name, label: `${label} [${shown.unit}]`, scale: shown.factor };
  };
  const force = axis(forceName, "Force", "N");
  const specs: ChartSpec[] = [];
  if (depthName)
    specs.push({ title: "Force against depth", x: axis(depthName, "Depth", "m"), y: force, variants: null });
  specs.push({ title: "Force against time", x: axis("time_s", "Time", "s"), y: force, variants: null });
  return specs;
}
