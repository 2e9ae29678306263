// wire.ts — what page and program of the live view send each other. Written by scripts/make_wire from messages.toml: change that.
import type { InstrumentForm, VesselForm } from "../report_data.ts";
import type { Reader } from "./reader.ts";

/** What a surface can be coloured by. The page has the displacement anyway. */
export const FIELDS = { none: 0, intensity: 1, shape: 2, pressure: 3, von_mises: 4, contact_pressure: 5 } as const;

export const MESSAGES = { keyframe: 1, frame: 2, samples: 3 } as const;

export type Command =
  | { kind: "place"; tool: number; values: [number, number, number] } // where a tool goes
  | { kind: "speed"; tool: number; values: [number] } // at which a tool goes there
  | { kind: "grab"; tool: 0 | 1; index: number; values: [number, number, number] } // takes a patch of the surface to a target
  | { kind: "drag"; values: [number, number, number] } // takes what is grabbed to another target
  | { kind: "letGo" } // lets go of what is grabbed
  | { kind: "pause"; index: 0 | 1 } // rests or goes on
  | { kind: "step" } // one frame while paused
  | { kind: "reset" } // back to rest, tools in hand
  | { kind: "play" } // back to rest, then the scene's own motion
  | { kind: "parameter"; index: number; values: [number] } // changes the tissue
  | { kind: "take" } // asks for the lead; needs no lead
  | { kind: "give" } // gives the lead away
  | { kind: "cut"; index: 0 | 1; values: number[] } // moves the blade
  | { kind: "colour"; index: number } // the field that this viewer is sent; needs no lead
  | { kind: "seek"; values: [number] } // of a recorded run: goes to a time
  | { kind: "rate"; values: [number] } // of a recorded run: how fast it plays
  | { kind: "visible"; index: 0 | 1 } // whether the page is seen, a hidden one gets no frames; needs no lead
  | { kind: "undo" } // back to before the last stroke of the blade
  | { kind: "inside"; index: 0 | 1 } // whether the whole body is sent; needs no lead
  ;

