// live_surface.ts — the streamed surface as the 3D component wants it: always one frame, the newest.
import type { Frame, SurfaceMotion } from "../mesh3d/timeline.ts";
import type { InstrumentForm, VesselForm } from "../report_data.ts";
import type { Colouring } from "../mesh3d/fields.ts";
import { valuesOf } from "./colouring.ts";
import type { Keyframe, LiveFrame } from "./protocol.ts";

export class LiveSurface implements SurfaceMotion {
  readonly vertices: number;
  readonly triangles: Uint32Array;
  readonly rest: Float32Array;
  readonly fixed: Uint8Array;
  readonly end = 0;
  readonly isotherms = [];
  readonly tissue: string;
  readonly regions: readonly { name: string; triangles: Uint32Array }[];
  private readonly regionTriangles: readonly Uint32Array[];
  private readonly kinds: Uint8Array | null;
  private readonly newest: Frame;
  private readonly values: Float32Array;

  /** @param instruments  forms of the instruments @param sets  tools that come before them and have no form */
  constructor(
    keyframe: Keyframe,
    readonly instruments: readonly InstrumentForm[],
    private readonly sets: number,
    readonly container: VesselForm | null = null,
  ) {
    this.tissue = keyframe.tissue;
    this.regions = keyframe.regions;
    this.regionTriangles = keyframe.regions.map(({ triangles }) => triangles);
    this.kinds = keyframe.kinds;
    this.rest = keyframe.rest;
    this.vertices = keyframe.rest.length / 3;
    this.triangles = keyframe.triangles;
    this.values = new Float32Array(this.vertices);
    this.fixed = keyframe.marks;
    this.newest = {
      time: 0,
      displacement: new Float32Array(3 * this.vertices),
      intensity: new Float32Array(this.vertices),
      triangles: this.triangles,
      regions: this.regionTriangles,
      tets: keyframe.tets,
      kinds: this.kinds,
      instruments: [],
    };
  }

  temperatureAt(): null {
    return null;
  }

  get frames(): readonly Frame[] {
    return [this.newest];
  }

  /** @return between which numbers the colours lie; null: this frame does not have them */
  take(frame: LiveFrame, colouring: Colouring): { low: number; high: number } | null {
    const { displacement } = this.newest;
    const perUnit = frame.reach / 32767;
    for (let i = 0; i < displacement.length; i++) displacement[i] = (frame.displacement[i] ?? 0) * perUnit;
    this.newest.instruments = frame.tools.slice(this.sets).map(({ points, axes }) => ({ points, axes }));
    return valuesOf(colouring, frame, this.values);
  }

  /** Numbers become places on the scale, 0 … 1. */
  scale(low: number, high: number, down: boolean): void {
    const { intensity } = this.newest;
    const perUnit = high > low ? 1 / (high - low) : 0;
    for (let i = 0; i < intensity.length; i++) {
      const place = (this.values[i]! - low) * perUnit;
      intensity[i] = down ? 1 - place : place;
    }
  }

  at(): { before: Frame; after: Frame; share: number } {
    return { before: this.newest, after: this.newest, share: 1 };
  }

  sample(_time: number, exaggeration: number, positions: Float32Array, intensity: Float32Array): void {
    const { displacement } = this.newest;
    for (let i = 0; i < positions.length; i++) positions[i] = this.rest[i]! + exaggeration * displacement[i]!;
    intensity.set(this.newest.intensity);
  }

  trianglesAt(): Uint32Array {
    return this.triangles;
  }

  kindsAt(): Uint8Array | null {
    return this.kinds;
  }

  tetsAt(): Uint32Array | null {
    return this.newest.tets;
  }

  regionsAt(): readonly Uint32Array[] {
    return this.regionTriangles;
  }
}
