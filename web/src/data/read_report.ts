// read_report.ts — the data of the page, read from its script element and made whole.
//
// Programs older or newer than the page, interrupted runs and NaN (written as null) must still give a page:
// whatever is missing becomes empty here, so that no other file has to ask.
import type {
  AdviceData,
  ChartSpec,
  CheckData,
  Columns,
  EventData,
  FieldData,
  FrameData,
  InstrumentForm,
  InstrumentPlace,
  InstrumentTable,
  IsothermData,
  MapData,
  ReportData,
  SceneData,
  SurfaceData,
  TableData,
  VariantData,
  VesselForm,
} from "../report_data.ts";
import { readLaws } from "./read_law.ts";
import { type Raw, finite, isRecord, list, numberOrNaN, record, text } from "./raw.ts";
import { readFit } from "./read_fit.ts";

export type ReadResult = { ok: true; report: ReportData } | { ok: false; reason: string };

/** Reads the report of a document. */
export function readReport(document: Document): ReadResult {
  const element = document.getElementById("glisson-data");
  return parseReport(element?.textContent ?? "");
}

/** Reads the report from its JSON text. */
export function parseReport(json: string): ReadResult {
  let parsed: unknown;
  try {
    parsed = JSON.parse(json);
  } catch {
    return { ok: false, reason: "No data was put into this page. It is the empty template of the report." };
  }
  const raw = record(parsed);
  if (raw["format"] !== 1) {
    return { ok: false, reason: `The data has format ${text(raw["format"]) || "none"}; this page reads format 1.` };
  }
  return {
    ok: true,
    report: {
      format: 1,
      title: text(raw["title"]) || "Glisson report",
      subtitle: text(raw["subtitle"]),
      version: text(raw["version"]),
      created: text(raw["created"]),
      machine: text(raw["machine"]),
      scenes: list(raw["scenes"]).map((scene, index) => readScene(record(scene), index)),
      fits: list(raw["fits"]).map((fit, index) => readFit(record(fit), index)),
    },
  };
}

function readScene(raw: Raw, index: number): SceneData {
  const name = text(raw["name"]) || `scene-${index + 1}`;
  return {
    name,
    title: text(raw["title"]) || name,
    description: text(raw["description"]),
    notes: list(raw["notes"]).map(text),
    advice: list(raw["advice"]).map((one) => readAdvice(record(one))),
    source: text(raw["source"]),
    variants: list(raw["variants"]).map((variant, at) => readVariant(record(variant), at)),
    charts: list(raw["charts"]).map((chart) => readChart(record(chart))),
    tables: list(raw["tables"]).map((table) => readTable(record(table))),
    checks: list(raw["checks"]).map((check) => readCheck(record(check))),
  };
}

function readVariant(raw: Raw, index: number): VariantData {
  const name = text(raw["name"]) || `variant-${index + 1}`;
  const summary: Record<string, number | string> = {};
  for (const [key, value] of Object.entries(record(raw["summary"]))) {
    summary[key] = typeof value === "number" ? value : value === null ? NaN : text(value);
  }
  return {
    name,
    label: text(raw["label"]) || name,
    summary,
    forces: readColumns(record(raw["forces"])),
    instruments: list(raw["instruments"]).map((one) => readInstrument(record(one))),
    probes: readColumns(record(raw["probes"])),
    events: list(raw["events"]).map((event) => readEvent(record(event))),
    law_curves: readLaws(raw["law_curves"]),
    surface: isRecord(raw["surface"]) ? readSurface(raw["surface"]) : null,
  };
}

function readInstrument(raw: Raw): InstrumentTable {
  return {
    name: text(raw["name"]),
    kind: KINDS.find((kind) => kind === raw["kind"]) ?? "none",
    forces: isRecord(raw["forces"]) ? readColumns(raw["forces"]) : null,
  };
}

function readEvent(raw: Raw): EventData {
  return {
    time_s: numberOrNaN(raw["time_s"]),
    depth_m: numberOrNaN(raw["depth_m"]),
    event: text(raw["event"]) || "event",
    instrument: text(raw["instrument"]),
  };
}

function readColumns(raw: Raw): Columns {
  const data = list(raw["data"]).map((column) => list(column).map(numberOrNaN));
  const columns = list(raw["columns"]).map(text).slice(0, data.length);
  return { columns, data: data.slice(0, columns.length) };
}

function readSurface(raw: Raw): SurfaceData | null {
  const vertices = finite(raw["vertices"], 0);
  if (vertices <= 0 || !raw["triangles"] || !raw["rest"]) return null;
  return {
    vertices,
    triangles: text(raw["triangles"]),
    rest: text(raw["rest"]),
    fixed: text(raw["fixed"]),
    instruments: list(raw["instruments"]).map((form) => readForm(record(form))),
    ...(isRecord(raw["container"]) ? { container: readVessel(raw["container"]) } : {}),
    tissue: text(raw["tissue"]),
    ...(raw["tets"] ? { tets: text(raw["tets"]) } : {}),
    ...(Array.isArray(raw["isotherms"]) ? { isotherms: raw["isotherms"].map((one) => readIsotherm(record(one))) } : {}),
    regions: list(raw["regions"])
      .map(record)
      .map((region) => ({ name: text(region["name"]), triangles: text(region["triangles"]) })),
    frames: list(raw["frames"]).map((frame) => readFrame(record(frame))),
  };
}

