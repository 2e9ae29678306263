// report_data.ts — what the engine hands to the report page: the one contract between them.
//
// The program replaces the text of <script id="glisson-data" type="application/json"> in the built page by
// this object as JSON, with every "<" written as \u003c. Numbers are SI; the page chooses display units.

/** Base64 of little-endian numbers of the type in the name. */
export type Base64 = string;

export interface ReportData {
  format: 1;
  title: string;
  subtitle: string;
  version: string; // of the program
  created: string; // ISO 8601, UTC
  machine: string; // e.g. "2 × AMD EPYC …"
  scenes: SceneData[]; // one or more
}

export interface SceneData {
  name: string; // file stem, e.g. "figure2"
  title: string;
  description: string; // plain text
  notes: string[]; // choices where the source is silent
  source: string; // the TOML text
  variants: VariantData[];
  charts: ChartSpec[]; // empty: the page shows force against depth and force against time
  tables: TableData[];
  checks: CheckData[]; // figures held against the literature, shown as pass or fail
}

export interface VariantData {
  name: string;
  label: string; // for the legend
  summary: Record<string, number | string>; // summary.json
  forces: Columns; // columns of forces.csv
  law: LawData | null;
  surface: SurfaceData | null;
}

/** Column-major table: data[i] belongs to columns[i]; all columns equally long. */
export interface Columns {
  columns: string[];
  data: number[][];
}

export interface LawData {
  measure: string; // e.g. "intensity s [-]"
  quantity: "modulus" | "nominal stress"; // of the curves
  x: number[];
  curves: { label: string; y: number[] }[]; // [Pa]
}

export interface SurfaceData {
  vertices: number;
  triangles: Base64; // u32, three per triangle, outward
  rest: Base64; // f32, xyz per vertex [m]
  fixed: Base64; // u8 per vertex: 1 held, 2 driven by a tool, 0 free
  frames: FrameData[]; // in time order, may be empty
}

export interface FrameData {
  time_s: number;
  displacement_scale_m: number; // displacement = i16 / 32767 × this
  displacement: Base64; // i16, xyz per vertex
  intensity_max: number; // intensity s = u8 / 255 × this
  intensity: Base64; // u8 per vertex (mean of the adjacent tets)
}

export interface ChartSpec {
  title: string;
  x: AxisSpec;
  y: AxisSpec;
  variants: string[] | null; // names; null: all
  fits?: { label: string; x: number[]; y: number[]; }[]; // extra lines, in the axes' display units, drawn dashed
}

export interface AxisSpec {
  column: string; // of forces
  label: string; // with unit, e.g. "depth [mm]"
  scale: number; // display = value × scale
}

export interface TableData {
  title: string;
  columns: string[];
  rows: (string | number)[][];
  note: string;
}

export interface CheckData {
  what: string; // sentence
  measured: string; // with unit
  expected: string; // with unit and source
  pass: boolean;
}
