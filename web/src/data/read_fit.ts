// read_fit.ts — a fit from its JSON, made whole: lists of one curve equally long, matrices square, intervals in order.
import type {
  FitAxis,
  FitBasin,
  FitCurve,
  FitData,
  FitGroup,
  FitLaw,
  FitParameter,
  FitProfile,
  FitTest,
} from "../report_data.ts";
import { readLaws } from "./read_law.ts";
import { type Raw, finite, list, numberOrNaN, numberOrNull, numbers, record, text } from "./raw.ts";

export function readFit(raw: Raw, index: number): FitData {
  const name = text(raw["name"]) || `fit-${index + 1}`;
  const parameters = list(raw["parameters"]).map((parameter, at) => readParameter(record(parameter), at));
  const x = readAxis(raw["x"], "displacement [m]");
  const y = readAxis(raw["y"], "force [N]");
  const curves = list(raw["curves"]).map((curve, at) => readCurve(record(curve), at, x, y));
  const bootstrap = record(raw["bootstrap"]);
  const replicates = rowsOf(bootstrap["values"], parameters.length);
  const basins = list(raw["basins"]).map((basin) => readBasin(record(basin)));
  return {
    name,
    title: text(raw["title"]) || name,
    description: text(raw["description"]),
    notes: list(raw["notes"]).map(text),
    source: text(raw["source"]),
    tissue: text(raw["tissue"]),
    law: text(raw["law"]),
    law_curves: readLaws(raw["law_curves"]),
    parameters,
    correlation: readMatrix(raw["correlation"], parameters.length),
    x,
    y,
    curves,
    groups: readGroups(raw["groups"], curves),
    tests: list(raw["tests"]).map((test) => readTest(record(test))),
    rms_fit: numberOrNaN(raw["rms_fit"]),
    rms_heldout: numberOrNull(raw["rms_heldout"]),
    spread_N: numberOrNull(raw["spread_N"]),
    profiles: list(raw["profiles"]).map((profile) => readProfile(record(profile))),
    basins,
    start_costs: list(raw["start_costs"])
      .map(record)
      .map((start) => ({ cost: numberOrNaN(start["cost"]), basin: finite(start["basin"], -1) })),
    starts: finite(
      raw["starts"],
      basins.reduce((sum, basin) => sum + basin.found, 0),
    ),
    starts_planned: finite(raw["starts_planned"], 0),
    forward_runs: numberOrNaN(raw["forward_runs"]),
    forward: text(raw["forward"]),
    forward_error_N: numberOrNull(raw["forward_error_N"]),
    wall_s: numberOrNaN(raw["wall_s"]),
    complete: raw["complete"] !== false,
    bootstrap:
      replicates.length > 0
        ? { replicates: finite(bootstrap["replicates"], replicates.length), values: replicates }
        : null,
    laws: list(raw["laws"]).map((law) => readLaw(record(law))),
    discovered: list(raw["discovered"])
      .map(record)
      .map((law) => ({
        name: text(law["name"]),
        terms: finite(law["terms"], 0),
        parameters: finite(law["parameters"], 0),
        cost: numberOrNaN(law["cost"]),
        least_r2: numberOrNaN(law["least_r2"]),
        taken: law["taken"] === true,
      })),
    designs: list(raw["designs"])
      .map(record)
      .map((design) => ({
        what: text(design["what"]),
        parameter: text(design["parameter"]),
        width_now: numberOrNaN(design["width_now"]),
        width_after: numberOrNaN(design["width_after"]),
      })),
    conclusions: list(raw["conclusions"]).map(text),
  };
}

function readAxis(value: unknown, otherwise: string): FitAxis {
  const raw = record(value);
  return { label: text(raw["label"]) || otherwise, scale: finite(raw["scale"], 1) };
}

const VERDICTS = ["identified", "negligible", "weak", "not identifiable", "at bound", "read off"] as const;

function readParameter(raw: Raw, index: number): FitParameter {
  return {
    name: text(raw["name"]) || `parameter ${index + 1}`,
    unit: text(raw["unit"]),
    scale: raw["scale"] === "log" ? "log" : "linear",
    low: numberOrNaN(raw["low"]),
    high: numberOrNaN(raw["high"]),
    value: numberOrNaN(raw["value"]),
    sd: numberOrNull(raw["sd"]),
    ci95_curvature: readInterval(raw["ci95_curvature"]),
    ci95_profile: readOpenInterval(raw["ci95_profile"]),
    ci95_bootstrap: readInterval(raw["ci95_bootstrap"]),
    further95: readOpenInterval(raw["further95"]),
    further_batch95: readOpenInterval(raw["further_batch95"]),
    verdict: VERDICTS.find((verdict) => verdict === raw["verdict"]) ?? "weak",
    words: text(raw["words"]),
  };
}