const readIsotherm = (raw: Raw): IsothermData => ({
  name: text(raw["name"]),
  temperature_C: finite(raw["temperature_C"], 0),
});

const KINDS = ["needle", "punch", "ball", "probe", "plate", "wall", "block", "blade"] as const;

function readForm(raw: Raw): InstrumentForm {
  return {
    name: text(raw["name"]),
    kind: KINDS.find((kind) => kind === raw["kind"]) ?? "point",
    radius_m: finite(raw["radius_m"], 0),
    length_m: finite(raw["length_m"], 0),
    tip_m: finite(raw["tip_m"], 0),
    size_m: list(raw["size_m"]).map((value) => finite(value, 0)),
  };
}

function readVessel(raw: Raw): VesselForm {
  const numbers = (value: unknown) => list(value).map((one) => finite(one, 0));
  return {
    kind: raw["kind"] === "box" ? "box" : "cylinder",
    radius_m: finite(raw["radius_m"], 0),
    width_m: finite(raw["width_m"], 0),
    length_m: finite(raw["length_m"], 0),
    height_m: finite(raw["height_m"], 0),
    origin: numbers(raw["origin"]),
    axes: numbers(raw["axes"]),
  };
}

function readPlace(raw: Raw): InstrumentPlace {
  return {
    points: list(raw["points"]).map((value) => finite(value, 0)),
    axes: list(raw["axes"]).map((value) => finite(value, 0)),
  };
}

function readFields(raw: Raw): Record<string, FieldData> {
  const fields: Record<string, FieldData> = {};
  for (const [name, value] of Object.entries(raw)) {
    const { low, high, values } = record(value);
    fields[name] = { low: finite(low, 0), high: finite(high, 0), values: text(values) };
  }
  return fields;
}

function readFrame(raw: Raw): FrameData {
  return {
    time_s: finite(raw["time_s"], 0),
    displacement_scale_m: finite(raw["displacement_scale_m"], 0),
    displacement: text(raw["displacement"]),
    intensity_max: finite(raw["intensity_max"], 0),
    intensity: text(raw["intensity"]),
    instruments: list(raw["instruments"]).map((place) => readPlace(record(place))),
    fields: readFields(record(raw["fields"])),
    ...(raw["triangles"] ? { triangles: text(raw["triangles"]) } : {}),
    ...(raw["tets"] ? { tets: text(raw["tets"]) } : {}),
    ...(raw["kinds"] ? { kinds: text(raw["kinds"]) } : {}),
    ...(Array.isArray(raw["regions"]) ? { regions: raw["regions"].map(text) } : {}),
  };
}

function readChart(raw: Raw): ChartSpec {
  const axis = (value: unknown) => {
    const axisRaw = record(value);
    const column = text(axisRaw["column"]);
    return { column, label: text(axisRaw["label"]) || column, scale: finite(axisRaw["scale"], 1) };
  };
  return {
    title: text(raw["title"]),
    x: axis(raw["x"]),
    y: axis(raw["y"]),
    variants: Array.isArray(raw["variants"]) ? raw["variants"].map(text) : null,
    points: list(raw["points"]).map((points) => readCurve(record(points))),
    fits: list(raw["fits"]).map((fit) => readCurve(record(fit))),
    lines: list(raw["lines"]).map((line) => readCurve(record(line))),
    log_x: raw["log_x"] === true,
    log_y: raw["log_y"] === true,
    ...(isRecord(raw["map"]) ? { map: readMap(raw["map"]) } : {}),
  };
}

function readMap(raw: Raw): MapData {
  const numbers = (value: unknown) => list(value).map(numberOrNaN);
  return {
    label: text(raw["label"]),
    of: list(raw["of"])
      .map(record)
      .map((one) => {
        const [x, y, value] = [numbers(one["x"]), numbers(one["y"]), numbers(one["value"])];
        const length = Math.min(x.length, y.length, value.length);
        const name = text(one["variant"]);
        return {
          variant: name,
          label: text(one["label"]) || name,
          x: x.slice(0, length),
          y: y.slice(0, length),
          value: value.slice(0, length),
        };
      }),
  };
}

function readCurve(raw: Raw): { label: string; x: number[]; y: number[] } {
  return { label: text(raw["label"]), x: list(raw["x"]).map(numberOrNaN), y: list(raw["y"]).map(numberOrNaN) };
}

function readTable(raw: Raw): TableData {
  return {
    title: text(raw["title"]),
    columns: list(raw["columns"]).map(text),
    rows: list(raw["rows"]).map((row) => list(row).map((cell) => (typeof cell === "number" ? cell : text(cell)))),
    note: text(raw["note"]),
  };
}

function readAdvice(raw: Raw): AdviceData {
  return {
    rule: text(raw["rule"]),
    kind: raw["kind"] === "warning" ? "warning" : "remark",
    text: text(raw["text"]),
    variants: list(raw["variants"]).map(text),
  };
}

function readCheck(raw: Raw): CheckData {
  return {
    what: text(raw["what"]),
    measured: text(raw["measured"]),
    expected: text(raw["expected"]),
    pass: raw["pass"] === true,
  };
}
