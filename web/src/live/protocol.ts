// protocol.ts — the bytes between page and program: docs/view.md has them as a table, apps/view/ the other end.
import type { InstrumentForm, VesselForm } from "../report_data.ts";

export interface ToolInfo {
  name: string;
  instrument: boolean;
  direction: number[];
  side: number[];
  third: number[];
  least_m: number;
  most_m: number;
  speed_m_s: number;
  can_play: boolean;
}

export interface ParameterInfo {
  label: string;
  unit: string;
  least: number;
  most: number;
  value: number;
  log: boolean; // better chosen by its logarithm
  tissue: string;
  group: string;
  formula: string;
  help: string;
}

export interface Recorded {
  start_s: number;
  end_s: number;
  frames: number;
}

export interface Hello {
  type: "hello";
  title: string;
  variant: string;
  version: string;
  session: string;
  vertices: number;
  tets: number;
  can_grab: boolean;
  why_no_cut: string; // empty: the body can be cut
  has_stress: boolean; // pressure can be shown
  tools: ToolInfo[];
  parameters: ParameterInfo[];
  instruments: InstrumentForm[];
  container?: VesselForm | null;
  recorded: Recorded | null; // a run that is played, not simulated
  can_record: boolean;
}

export interface Role {
  type: "role";
  drives: boolean;
  led: boolean;
  viewers: number;
}

export interface LiveEvent {
  tool: string;
  event: string;
  time_s: number;
  depth_m: number;
}

export interface SlowState {
  type: "state";
  epoch: number;
  parameters: number[];
  speeds_m_s: number[];
  cut_area_m2: number;
  cut_longest_s: number;
  pieces: number;
  events_before: number;
  events: LiveEvent[];
}

export interface Notice {
  type: "notice";
  text: string;
}

export type TextMessage = Hello | Role | SlowState | Notice;

export interface Keyframe {
  kind: "keyframe";
  number: number;
  rest: Float32Array;
  triangles: Uint32Array;
  marks: Uint8Array;
  kinds: Uint8Array | null; // of each triangle: 0 skin, 1 a face that was cut, 2 skin whose capsule is torn
  tissue: string; // name of what most of the body is; may be empty
  regions: { name: string; triangles: Uint32Array }[]; // closed surfaces of what else there is
  tets: Uint32Array | null; // of the whole body, whose other vertices come last; null: its surfaces alone were sent
}

export interface ToolState {
  depth: number; // [m]
  aside: number[]; // along its own x and y [m]
  force: [number, number, number]; // on the tissue [N]
  axes: number[];
  points: number[];
}

export interface LiveFrame {
  kind: "frame";
  keyframe: number;
  epoch: number;
  echo: number;
  time: number; // simulated [s]
  realtimeFactor: number;
  p50: number; // of the computing of a frame [µs]
  p99: number;
  dropped: number;
  paused: boolean;
  building: boolean;
  playing: boolean;
  grabbing: boolean;
  stopped: boolean;
  grabForce: [number, number, number];
  reach: number; // displacement = i16 / 32767 × this [m]
  field: number; // that colours stand for; 0: none came
  low: number; // its value = low + u8 / 255 × (high − low)
  high: number;
  tools: ToolState[];
  displacement: Int16Array;
  values: Uint8Array;
}

export interface Samples {
  kind: "samples";
  tools: number;
  rows: { epoch: number; time: number; depth: number[]; force: number[] }[];
}

const FRAME_HEAD = 64;

/** A binary message; null where it is none that this page knows. */
export function decodeMessage(buffer: ArrayBuffer): Keyframe | LiveFrame | Samples | null {
  const view = new DataView(buffer);
  if (buffer.byteLength < 8) return null;
  try {
    if (view.getUint8(0) === 1) return decodeKeyframe(view);
    if (view.getUint8(0) === 2) return decodeFrame(view);
    if (view.getUint8(0) === 3) return decodeSamples(view);
  } catch (error) {
    if (!(error instanceof RangeError)) throw error; // cut short
  }
  return null;
}

function decodeKeyframe(view: DataView): Keyframe {
  const [vertices, triangles] = [view.getUint32(8, true), view.getUint32(12, true)];
  const atTriangles = 16 + 12 * vertices;
  const atMarks = atTriangles + 12 * triangles;
  return {
    kind: "keyframe",
    number: view.getUint32(4, true),
    rest: new Float32Array(view.buffer.slice(16, atTriangles) as ArrayBuffer),
    triangles: new Uint32Array(view.buffer.slice(atTriangles, atMarks) as ArrayBuffer),
    marks: new Uint8Array(view.buffer as ArrayBuffer, atMarks, vertices),
    ...decodeInside(view, atMarks + vertices, triangles),
  };
}

/** Kinds of the triangles, names, surfaces of inner regions, and tets where they were asked for; an old program sends none. */
function decodeInside(
  view: DataView,
  from: number,
  triangles: number,
): Pick<Keyframe, "kinds" | "tissue" | "regions" | "tets"> {
  if (view.byteLength < from + triangles + 4) return { kinds: null, tissue: "", regions: [], tets: null };
  const kinds = new Uint8Array(view.buffer as ArrayBuffer, from, triangles);
  let at = aligned(from + triangles);
  const words = (): string => {
    const bytes = new Uint8Array(view.buffer as ArrayBuffer, at + 4, view.getUint32(at, true));
    at = aligned(at + 4 + bytes.length);
    return new TextDecoder().decode(bytes);
  };
  const tissue = words();
  const count = view.getUint32(at, true);
  at += 4;
  const regions: Keyframe["regions"] = [];
  for (let i = 0; i < count; i++) {
    const name = words();
    const corners = 3 * view.getUint32(at, true);
    if (at + 4 + 4 * corners > view.byteLength) throw new RangeError("a region that was cut short");
    regions.push({ name, triangles: new Uint32Array(view.buffer.slice(at + 4, at + 4 + 4 * corners) as ArrayBuffer) });
    at += 4 + 4 * corners;
  }
  const cells = at + 4 <= view.byteLength ? view.getUint32(at, true) : 0;
  if (cells > 0 && at + 4 + 16 * cells > view.byteLength) throw new RangeError("tets that were cut short");
  const tets = cells > 0 ? new Uint32Array(view.buffer.slice(at + 4, at + 4 + 16 * cells) as ArrayBuffer) : null;
  return { kinds: kinds.some((kind) => kind !== 0) ? kinds : null, tissue, regions, tets };
}

