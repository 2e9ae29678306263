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
  scenes: SceneData[]; // one or more; may be empty where there are fits
  fits?: FitData[];
}

export interface SceneData {
  name: string; // file stem, e.g. "figure2"
  title: string;
  description: string; // plain text
  notes: string[]; // choices where the source is silent
  advice: AdviceData[]; // warnings first
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
  instruments: InstrumentTable[]; // tools and instruments in the order of the run; the first one's columns are those of forces
  probes: Columns; // columns of probes.csv, row by row those of forces; empty without probes
  events: EventData[]; // events.csv; empty where there is no instrument
  law_curves: LawData[];
  surface: SurfaceData | null;
}

/** The forces of one tool or instrument. */
export interface InstrumentTable {
  name: string;
  kind: InstrumentForm["kind"] | "none"; // none: a driven set
  forces: Columns | null; // columns of forces_NAME.csv; null: those of forces.csv
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
  measure: string; // e.g. "equivalent shear strain s [-]"
  quantity: "modulus" | "nominal stress" | "shear stress"; // of the curves
  x: number[];
  curves: { label: string; y: number[] }[]; // [Pa]; NaN where the law has no answer
}

export interface SurfaceData {
  vertices: number;
  triangles: Base64; // u32, three per triangle, outward
  rest: Base64; // f32, xyz per vertex [m]
  fixed: Base64; // u8 per vertex: 1 held, 2 driven by a tool, 0 free
  instruments: InstrumentForm[];
  container?: VesselForm;
  tissue?: string; // name of the tissue of most of the body
  regions?: RegionSurface[]; // of all other regions; their inner vertices come after those of the outer surface
  tets?: Base64; // u32, four per tet, of the whole body, whose other vertices come last; none: surfaces alone
  isotherms?: IsothermData[]; // of the field temperature, to be drawn within the body
  frames: FrameData[]; // in time order, may be empty
}

/** A surface of one temperature. */
export interface IsothermData {
  name: string; // of the scene's isotherm; may be empty
  temperature_C: number;
}

