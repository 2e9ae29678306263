// fit_csv.ts — the numbers behind the figures of a fit, as tables in SI.
import { rowsToCsv } from "../data/csv.ts";
import type { FitData, FitParameter } from "../report_data.ts";

export interface CsvFile {
  name: string; // end of the file's name, e.g. "curves"
  label: string;
  text: () => string;
}

/** Files that this fit has anything for. */
export function csvFiles(fit: FitData): CsvFile[] {
  const files: (CsvFile & { rows: number })[] = [
    { name: "curves", label: "Curves", rows: fit.curves.length, text: () => curvesCsv(fit) },
    { name: "parameters", label: "Parameters", rows: fit.parameters.length, text: () => parametersCsv(fit) },
    { name: "profiles", label: "Profiles", rows: fit.profiles.length, text: () => profilesCsv(fit) },
    { name: "correlation", label: "Correlations", rows: fit.correlation.length, text: () => correlationCsv(fit) },
    { name: "replicates", label: "Bootstrap", rows: fit.bootstrap?.values.length ?? 0, text: () => replicatesCsv(fit) },
    { name: "starts", label: "Optima", rows: fit.basins.length, text: () => basinsCsv(fit) },
  ];
  return files.filter((file) => file.rows > 0);
}

export function curvesCsv(fit: FitData): string {
  const columns =
    "curve,group,held_out,velocity_m_s,time_s,drive,measured,fitted,further_low,further_high,drive_unit,unit".split(
      ",",
    );
  const rows = fit.curves.flatMap((curve) =>
    curve.drive.map((drive, at) => [
      curve.name,
      curve.group,
      Number(curve.held_out),
      curve.velocity_m_s,
      curve.time_s[at] ?? null,
      drive,
      curve.measured[at] ?? null,
      curve.fitted[at] ?? null,
      curve.further_low[at] ?? null,
      curve.further_high[at] ?? null,
      curve.drive_unit,
      curve.unit,
    ]),
  );
  return rowsToCsv(columns, rows);
}

export function parametersCsv(fit: FitData): string {
  const columns = ["name", "unit", "scale", "low", "high", "value", "sd"];
  const kinds = ["ci95_curvature", "ci95_profile", "ci95_bootstrap", "further95", "further_batch95"] as const;
  const head = [...columns, ...kinds.flatMap((kind) => [`${kind}_low`, `${kind}_high`]), "verdict"];
  const row = (parameter: FitParameter) => [
    ...[parameter.name, parameter.unit, parameter.scale, parameter.low, parameter.high, parameter.value, parameter.sd],
    ...kinds.flatMap((kind) => parameter[kind] ?? [null, null]),
    parameter.verdict,
  ];
  return rowsToCsv(head, fit.parameters.map(row));
}

export function profilesCsv(fit: FitData): string {
  const rows = fit.profiles.flatMap((profile) =>
    profile.values.map((value, at) => [profile.parameter, value, profile.rise[at]!, profile.threshold]),
  );
  return rowsToCsv(["parameter", "value", "rise", "threshold"], rows);
}

export function correlationCsv(fit: FitData): string {
  const names = fit.parameters.map((parameter) => parameter.name);
  return rowsToCsv(
    ["parameter", ...names],
    fit.correlation.map((row, at) => [names[at]!, ...row]),
  );
}

export function replicatesCsv(fit: FitData): string {
  return rowsToCsv(
    fit.parameters.map((parameter) => parameter.name),
    fit.bootstrap?.values ?? [],
  );
}

export function basinsCsv(fit: FitData): string {
  const head = ["cost", "found", "best", ...fit.parameters.map((parameter) => parameter.name)];
  return rowsToCsv(
    head,
    fit.basins.map((basin) => [basin.cost, basin.found, Number(basin.best), ...basin.values]),
  );
}
