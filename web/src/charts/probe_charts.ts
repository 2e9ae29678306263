// probe_charts.ts — the probes of a variant against time, a chart for each kind of quantity.
import { column, isZero } from "../data/columns.ts";
import { displayUnit, largestMagnitude } from "../format/units.ts";
import type { VariantData } from "../report_data.ts";
import { lineStyle } from "./line_style.ts";
import { eventMarks } from "./event_marks.ts";
import { type ChartModel, type Line, scaled } from "./model.ts";

export interface ProbeQuantity {
  title: string;
  what: string; // of the y axis
  unit: string;
  ends: RegExp; // of its columns' names
}

/** What probes read, in the order of the page; volume ratios and areas are in the table alone. */
export const PROBE_QUANTITIES: readonly ProbeQuantity[] = [
  { title: "Displacement at probes", what: "Displacement", unit: "m", ends: /_displacement_[xyz]_m$/ },
  { title: "Distance of tips", what: "Distance", unit: "m", ends: /_tip_(distance|along|across)_m$/ },
  { title: "Force of sections and sets", what: "Force", unit: "N", ends: /_force_[xyz]_N$/ },
  { title: "Moment of sections", what: "Moment", unit: "N·m", ends: /_moment_[xyz]_N_m$/ },
  { title: "Stress at probes", what: "Stress", unit: "Pa", ends: /_(stress_(xx|yy|zz|xy|yz|zx)|traction_[xyz])_Pa$/ },
  { title: "Pressure at probes", what: "Pressure", unit: "Pa", ends: /_pressure_Pa$/ },
  { title: "Strain at probes", what: "Green's strain", unit: "-", ends: /_strain_(xx|yy|zz|xy|yz|zx)$/ },
  { title: "Velocity at probes", what: "Velocity", unit: "m/s", ends: /_velocity_[xyz]_m_s$/ },
  { title: "Volume of regions", what: "Volume", unit: "m³", ends: /_volume_m3$/ },
];

/** `tip_stress_xx_Pa` as "tip stress xx". */
function probeLabel(name: string): string {
  return name.replace(/_(m_s|m3|N_m|Pa|N|m)$/, "").replaceAll("_", " ");
}

/** The columns of one quantity that are not zero throughout; null where there are none. */
export function probeChart(variant: VariantData, quantity: ProbeQuantity): ChartModel | null {
  const time = column(variant.probes, "time_s");
  const names = variant.probes.columns.filter((name) => quantity.ends.test(name));
  if (!time || names.length === 0) return null;
  const values = new Map(names.map((name) => [name, column(variant.probes, name) ?? []]));
  const shown = names.filter((name) => !isZero(values.get(name)!));
  const drawn = shown.length > 0 ? shown : names;
  const x = displayUnit("s", largestMagnitude(time));
  // A prefix does not go before a power or a product of units.
  const plain = quantity.unit === "m³" || quantity.unit === "N·m" || quantity.unit === "m/s";
  const y = plain
    ? { unit: quantity.unit, factor: 1 }
    : displayUnit(quantity.unit, largestMagnitude(...values.values()));
  const times = scaled(time, 1);
  const lines: Line[] = drawn.map((name, index) => ({
    id: name,
    variant: null,
    label: probeLabel(name),
    style: lineStyle(index),
    x: scaled(time, x.factor),
    y: scaled(values.get(name)!, y.factor),
    times,
  }));
  return {
    title: quantity.title,
    xLabel: `Time [${x.unit}]`,
    yLabel: `${quantity.what} [${y.unit === "-" ? "–" : y.unit}]`,
    lines,
    events: eventMarks(variant, {
      table: variant.probes,
      x: { column: "time_s", scale: x.factor },
      y: null,
      instrument: null,
    }),
    note: "",
  };
}
