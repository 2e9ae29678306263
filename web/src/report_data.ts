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
  events: EventData[]; // events.csv; empty where there is no instrument
  law: LawData | null;
  surface: SurfaceData | null;
}

/** Something an instrument met: contact, puncture, drop, … */
export interface EventData {
  time_s: number;
  depth_m: number;
  event: string;
  instrument: string;
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
  instruments: InstrumentForm[];
  frames: FrameData[]; // in time order, may be empty
}

/** What an instrument looks like; lengths along its own z axis, from its tip up. */
export interface InstrumentForm {
  name: string;
  kind: "needle" | "punch" | "ball" | "probe" | "plate" | "wall" | "block" | "blade" | "point";
  radius_m: number; // 0 where the kind has none
  length_m: number;
  tip_m: number; // of a probe: length of its tip
  size_m: number[]; // of a block: along its own x, y, z; of a blade: both ends of its edge, six numbers
}

/** Where an instrument is in a frame. */
export interface InstrumentPlace {
  points: number[]; // xyz each [m]: the centre line of a needle from the hand to the tip; else its tip
  axes: number[]; // rows of its rotation, nine
}

export interface FrameData {
  time_s: number;
  displacement_scale_m: number; // displacement = i16 / 32767 × this
  displacement: Base64; // i16, xyz per vertex
  intensity_max: number; // intensity s = u8 / 255 × this
  intensity: Base64; // u8 per vertex (mean of the adjacent tets)
  instruments: InstrumentPlace[]; // one for each of the surface's
  triangles?: Base64; // where the surface has become another, from this frame on; vertices that come later are not in
  // earlier frames
}

export interface ChartSpec {
  title: string;
  x: AxisSpec;
  y: AxisSpec;
  variants: string[] | null; // names; null: all
  points?: { label: string; x: number[]; y: number[] }[]; // measured, in the axes' display units, drawn as circles
  fits?: { label: string; x: number[]; y: number[] }[]; // extra lines, in the axes' display units, drawn dashed
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
