// column_charts.ts — charts of one variant over time: the parts of its force, and its energies.
import {
  column,
  columnLabel,
  containerColumns,
  energyColumns,
  forceColumn,
  isZero,
  partColumns,
} from "../data/columns.ts";
import { displayUnit, largestMagnitude } from "../format/units.ts";
import type { VariantData } from "../report_data.ts";
import { type LineStyle, TOTAL_STYLE, lineStyle } from "./line_style.ts";
import { eventMarks } from "./event_marks.ts";
import { type ChartModel, type Line, scaled } from "./model.ts";

/** Elastic, viscous, … parts of the tool's force against time, or null where the table holds none. */
export function partsChart(variant: VariantData): ChartModel | null {
  const parts = partColumns(variant.forces);
  const total = forceColumn(variant.forces);
  if (parts.length === 0) return null;
  const styles = new Map(parts.map((name, index) => [name, lineStyle(index)]));
  if (total) styles.set(total, TOTAL_STYLE);
  return columnChart(variant, "Parts of the force", "Force", "N", total ? [total, ...parts] : parts, styles, total);
}

/** What bottom and side of a container carry against time, beside the tool's force; null where there is no container. */
export function containerChart(variant: VariantData): ChartModel | null {
  const loads = containerColumns(variant.forces);
  const total = forceColumn(variant.forces);
  if (loads.length === 0) return null;
  const styles = new Map(loads.map((name, index) => [name, lineStyle(index)]));
  if (total) styles.set(total, TOTAL_STYLE);
  return columnChart(variant, "Loads on the container", "Load", "N", total ? [total, ...loads] : loads, styles, total);
}

/** All energies of a variant against time, or null where the table holds none. */
export function energyChart(variant: VariantData): ChartModel | null {
  const names = energyColumns(variant.forces);
  if (names.length === 0) return null;
  const styles = new Map(names.map((name, index) => [name, lineStyle(index)]));
  return columnChart(variant, "Energies", "Energy", "J", names, styles);
}

function columnChart(
  variant: VariantData,
  title: string,
  what: string,
  unit: string,
  names: readonly string[],
  styles: ReadonlyMap<string, LineStyle>,
  marked: string | null = null, // the line on which events are
): ChartModel | null {
  const time = column(variant.forces, "time_s");
  if (!time) return null;
  const values = new Map(names.map((name) => [name, column(variant.forces, name) ?? []]));
  const shown = names.filter((name) => !isZero(values.get(name)!));
  const zero = names.filter((name) => !shown.includes(name));
  const drawn = shown.length > 0 ? shown : names;
  const x = displayUnit("s", largestMagnitude(time));
  const y = displayUnit(unit, largestMagnitude(...values.values()));
  const times = scaled(time, 1);
  const lines: Line[] = drawn.map((name) => ({
    id: name,
    variant: null,
    label: columnLabel(name),
    style: styles.get(name) ?? TOTAL_STYLE,
    x: scaled(time, x.factor),
    y: scaled(values.get(name)!, y.factor),
    times,
  }));
  const note = shown.length > 0 && zero.length > 0 ? `Zero throughout: ${zero.map(columnLabel).join(", ")}.` : "";
  return {
    title,
    xLabel: `Time [${x.unit}]`,
    yLabel: `${what} [${y.unit}]`,
    lines,
    events: eventMarks(variant, {
      table: variant.forces,
      x: { column: "time_s", scale: x.factor },
      y: marked !== null && drawn.includes(marked) ? { column: marked, scale: y.factor } : null,
      instrument: marked === null ? null : (variant.instruments[0]?.name ?? null),
    }),
    note,
  };
}