function readOpenInterval(value: unknown): [number | null, number | null] | null {
  const ends = list(value);
  return ends.length === 2 ? [numberOrNull(ends[0]), numberOrNull(ends[1])] : null;
}

function readInterval(value: unknown): [number, number] | null {
  const [low, high] = readOpenInterval(value) ?? [null, null];
  if (low === null || high === null) return null;
  return [Math.min(low, high), Math.max(low, high)];
}

/** A square matrix of `size`, or none. */
function readMatrix(value: unknown, size: number): (number | null)[][] {
  const rows = list(value).map((row) => list(row).map(numberOrNull));
  return rows.length === size && rows.every((row) => row.length === size) ? rows : [];
}

function rowsOf(value: unknown, width: number): number[][] {
  return list(value)
    .map(numbers)
    .filter((row) => row.length === width);
}

/** Curves of presses have their units in their keys. */
function readCurve(raw: Raw, index: number, x: FitAxis, y: FitAxis): FitCurve {
  const of = (key: string) => raw[key] ?? raw[`${key}_N`];
  const drive = numbers(raw["drive"] ?? raw["displacement_m"]);
  const measured = numbers(of("measured"));
  const time_s = numbers(raw["time_s"]);
  const length = Math.min(drive.length, measured.length);
  const whole = (values: number[]) => Array.from({ length }, (_, at) => values[at] ?? NaN);
  const axis = record(raw["x"]);
  return {
    name: text(raw["name"]) || `curve ${index + 1}`,
    group: text(raw["group"]),
    velocity_m_s: numberOrNaN(raw["velocity_m_s"]),
    held_out: raw["held_out"] === true,
    x: raw["x"]
      ? { ...readAxis(axis, x.label), of: axis["of"] === "time" ? "time" : "drive", log: axis["log"] === true }
      : { ...x, of: "drive", log: false },
    y: raw["y"] ? readAxis(raw["y"], y.label) : y,
    unit: text(raw["unit"]) || "N",
    drive_unit: text(raw["drive_unit"]) || "m",
    time_s: time_s.length > 0 ? whole(time_s) : [],
    drive: whole(drive),
    measured: whole(measured),
    fitted: whole(numbers(of("fitted"))),
    further_low: numbers(of("further_low")).slice(0, length),
    further_high: numbers(of("further_high")).slice(0, length),
    noise: finite(of("noise"), 0),
    rms: numberOrNaN(of("rms")),
  };
}

function readTest(raw: Raw): FitTest {
  return {
    name: text(raw["name"]),
    held_out: raw["held_out"] === true,
    r2: numberOrNaN(raw["r2"]),
    r2_of_alone: Object.entries(record(raw["r2_of_alone"])).map(([name, r2]) => ({ name, r2: numberOrNaN(r2) })),
    points: finite(raw["points"], 0),
  };
}

/** Groups as given, and one of its own for every curve whose group is not among them. */
function readGroups(value: unknown, curves: readonly FitCurve[]): FitGroup[] {
  const groups = list(value)
    .map(record)
    .map((raw) => ({
      name: text(raw["name"]),
      held_out: raw["held_out"] === true,
      rms_N: numberOrNaN(raw["rms_N"]),
      spread_N: numberOrNull(raw["spread_N"]),
    }));
  for (const curve of curves) {
    if (groups.some((group) => group.name === curve.group && group.held_out === curve.held_out)) continue;
    groups.push({ name: curve.group, held_out: curve.held_out, rms_N: curve.rms, spread_N: null });
  }
  return groups;
}

function readProfile(raw: Raw): FitProfile {
  const values = numbers(raw["values"]);
  const rise = numbers(raw["rise"]);
  const length = Math.min(values.length, rise.length);
  return {
    parameter: text(raw["parameter"]),
    values: values.slice(0, length),
    rise: rise.slice(0, length),
    threshold: finite(raw["threshold"], 3.841),
    words: text(raw["words"]),
  };
}

function readBasin(raw: Raw): FitBasin {
  return {
    cost: numberOrNaN(raw["cost"]),
    found: finite(raw["found"], 0),
    values: numbers(raw["values"]),
    best: raw["best"] === true,
  };
}

function readLaw(raw: Raw): FitLaw {
  return {
    name: text(raw["name"]),
    parameters: numberOrNaN(raw["parameters"]),
    rms_fit: numberOrNaN(raw["rms_fit"]),
    rms_heldout: numberOrNull(raw["rms_heldout"]),
    aic: numberOrNaN(raw["aic"]),
    bic: numberOrNaN(raw["bic"]),
    best: raw["best"] === true,
    words: text(raw["words"]),
  };
}
