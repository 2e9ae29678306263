// columns.ts — picks columns out of the force table of a variant and gives them names to show.
import type { Columns } from "../report_data.ts";

/** A column by name, or null where the table has none or it is empty. */
export function column(table: Columns, name: string): number[] | null {
  const index = table.columns.indexOf(name);
  const values = index < 0 ? undefined : table.data[index];
  return values && values.length > 0 ? values : null;
}

/** Rows of a table: the shortest column counts. */
export function rowCount(table: Columns): number {
  return table.data.length === 0 ? 0 : Math.min(...table.data.map((values) => values.length));
}

/** The column of the tool's force: force_N, else the first force in newtons. */
export function forceColumn(table: Columns): string | null {
  return firstColumn(table, "force_N", /force.*_N$/);
}

/** The column of the tool's depth: depth_m, else the first depth in metres. */
export function depthColumn(table: Columns): string | null {
  return firstColumn(table, "depth_m", /depth.*_m$/);
}

function firstColumn(table: Columns, exact: string, pattern: RegExp): string | null {
  if (column(table, exact)) return exact;
  return table.columns.find((name) => pattern.test(name) && column(table, name) !== null) ?? null;
}

const PART_NAMES = ["elastic_N", "viscous_N", "damping_N", "inertial_N", "gravity_N", "load_N"];
const INSTRUMENT_PART_NAMES = ["normal_N", "friction_N", "cutting_N"];
const CONTAINER_NAMES = ["bottom_z_N", "side_z_N", "side_radial_N"];

/** Columns whose sum is the tool's force. */
export function partColumns(table: Columns): string[] {
  const names = column(table, "elastic_N") ? PART_NAMES : INSTRUMENT_PART_NAMES;
  return names.filter((name) => column(table, name) !== null);
}

/** Columns of what a container carries. */
export function containerColumns(table: Columns): string[] {
  return CONTAINER_NAMES.filter((name) => column(table, name) !== null);
}

/** Columns in joules, in the order of the table. */
export function energyColumns(table: Columns): string[] {
  return table.columns.filter((name) => name.endsWith("_J") && column(table, name) !== null);
}

/** True where a column holds nothing but zeros and gaps. */
export function isZero(values: readonly number[]): boolean {
  return values.every((value) => value === 0 || !Number.isFinite(value));
}

const COLUMN_LABELS: Record<string, string> = {
  force_N: "total",
  elastic_N: "elastic",
  viscous_N: "viscous",
  damping_N: "damping",
  inertial_N: "inertial",
  gravity_N: "gravity",
  load_N: "other loads",
  normal_N: "pressing",
  friction_N: "friction",
  cutting_N: "cutting",
  bottom_z_N: "bottom, along z",
  side_z_N: "side, along z",
  side_radial_N: "side, outwards",
  energy_elastic_J: "elastic energy",
  energy_kinetic_J: "kinetic energy",
  energy_dissipated_J: "dissipated",
  energy_stored_J: "stored energy W(u)",
  energy_drift_J: "drift from W(u)",
  energy_instruments_J: "stored in instruments",
  energy_numerical_J: "numerical dissipation",
  dissipated_viscous_J: "of it by viscosity",
  dissipated_maxwell_J: "of it by Maxwell branches",
  dissipated_damping_J: "of it by damping",
  dissipated_friction_J: "friction",
  dissipated_contact_J: "contact",
  dissipated_fracture_J: "cutting and tearing",
  work_tools_J: "work of tools",
  work_loads_J: "work of loads",
};

/** A column's name for people, without its unit. */
export function columnLabel(name: string): string {
  return COLUMN_LABELS[name] ?? name.replace(/_(J|N|m|s|Pa)$/, "").replaceAll("_", " ");
}
