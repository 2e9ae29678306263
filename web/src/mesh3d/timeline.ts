// timeline.ts — the recorded frames of a surface as one motion: shape and equivalent shear strain at any time between them.
import { decodeF32, decodeI16Scaled, decodeU32, decodeU8, decodeU8Scaled } from "../data/decode.ts";
import type { InstrumentForm, InstrumentPlace, SurfaceData } from "../report_data.ts";

export interface Frame {
  time: number; // [s]
  displacement: Float32Array; // xyz per vertex [m]
  intensity: Float32Array; // per vertex [-]
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
  readonly tissue: string; // name of what most of the body is; empty where it is not said
  readonly regions: readonly { name: string; triangles: Uint32Array }[]; // closed surfaces inside the body
  readonly end: number; // time of the last frame [s]
  at(time: number): { before: Frame; after: Frame; share: number };
  sample(time: number, exaggeration: number, positions: Float32Array, intensity: Float32Array): void;
  trianglesAt(time: number): Uint32Array;
  kindsAt(time: number): Uint8Array | null;
  regionsAt(time: number): readonly Uint32Array[];
}

export class Timeline implements SurfaceMotion {
  readonly vertices: number;
  readonly triangles: Uint32Array;
  readonly rest: Float32Array;
  readonly fixed: Uint8Array;
  readonly frames: readonly Frame[];
  readonly instruments: readonly InstrumentForm[];
  readonly tissue: string;
  readonly regions: readonly { name: string; triangles: Uint32Array }[];
  readonly recorded: boolean; // false: no frames, rest shape only
  readonly intensityMax: number;

  /** Decodes a surface; lists that are too short for its vertices are filled with zeros. */
  constructor(surface: SurfaceData) {
    this.rest = decodeF32(surface.rest);
    this.vertices = Math.min(surface.vertices, Math.floor(this.rest.length / 3));
    this.triangles = wholeTriangles(decodeU32(surface.triangles), this.vertices);
    this.fixed = fit(decodeU8(surface.fixed), new Uint8Array(this.vertices));
    this.instruments = surface.instruments;
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
    let kinds: Uint8Array | null = null;
    const kindsOf = (bytes: string | undefined, changed: boolean): Uint8Array | null => {
      if (!bytes) return changed ? null : kinds;
      return fit(decodeU8(bytes), new Uint8Array(triangles.length / 3));
    };
    const frames = surface.frames.map((frame) => ({
      time: frame.time_s,
      triangles: (triangles = frame.triangles ? wholeTriangles(decodeU32(frame.triangles), this.vertices) : triangles),
      regions: (regions = regionsOf(frame.regions)),
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
      kinds: null,
      instruments: [],
    };
    this.frames = this.recorded ? frames : [still];
    this.intensityMax = Math.max(0, ...surface.frames.map((frame) => frame.intensity_max));
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
    for (let i = 0; i < intensity.length; i++) {
      intensity[i] = before.intensity[i]! * (1 - share) + after.intensity[i]! * share;
    }
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

  /** Largest intensity shown at a time. */
  intensityAt(time: number): number {
    const { before, after, share } = this.at(time);
    const largest = (values: Float32Array) => values.reduce((most, value) => Math.max(most, value), 0);
    return largest(before.intensity) * (1 - share) + largest(after.intensity) * share;
  }
}

function wholeTriangles(indices: Uint32Array, vertices: number): Uint32Array {
  const kept: number[] = [];
  for (let i = 0; i + 2 < indices.length; i += 3) {
    const corners = [indices[i]!, indices[i + 1]!, indices[i + 2]!];
    if (corners.every((corner) => corner < vertices)) kept.push(...corners);
  }
  return Uint32Array.from(kept);
}

function fit<T extends Float32Array | Uint8Array>(values: T, room: T): T {
  room.set(values.subarray(0, room.length));
  return room;
}