const aligned = (at: number): number => 4 * Math.ceil(at / 4);

const vector = (view: DataView, at: number): [number, number, number] => [
  view.getFloat32(at, true),
  view.getFloat32(at + 4, true),
  view.getFloat32(at + 8, true),
];

function decodeFrame(view: DataView): LiveFrame {
  const flags = view.getUint8(1);
  const tools: ToolState[] = [];
  let at = FRAME_HEAD;
  for (let i = view.getUint8(2); i > 0; i--) {
    const points = view.getUint32(at + 60, true);
    tools.push({
      depth: view.getFloat32(at, true),
      force: vector(view, at + 4),
      axes: floats(view, at + 16, 9),
      aside: floats(view, at + 52, 2),
      points: floats(view, at + 64, 3 * points),
    });
    at += 64 + 12 * points;
  }
  const field = view.getUint8(3);
  const vertices = Math.floor((view.byteLength - at) / (field === 0 ? 6 : 7));
  return {
    kind: "frame",
    keyframe: view.getUint32(4, true),
    epoch: view.getUint32(8, true),
    echo: view.getUint32(12, true),
    time: view.getFloat64(16, true),
    realtimeFactor: view.getFloat32(24, true),
    p50: view.getFloat32(28, true),
    p99: view.getFloat32(32, true),
    dropped: view.getUint32(36, true),
    paused: (flags & 1) !== 0,
    building: (flags & 2) !== 0,
    playing: (flags & 4) !== 0,
    grabbing: (flags & 8) !== 0,
    stopped: (flags & 16) !== 0,
    grabForce: vector(view, 40),
    reach: view.getFloat32(52, true),
    field,
    low: view.getFloat32(56, true),
    high: view.getFloat32(60, true),
    tools,
    displacement: new Int16Array(view.buffer as ArrayBuffer, at, 3 * vertices),
    values: new Uint8Array(view.buffer as ArrayBuffer, at + 6 * vertices, field === 0 ? 0 : vertices),
  };
}

const floats = (view: DataView, at: number, count: number): number[] =>
  Array.from({ length: count }, (_, i) => view.getFloat32(at + 4 * i, true));

function decodeSamples(view: DataView): Samples {
  const tools = view.getUint8(1);
  const rows: Samples["rows"] = [];
  let at = 8;
  for (let i = view.getUint32(4, true); i > 0; i--) {
    const both = floats(view, at + 8, 2 * tools);
    rows.push({
      epoch: view.getUint32(at, true),
      time: view.getFloat32(at + 4, true),
      depth: both.filter((_, k) => k % 2 === 0),
      force: both.filter((_, k) => k % 2 === 1),
    });
    at += 8 + 8 * tools;
  }
  return { kind: "samples", tools, rows };
}

export type Command =
  | { kind: "place"; tool: number; values: [number, number, number] } // depth, aside [m]
  | { kind: "speed"; tool: number; values: [number] } // [m/s]
  | { kind: "grab"; tool: 0 | 1; index: number; values: [number, number, number] } // by springs or bonded; surface vertex, where to [m]
  | { kind: "drag"; values: [number, number, number] }
  | { kind: "pause"; index: 0 | 1 }
  | { kind: "parameter"; index: number; values: [number] }
  | { kind: "cut"; index: 0 | 1; values: number[] } // 1 begins; the edge, from where to where [m]
  | { kind: "colour"; index: number } // field
  | { kind: "visible"; index: 0 | 1 } // of this page
  | { kind: "inside"; index: 0 | 1 } // whether the whole body is sent
  | { kind: "seek"; values: [number] } // of a recorded run, to this time [s]
  | { kind: "rate"; values: [number] }
  | { kind: "letGo" | "step" | "reset" | "undo" | "play" | "take" | "give" };

const KINDS: Record<Command["kind"], number> = {
  place: 1,
  speed: 2,
  grab: 3,
  drag: 4,
  letGo: 5,
  pause: 6,
  step: 7,
  reset: 8,
  play: 9,
  parameter: 10,
  take: 11,
  give: 12,
  cut: 13,
  colour: 14,
  seek: 15,
  rate: 16,
  visible: 17,
  undo: 18,
  inside: 19,
};

/** The bytes of a command. */
export function encodeCommand(command: Command, sequence: number): ArrayBuffer {
  const index = "index" in command ? [command.index] : [];
  const values: number[] = "values" in command ? [...command.values] : [];
  const view = new DataView(new ArrayBuffer(8 + 4 * index.length + 4 * values.length));
  view.setUint8(0, KINDS[command.kind]);
  view.setUint8(1, "tool" in command ? command.tool : 0);
  view.setUint32(4, sequence, true);
  index.forEach((value) => view.setUint32(8, value, true));
  values.forEach((value, i) => view.setFloat32(8 + 4 * index.length + 4 * i, value, true));
  return view.buffer;
}