/** The closed surface of a region of the body at first. */
export interface RegionSurface {
  name: string;
  triangles: Base64; // u32, three per triangle, outward
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

/** The vessel about a body. */
export interface VesselForm {
  kind: "cylinder" | "box";
  radius_m?: number; // of a cylinder
  width_m?: number; // of a box, along its own x …
  length_m?: number; // … and y
  height_m: number; // of the wall
  origin: number[]; // centre of its floor [m]
  axes: number[]; // rows of its rotation, nine; its z is up
}

/** Where an instrument is in a frame. */
export interface InstrumentPlace {
  points: number[]; // xyz each [m]: the centre line of a needle from the hand to the tip; else its tip
  axes: number[]; // rows of its rotation, nine
}

/** A field at each vertex: value = low + u8 / 255 × (high − low) [SI]. */
export interface FieldData {
  low: number; // 0 lies between these
  high: number;
  values: Base64; // u8 per vertex (of tets the mean of the adjacent ones)
}

export interface FrameData {
  time_s: number;
  displacement_scale_m: number; // displacement = i16 / 32767 × this
  displacement: Base64; // i16, xyz per vertex; empty: the body rests
  intensity_max: number; // equivalent shear strain s = u8 / 255 × this
  intensity: Base64; // u8 per vertex (mean of the adjacent tets); empty: there is none
  fields?: Record<string, FieldData>; // besides the intensity: pressure, von_mises, contact_pressure, temperature [°C]
  instruments: InstrumentPlace[]; // one for each of the surface's
  triangles?: Base64; // where the surface has become another, from this frame on; vertices that come later are not in
  // earlier frames
  kinds?: Base64; // u8 per triangle, from this frame on: 0 skin, 1 a face that was cut, 2 skin whose capsule is torn; a
  // frame with other triangles and no kinds has skin only
  tets?: Base64; // likewise, where the body has become another
  regions?: Base64[]; // u32, triangles of each of the surface's regions, from this frame on
}

export interface ChartSpec {
  title: string;
  x: AxisSpec;
  y: AxisSpec;
  instrument?: string; // whose table the columns are of; none: forces.csv
  variants: string[] | null; // names; null: all
  points?: { label: string; x: number[]; y: number[] }[]; // measured, in the axes' display units, drawn as circles
  fits?: { label: string; x: number[]; y: number[] }[]; // extra lines, in the axes' display units, drawn dashed
  lines?: { label: string; x: number[]; y: number[] }[]; // the chart's own, in the axes' display units, as those of variants
  log_x?: boolean; // x by its logarithm; all x above 0
  log_y?: boolean; // y likewise
  map?: MapData; // a map in place of lines
}

/** The largest value at places (x, y), in display units; lists of a variant equally long. */
export interface MapData {
  label: string; // of the values, with unit
  of: { variant: string; label: string; x: number[]; y: number[]; value: number[] }[];
}

export interface AxisSpec {
  column: string; // of forces, else of probes
  label: string; // with unit, e.g. "depth [mm]"
  scale: number; // display = value × scale
}

export interface TableData {
  title: string;
  columns: string[];
  rows: (string | number)[][];
  note: string;
}

/** What is known of a scene before it runs, as `glisson check` says it. */
export interface AdviceData {
  rule: string; // as in docs/output.md, e.g. "locking"
  kind: "warning" | "remark"; // a warning: results may be wrong
  text: string; // sentences with the numbers and the way out
  variants: string[]; // labels of those that it is said of; empty: the whole scene
}

export interface CheckData {
  what: string; // sentence
  measured: string; // with unit
  expected: string; // with unit and source
  pass: boolean;
}

/** A fit: the parameters of a tissue that measured curves allow. Numbers that could not be found are null. */
export interface FitData {
  name: string; // file stem
  title: string;
  description: string; // plain text
  notes: string[];
  source: string; // FIT.toml
  tissue: string; // the result, ready for scenes; "" where there is none
  result_file?: string; // its name; tissue.toml where it is not said
  law: string; // the law of `parameters`, e.g. "ogden, 1 term"
  law_curves: LawData[]; // what that law says in tests of the material; empty where the result is no tissue
  parameters: FitParameter[];
  correlation: (number | null)[][]; // of the scaled parameters; row i belongs to parameters[i]; empty: unknown
  x: FitAxis; // of curves that say none: display = displacement [m] × scale, e.g. "strain [%]"
  y: FitAxis; // of all errors, and of curves that say none: display = force [N] × scale, e.g. "nominal stress [kPa]"
  curves: FitCurve[];
  groups: FitGroup[];
  tests: FitTest[]; // as the groups
  rms_fit: number; // [N]
  rms_heldout: number | null; // [N]; null: no curve held out
  spread_N: number | null; // spread_N of the groups, rms over them; null: none repeated
  profiles: FitProfile[];
  basins: FitBasin[]; // best first
  start_costs: { cost: number; basin: number }[]; // where each start ended, in the order they ran; basin: index
  starts: number; // run
  starts_planned: number;
  forward_runs: number;
  forward: string; // which forward model was chosen, and why, in a sentence
  forward_error_N: number | null; // its largest difference from the finest of the ladder
  wall_s: number;
  complete: boolean; // false: interrupted
  bootstrap: { replicates: number; values: number[][] } | null; // one row of parameters each
  laws: FitLaw[]; // empty: one law only
  discovered: FitDiscovered[]; // laws of few terms that were looked at; within a size the best first
  designs: FitDesign[]; // best first
  conclusions: string[]; // sentences, most important first
}

/** Axis of the charts of a fit. */
export interface FitAxis {
  label: string; // with unit
  scale: number;
}

export interface FitParameter {
  name: string; // a scene's key, e.g. "tissue.hyperelastic.mu_Pa[0]"
  unit: string; // SI, of every number here; "" or "-" where there is none
  scale: "linear" | "log";
  low: number;
  high: number;
  value: number;
  sd: number | null;
  ci95_curvature: [number, number] | null; // by curvature
  ci95_profile: [number | null, number | null] | null; // by profile; null end: open within the bounds
  ci95_bootstrap: [number, number] | null;
  further95: [number | null, number | null] | null; // of a further specimen's own value; null: not known
  further_batch95: [number | null, number | null] | null; // of a further batch's optimum; null: not known
  verdict: "identified" | "negligible" | "weak" | "not identifiable" | "at bound" | "read off";
  words: string; // why, in a sentence
}

/** One measured test; all lists equally long. */
export interface FitCurve {
  name: string;
  group: string; // name of its FitGroup
  velocity_m_s: number;
  held_out: boolean;
  x: FitCurveAxis;
  y: FitAxis; // of measured and fitted
  unit: string; // of measured and fitted
  drive_unit: string;
  time_s: number[]; // empty: the test has no times
  drive: number[]; // what was driven: of a press the displacement [m]
  measured: number[]; // of a press the force [N]
  fitted: number[]; // null within: the simulation ended before
  further_low: number[]; // between these a further specimen's force lies in 95 %; empty: not known
  further_high: number[];
  noise: number; // standard deviation of `measured`
  rms: number; // of fitted − measured
}

/** The x axis of a curve: time, or what was driven. */
export interface FitCurveAxis extends FitAxis {
  of: "drive" | "time";
  log: boolean;
}

/** A law of a library of terms. */
export interface FitDiscovered {
  name: string;
  terms: number;
  parameters: number;
  cost: number;
  least_r2: number; // of all tests
  taken: boolean; // compared with the others
}

/** A kind of test: how well the fit of all meets it, and what fits to one test alone make of it. */
export interface FitTest {
  name: string; // of its group
  held_out: boolean;
  r2: number;
  r2_of_alone: { name: string; r2: number }[]; // empty: there is only one kind of test
  points: number;
}

/** Repetitions of one test; a test both fitted and held out is two groups of one name. */
export interface FitGroup {
  name: string;
  held_out: boolean;
  rms_N: number; // of fitted − measured, over its curves
  spread_N: number | null; // standard deviation (n − 1) of all repetitions of this test, fitted and held out, rms over
  // the displacements; null: one curve only
}

/** Profile likelihood of one parameter: the others optimised anew at each of its values. */
export interface FitProfile {
  parameter: string; // name
  values: number[]; // rising
  rise: number[]; // of −2 ln L above its least [-]
  threshold: number; // of 95 %
  words: string; // e.g. that it is flat
}

/** An optimum that starts ended in. */
export interface FitBasin {
  cost: number;
  found: number; // how many starts ended here
  values: number[]; // of the parameters
  best: boolean;
}

export interface FitLaw {
  name: string;
  parameters: number;
  rms_fit: number; // [N]
  rms_heldout: number | null; // [N]
  aic: number;
  bic: number;
  best: boolean; // the one the data support
  words: string;
}

/** What an experiment more would bring; widths of the 95 % interval in the parameter's unit. */
export interface FitDesign {
  what: string;
  parameter: string; // name
  width_now: number;
  width_after: number;
}