export const COMMANDS: Record<Command["kind"], number> = {
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

/** Where the head of a command has its fields. */
export const COMMAND_AT = { kind: 0, tool: 1, sequence: 4, end: 8 };

/** A region inside the body, a closed surface. */
export interface Region {
  name: string;
  triangles: Uint32Array;
}

/** Tets of the whole body, whose inner vertices come last. */
export interface Tets {
  tets: Uint32Array;
}

/** What the triangles of a keyframe are, and what is inside. */
export interface Inside {
  kinds: Uint8Array; // 1 a face that was cut, 2 skin whose capsule is torn
  tissue: string; // name of the largest region; may be empty
  regions: Region[];
  whole: Tets | null; // to those who asked for the inside; bit 31 of `number` is set then
}

/** The surface at rest; first, and again when a cut has changed it. */
export interface Keyframe {
  number: number; // that frames refer to
  rest: Float32Array; // [m]
  triangles: Uint32Array;
  marks: Uint8Array; // 1 held, 2 driven
  inside: Inside | null; // an old program sends none
}

export function readKeyframe(at: Reader): Keyframe {
  at.u8(); // kind
  at.pad();
  const number = at.u32();
  const vertexCount = at.u32();
  const triangleCount = at.u32();
  const rest = at.vec3s(vertexCount);
  const triangles = at.u32s(3 * triangleCount);
  const marks = at.u8s(vertexCount);
  const inside = at.optional(() => {
    const kinds = at.u8s(triangleCount);
    at.pad();
    const tissue = at.string();
    const regionCount = at.u32();
    const regions = at.list(regionCount, () => {
      const name = at.string();
      const triangleCount = at.u32();
      const triangles = at.u32s(3 * triangleCount);
      return { name, triangles };
    });
    const whole = at.optional(() => {
      const tetCount = at.u32();
      const tets = at.u32s(4 * tetCount);
      return { tets };
    });
    return { kinds, tissue, regions, whole };
  });
  return { number, rest, triangles, marks, inside };
}

/** A tool in a frame. */
export interface Tool {
  depth: number; // [m]
  force: [number, number, number]; // [N], on the tissue
  axes: number[]; // rows of its rotation
  aside: number[]; // [m], along its x and y
  points: Float32Array; // [m], a needle's line from the hand to the tip, else the tip
}

/** One instant. */
export interface Frame {
  paused: boolean;
  building: boolean;
  playing: boolean;
  grabbing: boolean;
  stopped: boolean;
  field: number; // `Field` of the values
  keyframe: number; // number of the keyframe it is read with
  epoch: number; // counts the bodies made
  echo: number; // sequence of the last command that acted with all before it
  time: number; // [s], simulated
  realtimeFactor: number;
  p50: number; // [µs], of the computing of 1 ms
  p99: number; // [µs]
  dropped: number; // frames that were over before their turn
  grabForce: [number, number, number]; // [N]
  reach: number; // [m], largest component of a displacement
  low: number; // least of the field's values
  high: number; // largest of them
  tools: Tool[];
  displacement: Int16Array; // × `reach` / 32767, in m
  values: Uint8Array; // `low` + (`high` − `low`) × this / 255
}

export function readFrame(at: Reader): Frame {
  at.u8(); // kind
  const flags = at.u8();
  const toolCount = at.u8();
  const field = at.u8();
  const keyframe = at.u32();
  const epoch = at.u32();
  const echo = at.u32();
  const time = at.f64();
  const realtimeFactor = at.f32();
  const p50 = at.f32();
  const p99 = at.f32();
  const dropped = at.u32();
  const grabForce = at.vec3();
  const reach = at.f32();
  const low = at.f32();
  const high = at.f32();
  const tools = at.list(toolCount, () => {
    const depth = at.f32();
    const force = at.vec3();
    const axes = at.f32s(9);
    const aside = at.f32s(2);
    const pointCount = at.u32();
    const points = at.vec3s(pointCount);
    return { depth, force, axes, aside, points };
  });
  const vertices = Math.floor(at.left / (field === 0 ? 6 : 7));
  const displacement = at.i16s(3 * vertices);
  const values = at.u8s(field === 0 ? 0 : vertices);
  return { paused: (flags & 1) !== 0, building: (flags & 2) !== 0, playing: (flags & 4) !== 0, grabbing: (flags & 8) !== 0, stopped: (flags & 16) !== 0, field, keyframe, epoch, echo, time, realtimeFactor, p50, p99, dropped, grabForce, reach, low, high, tools, displacement, values };
}

/** Forces of a millisecond. */
export interface Sample {
  epoch: number;
  time: number; // [s]
  readings: number[]; // depth in m and force along its direction in N, of each tool
}

/** Forces since this viewer's last frame, 4000 at most. */
export interface Samples {
  tools: number;
  rows: Sample[];
}

export function readSamples(at: Reader): Samples {
  at.u8(); // kind
  const tools = at.u8();
  at.pad();
  const sampleCount = at.u32();
  const rows = at.list(sampleCount, () => {
    const epoch = at.u32();
    const time = at.f32();
    const readings = at.f32s(2 * tools);
    return { epoch, time, readings };
  });
  return { tools, rows };
}

/** A tool, before anything moves. */
export interface ToolInfo {
  name: string;
  instrument: boolean; // false: a set of vertices that is driven
  direction: number[]; // of its depth, a unit vector
  side: number[]; // across it: its own x
  third: number[]; // across both: its own y
  least_m: number; // [m], least depth
  most_m: number; // [m], largest depth
  speed_m_s: number; // [m/s], that of the scene
  can_play: boolean; // the scene moves it
}

/** A number of a tissue that can be changed while the body moves. */
export interface ParameterInfo {
  label: string;
  unit: string;
  least: number;
  most: number;
  value: number;
  log: boolean; // better chosen by its logarithm
  tissue: string;
  group: string; // of numbers that belong together
  formula: string; // may be empty
  help: string;
}

/** A run that is played, not simulated. */
export interface Recorded {
  start_s: number; // [s], time of the first frame
  end_s: number; // [s], time of the last frame
  frames: number;
}

/** Something that a tool met. */
export interface LiveEvent {
  tool: string;
  event: string;
  time_s: number; // [s]
  depth_m: number; // [m]
}

/** The scene; once, first of all. */
export interface Hello {
  type: "hello";
  title: string;
  variant: string;
  version: string; // of the program
  session: string; // key of this viewer
  vertices: number;
  tets: number;
  can_grab: boolean;
  why_no_cut: string; // empty: the body can be cut
  has_stress: boolean; // stress and contact pressure can be shown
  tools: ToolInfo[];
  parameters: ParameterInfo[];
  recorded: Recorded | null;
  can_record: boolean;
  container: VesselForm | null;
  instruments: InstrumentForm[];
}

/** Who leads; on each change. */
export interface Role {
  type: "role";
  drives: boolean; // this viewer leads
  led: boolean; // some viewer leads
  viewers: number;
}

/** What changes seldom; ten a second at most. */
export interface SlowState {
  type: "state";
  epoch: number; // counts the bodies made
  parameters: number[]; // in the order of `hello`
  speeds_m_s: number[]; // [m/s], of each tool
  cut_area_m2: number; // [m²], of what the blade has cut, at rest
  cut_longest_s: number; // [s], that a piece of a cut took
  pieces: number; // that the body is in
  events_before: number; // how many came before these
  events: LiveEvent[]; // the last 32
}

/** Errors and the like; empty: no more. */
export interface Notice {
  type: "notice";
  text: string;
}

export type TextMessage = Hello | Role | SlowState | Notice;

/** Fields of each message in JSON, and what typeof or Array.isArray says of them. */
export const TEXTS: Record<TextMessage["type"], Record<string, string>> = {
  hello: { title: "string", variant: "string", version: "string", session: "string", vertices: "number", tets: "number", can_grab: "boolean", why_no_cut: "string", has_stress: "boolean", tools: "list", parameters: "list", recorded: "object", can_record: "boolean", container: "object", instruments: "list" },
  role: { drives: "boolean", led: "boolean", viewers: "number" },
  state: { epoch: "number", parameters: "list", speeds_m_s: "list", cut_area_m2: "number", cut_longest_s: "number", pieces: "number", events_before: "number", events: "list" },
  notice: { text: "string" },
};
