// timeline.ts — the recorded frames of a body as one motion: shape and a field at any time between them.
import { decodeF32, decodeI16Scaled, decodeU32, decodeU8, decodeU8Scaled } from "../data/decode.ts";
import type {
  FrameData,
  InstrumentForm,
  IsothermData,
  InstrumentPlace,
  SurfaceData,
  VesselForm,
} from "../report_data.ts";
import type { ColourName } from "./fields.ts";

export interface Frame {
  time: number; // [s]
  displacement: Float32Array; // xyz per vertex [m]
  intensity: Float32Array; // per vertex [-]
  tets: Uint32Array | null; // of the whole body from here on; null: its surfaces alone are known
  triangles: Uint32Array; // of the surface from here on
  regions: readonly Uint32Array[]; // triangles of each inner region, likewise
  kinds: Uint8Array | null; // of each of them: 0 skin, 1 a face that was cut, 2 skin whose capsule is torn; null: all skin
  instruments: readonly InstrumentPlace[];
}

/** A surface that moves: recorded (Timeline) or streamed (live/live_surface.ts). */
export interface SurfaceMotion {
  readonly vertices: number;
  readonly triangles: Uint32Array;
  readonly rest: Float32Array;
  readonly fixed: Uint8Array;
  readonly frames: readonly Frame[];
  readonly instruments: readonly InstrumentForm[];
  readonly container: VesselForm | null;
  readonly isotherms: readonly IsothermData[];
  readonly tissue: string; // name of what most of the body is; empty where it is not said
  readonly regions: readonly { name: string; triangles: Uint32Array }[]; // closed surfaces inside the body
  readonly end: number; // time of the last frame [s]
  at(time: number): { before: Frame; after: Frame; share: number };
  sample(time: number, exaggeration: number, positions: Float32Array, intensity: Float32Array): void;
  trianglesAt(time: number): Uint32Array;
  kindsAt(time: number): Uint8Array | null;
  regionsAt(time: number): readonly Uint32Array[];
  tetsAt(time: number): Uint32Array | null;
  /** At each vertex [°C]; null where it is not known. */
  temperatureAt(time: number): Float32Array | null;
}

export interface Span {
  low: number;
  high: number;
}

export class Timeline implements SurfaceMotion {
  readonly vertices: number;
  readonly triangles: Uint32Array;
  readonly rest: Float32Array;
  readonly fixed: Uint8Array;
  readonly frames: readonly Frame[];
  readonly instruments: readonly InstrumentForm[];
  readonly container: VesselForm | null;
  readonly isotherms: readonly IsothermData[];
  readonly tissue: string;
  readonly regions: readonly { name: string; triangles: Uint32Array }[];
  readonly recorded: boolean; // false: no frames, rest shape only
  /** What sample() reads. */
  field: ColourName = "intensity";
  private readonly data: readonly FrameData[];
  private readonly read = new Map<string, Float32Array>(); // fields of frames, as they are asked for
  private readonly spans = new Map<string, Span>();
  private readonly outside: Uint8Array; // 1 for vertices that some surface has

  /** Decodes a surface; lists that are too short for its vertices are filled with zeros. */
  constructor(surface: SurfaceData) {
    this.rest = decodeF32(surface.rest);
    this.vertices = Math.min(surface.vertices, Math.floor(this.rest.length / 3));
    this.triangles = wholeTriangles(decodeU32(surface.triangles), this.vertices);
    this.fixed = fit(decodeU8(surface.fixed), new Uint8Array(this.vertices));
    this.instruments = surface.instruments;
    this.container = surface.container ?? null;
    this.isotherms = surface.isotherms ?? [];
    this.tissue = surface.tissue ?? "";
    this.regions = (surface.regions ?? []).map(({ name, triangles }) => ({
      name,
      triangles: wholeTriangles(decodeU32(triangles), this.vertices),
    }));
    let triangles = this.triangles;
    let regions: readonly Uint32Array[] = this.regions.map((region) => region.triangles);
    const firstRegions = regions;
    const regionsOf = (lists: readonly string[] | undefined): readonly Uint32Array[] =>
      lists ? this.regions.map((_, i) => wholeTriangles(decodeU32(lists[i] ?? ""), this.vertices)) : regions;
    let tets = surface.tets ? wholeCells(decodeU32(surface.tets), this.vertices, 4) : null;
    let kinds: Uint8Array | null = null;
    const kindsOf = (bytes: string | undefined, changed: boolean): Uint8Array | null => {
      if (!bytes) return changed ? null : kinds;
      return fit(decodeU8(bytes), new Uint8Array(triangles.length / 3));
    };
    const frames = surface.frames.map((frame) => ({
      time: frame.time_s,
      triangles: (triangles = frame.triangles ? wholeTriangles(decodeU32(frame.triangles), this.vertices) : triangles),
      regions: (regions = regionsOf(frame.regions)),
      tets: (tets = frame.tets ? wholeCells(decodeU32(frame.tets), this.vertices, 4) : tets),
      kinds: (kinds = kindsOf(frame.kinds, frame.triangles !== undefined)),
      instruments: frame.instruments,
      displacement: fit(decodeI16Scaled(frame.displacement, frame.displacement_scale_m), this.zeros(3)),
      intensity: fit(decodeU8Scaled(frame.intensity, frame.intensity_max), this.zeros(1)),
    }));
    this.recorded = frames.length > 0;
    const still = {
      time: 0,
      displacement: this.zeros(3),
      intensity: this.zeros(1),
      triangles: this.triangles,
      regions: firstRegions,
      tets,
      kinds: null,
      instruments: [],
    };
    this.frames = this.recorded ? frames : [still];
    this.data = surface.frames;
    this.outside = new Uint8Array(this.vertices);
    for (const frame of this.frames)
      for (const list of [frame.triangles, ...frame.regions]) for (const vertex of list) this.outside[vertex] = 1;
  }

