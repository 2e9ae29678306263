// variant_charts.ts — charts with one line a variant: those the scene asks for, or force on depth and on time.
//
// A needle's force comes first: it is what a scene with a needle is run for.
import { column, depthColumn, forceColumn } from "../data/columns.ts";
import { axisLabel, displayUnit, largestMagnitude } from "../format/units.ts";
import type { ChartSpec, Columns, SceneData, VariantData } from "../report_data.ts";
import { FIT_STYLE, TOTAL_STYLE, lineStyle } from "./line_style.ts";
import { eventMarks } from "./event_marks.ts";
import { type ChartModel, type Line, scaled } from "./model.ts";

/** The charts of a scene that compare its variants; empty where no variant has forces. */
export function variantCharts(scene: SceneData): ChartModel[] {
  const asked = scene.charts.filter((spec) => !spec.map);
  const own = scene.charts.length > 0 ? needlesFirst(asked, scene.variants) : defaultSpecs(scene.variants, null);
  const further = furtherInstruments(scene.variants);
  const needles = further
    .filter(({ kind }) => kind === "needle")
    .flatMap(({ name }) => defaultSpecs(scene.variants, name));
  const others = further
    .filter(({ kind }) => kind !== "needle")
    .flatMap(({ name }) => defaultSpecs(scene.variants, name));
  const specs = [...needles, ...own, ...(scene.charts.length > 0 ? [] : others)];
  const names = [...new Set(specs.flatMap((spec) => (spec.lines ?? []).map((line) => line.label)))];
  return specs.map((spec) => chartOf(spec, scene, names)).filter((model) => model.lines.length > 0);
}

/** Tools and instruments whose forces are in tables of their own. */
function furtherInstruments(variants: readonly VariantData[]): { name: string; kind: string }[] {
  const found = new Map<string, string>();
  for (const variant of variants)
    for (const { name, kind, forces } of variant.instruments) if (forces) found.set(name, kind);
  return [...found].map(([name, kind]) => ({ name, kind }));
}

/** Where forces.csv is a needle's, charts of its force before others; else as they stand. */
function needlesFirst(specs: readonly ChartSpec[], variants: readonly VariantData[]): ChartSpec[] {
  if (!variants.some((variant) => variant.instruments[0]?.kind === "needle")) return [...specs];
  const rank = (spec: ChartSpec) => (spec.y.column !== "force_N" ? 2 : spec.x.column === "depth_m" ? 0 : 1);
  return [...specs].sort((a, b) => rank(a) - rank(b));
}

const tableOf = (variant: VariantData, instrument: string | null): Columns | null =>
  instrument === null ? variant.forces : (variant.instruments.find(({ name }) => name === instrument)?.forces ?? null);

/** @param names  of lines that belong to no variant, in all charts: one of a name looks alike in all of them */
function chartOf(spec: ChartSpec, scene: SceneData, names: readonly string[]): ChartModel {
  const lines: Line[] = [];
  scene.variants.forEach((variant, index) => {
    if (spec.variants !== null && !spec.variants.includes(variant.name)) return;
    const table = tableOf(variant, spec.instrument ?? null);
    const of = (name: string) => (table ? column(table, name) : null) ?? column(variant.probes, name);
    const [x, y] = [of(spec.x.column), of(spec.y.column)];
    if (!table || !x || !y) return;
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
    const place = names.indexOf(line.label);
    lines.push({
      id: `line ${index}`,
      variant: null,
      label: line.label,
      style: lineStyle(own + place),
      x: scaled(line.x, 1),
      y: scaled(line.y, 1),
      times: null,
    });
  });
  const logX = spec.log_x === true;
  const logY = spec.log_y === true;
  if (logX) lines.forEach((line) => (line.x = line.x.map(Math.log10)));
  if (logY) lines.forEach((line) => (line.y = line.y.map(Math.log10)));
  const decades = (on: boolean, value: number) => (on ? Math.log10(value) : value);
  return {
    title: spec.title || `${spec.y.label} against ${spec.x.label}`,
    xLabel: axisLabel(spec.x.label),
    yLabel: axisLabel(spec.y.label),
    lines,
    events: scene.variants
      .flatMap((variant) => marksOf(variant, spec))
      .map((mark) => ({
        ...mark,
        x: decades(logX, mark.x),
        y: mark.y === null ? null : decades(logY, mark.y),
      })),
    note: "",
    logX,
    logY,
  };
}

/** The events of the instrument whose forces a chart shows, on the variant's line. */
function marksOf(variant: VariantData, spec: ChartSpec) {
  const table = tableOf(variant, spec.instrument ?? null);
  if (!table || (spec.variants !== null && !spec.variants.includes(variant.name))) return [];
  const ofProbe = !column(table, spec.y.column);
  return eventMarks(variant, {
    table,
    x: spec.x,
    y: spec.y,
    instrument: ofProbe ? null : (spec.instrument ?? variant.instruments[0]?.name ?? null),
  });
}

const FIT_DASHES: readonly (readonly number[])[] = [
  [4, 4],
  [1.5, 3],
  [9, 3, 1.5, 3],
];

/** Force on depth and on time, of forces.csv or of a further instrument. */
function defaultSpecs(variants: readonly VariantData[], instrument: string | null): ChartSpec[] {
  const tables = variants.map((variant) => tableOf(variant, instrument)).filter((table) => table !== null);
  const first = tables.find((table) => forceColumn(table) !== null);
  const forceName = first ? forceColumn(first) : null;
  if (!first || !forceName) return [];
  const depthName = depthColumn(first);
  const axis = (name: string, label: string, unit: string) => {
    const shown = displayUnit(unit, largestMagnitude(...tables.map((table) => column(table, name) ?? [])));
    return { column: name, label: `${label} [${shown.unit}]`, scale: shown.factor };
  };
  const force = axis(forceName, "Force", "N");
  const of = instrument === null ? "" : ` of ${instrument}`;
  const common = { y: force, variants: null, ...(instrument === null ? {} : { instrument }) };
  const specs: ChartSpec[] = [];
  if (depthName) specs.push({ title: `Force${of} against depth`, x: axis(depthName, "Depth", "m"), ...common });
  specs.push({ title: `Force${of} against time`, x: axis("time_s", "Time", "s"), ...common });
  return specs;
}
