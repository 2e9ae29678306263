// csv.ts — a force table as comma-separated text, the same layout as the program's forces.csv.
import type { Columns } from "../report_data.ts";
import { rowCount } from "./columns.ts";

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
