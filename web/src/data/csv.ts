// csv.ts — a force table as comma-separated text, the same layout as the program's forces.csv.
import type { Columns } from "../report_data.ts";
import { rowCount } from "./columns.ts";

/** Rows of a table with texts in it; quotes where a comma, a quote or a line break wants them, NaN and null empty. */
export function rowsToCsv(columns: readonly string[], rows: readonly (readonly (string | number | null)[])[]): string {
  return [columns, ...rows].map((row) => row.map(anyCell).join(",")).join("\n") + "\n";
}

function anyCell(value: string | number | null): string {
  if (typeof value !== "string") return cell(value ?? undefined);
  return /[",\n\r]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value;
}

/** Header and one line a sample; gaps (NaN) are empty cells. */
export function toCsv(table: Columns): string {
  const lines = [table.columns.join(",")];
  const rows = rowCount(table);
  for (let row = 0; row < rows; row++) {
    lines.push(table.data.map((values) => cell(values[row])).join(","));
  }
  return lines.join("\n") + "\n";
}

function cell(value: number | undefined): string {
  return value === undefined || !Number.isFinite(value) ? "" : String(value);
}