  private zeros(components: number): Float32Array {
    return new Float32Array(components * this.vertices);
  }

  get start(): number {
    return this.frames[0]!.time;
  }

  get end(): number {
    return this.frames[this.frames.length - 1]!.time;
  }

  /** Neighbouring frames of a time and the share of the later one; a frame that brings another surface counts from its time. */
  at(time: number): { before: Frame; after: Frame; share: number } {
    const frames = this.frames;
    let index = frames.findIndex((frame) => frame.time > time);
    if (index < 0) index = frames.length - 1;
    const after = frames[index]!;
    const before = frames[Math.max(0, index - 1)]!;
    const span = after.time - before.time;
    let share = span > 0 ? Math.min(1, Math.max(0, (time - before.time) / span)) : 1;
    if (before.triangles !== after.triangles && share < 1) share = 0;
    return { before, after, share };
  }

  /** Writes positions (rest + exaggeration × displacement) and intensities at a time. */
  sample(time: number, exaggeration: number, positions: Float32Array, intensity: Float32Array): void {
    const { before, after, share } = this.at(time);
    for (let i = 0; i < positions.length; i++) {
      const u = before.displacement[i]! * (1 - share) + after.displacement[i]! * share;
      positions[i] = this.rest[i]! + exaggeration * u;
    }
    const [from, to] = [this.valuesOf(before), this.valuesOf(after)];
    for (let i = 0; i < intensity.length; i++) intensity[i] = from[i]! * (1 - share) + to[i]! * share;
  }

  /** The field at the vertices of a frame [SI]. */
  private valuesOf(frame: Frame, field = this.field): Float32Array {
    if (field === "intensity") return frame.intensity;
    const index = this.frames.indexOf(frame);
    const key = `${field} ${index}`;
    let values = this.read.get(key);
    if (!values) this.read.set(key, (values = this.decode(frame, this.data[index], field)));
    return values;
  }

  private decode(frame: Frame, data: FrameData | undefined, name: ColourName): Float32Array {
    const values = this.zeros(1);
    if (name === "displacement") {
      const u = frame.displacement;
      return values.map((_, i) => Math.hypot(u[3 * i]!, u[3 * i + 1]!, u[3 * i + 2]!));
    }
    const field = data?.fields?.[name];
    if (!field) return values;
    const bytes = decodeU8(field.values);
    const perStep = (field.high - field.low) / 255;
    return values.map((_, i) => field.low + (bytes[i] ?? 0) * perStep);
  }

  temperatureAt(time: number): Float32Array | null {
    const { before, after, share } = this.at(time);
    if (!this.data[this.frames.indexOf(after)]?.fields?.["temperature"]) return null;
    const [from, to] = [this.valuesOf(before, "temperature"), this.valuesOf(after, "temperature")];
    return from.map((value, i) => value * (1 - share) + to[i]! * share);
  }

  /** Between which numbers the field lies in all frames, 0 among them. @param whole  with what is inside, else at surfaces */
  span(whole: boolean): Span {
    const key = `${this.field} ${whole}`;
    let span = this.spans.get(key);
    if (!span) {
      span = this.frames.map((frame) => this.spanOf(frame, whole)).reduce(joined, { low: 0, high: 0 });
      this.spans.set(key, span);
    }
    return span;
  }

  /** The same at a time. */
  spanAt(time: number, whole: boolean): Span {
    const { before, after, share } = this.at(time);
    const [from, to] = [this.spanOf(before, whole), this.spanOf(after, whole)];
    const between = (a: number, b: number) => a * (1 - share) + b * share;
    return { low: between(from.low, to.low), high: between(from.high, to.high) };
  }

  private spanOf(frame: Frame, whole: boolean): Span {
    const values = this.valuesOf(frame);
    let [low, high] = [0, 0];
    for (let i = 0; i < values.length; i++) {
      if (!whole && this.outside[i] === 0) continue;
      low = Math.min(low, values[i]!);
      high = Math.max(high, values[i]!);
    }
    return { low, high };
  }

  /** Tets of the whole body at a time; null where its surfaces alone are known. */
  tetsAt(time: number): Uint32Array | null {
    const { before, after, share } = this.at(time);
    return share < 1 ? before.tets : after.tets;
  }

  /** The surface at a time. */
  trianglesAt(time: number): Uint32Array {
    const { before, after, share } = this.at(time);
    return share < 1 ? before.triangles : after.triangles;
  }

  /** What its triangles are at a time. */
  kindsAt(time: number): Uint8Array | null {
    const { before, after, share } = this.at(time);
    return share < 1 ? before.kinds : after.kinds;
  }

  /** Triangles of the inner regions at a time. */
  regionsAt(time: number): readonly Uint32Array[] {
    const { before, after, share } = this.at(time);
    return share < 1 ? before.regions : after.regions;
  }
}

export const joined = (a: Span, b: Span): Span => ({ low: Math.min(a.low, b.low), high: Math.max(a.high, b.high) });

const wholeTriangles = (indices: Uint32Array, vertices: number): Uint32Array => wholeCells(indices, vertices, 3);

/** Cells of `corners` corners each, all of which there are. */
function wholeCells(indices: Uint32Array, vertices: number, corners: number): Uint32Array {
  const kept: number[] = [];
  for (let i = 0; i + corners <= indices.length; i += corners) {
    const cell = indices.subarray(i, i + corners);
    if (cell.every((corner) => corner < vertices)) kept.push(...cell);
  }
  return Uint32Array.from(kept);
}

function fit<T extends Float32Array | Uint8Array>(values: T, room: T): T {
  room.set(values.subarray(0, room.length));
  return room;
}
