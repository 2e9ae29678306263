// instrument_model.ts — the three.js objects of the instruments of one surface, moved with its frames.
import * as THREE from "three";
import type { InstrumentForm, InstrumentPlace } from "../report_data.ts";
import { placeBetween, tubePositions, tubeTriangles } from "./instrument_shape.ts";
import type { NearTool } from "./tissue_material.ts";
import type { SurfaceMotion } from "./timeline.ts";

const SIDES = 16;
/** A shaft longer than this share of the body's size is drawn no longer: it would only lead out of the picture. */
const LONGEST = 0.6;

export class InstrumentModel {
  readonly group = new THREE.Group();
  private readonly material = new THREE.MeshStandardMaterial({
    metalness: 0.1,
    roughness: 0.45,
    side: THREE.DoubleSide,
  });
  private readonly glass = new THREE.MeshLambertMaterial({ transparent: true, opacity: 0.25, side: THREE.DoubleSide });
  private readonly meshes: THREE.Mesh[];

  /** @param size  diagonal of the body [m] */
  constructor(
    private readonly timeline: SurfaceMotion,
    private readonly size: number,
  ) {
    this.meshes = timeline.instruments.map((form) => this.mesh(form));
    for (const mesh of this.meshes) {
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
  }

  get count(): number {
    return this.meshes.length;
  }

  private mesh(form: InstrumentForm): THREE.Mesh {
    const see = form.kind === "plate" || form.kind === "wall" ? this.glass : this.material;
    return new THREE.Mesh(this.geometry(form), see);
  }

  /** A shape along its own z axis, from its tip up. Needles follow their line and get theirs with each frame. */
  private geometry(form: InstrumentForm): THREE.BufferGeometry {
    const { radius_m: radius } = form;
    const length = Math.min(form.length_m, LONGEST * this.size);
    const upright = (geometry: THREE.BufferGeometry, z: number) => geometry.rotateX(Math.PI / 2).translate(0, 0, z);
    switch (form.kind) {
      case "punch":
        return upright(new THREE.CylinderGeometry(radius, radius, length, 2 * SIDES), length / 2);
      case "probe":
        return upright(
          new THREE.CylinderGeometry(radius, radius, length - form.tip_m, SIDES),
          form.tip_m + (length - form.tip_m) / 2,
        );
      case "ball":
        return new THREE.SphereGeometry(radius, 2 * SIDES, SIDES).translate(0, 0, radius);
      case "plate":
        return new THREE.CircleGeometry(LONGEST * this.size, 3 * SIDES);
      case "wall":
        return upright(new THREE.CylinderGeometry(radius, radius, this.size, 3 * SIDES, 1, true), 0);
      case "block": {
        const [x, y, z] = [form.size_m[0] ?? 0, form.size_m[1] ?? 0, form.size_m[2] ?? 0];
        return new THREE.BoxGeometry(x, y, z).translate(0, 0, z / 2);
      }
      case "blade":
        return bladeGeometry(form.size_m, 0.4 * this.size);
      default:
        return new THREE.BufferGeometry();
    }
  }

  update(time: number): void {
    const { before, after, share } = this.timeline.at(time);
    this.meshes.forEach((mesh, i) => {
      const [from, to] = [before.instruments[i], after.instruments[i]];
      mesh.visible = from !== undefined && to !== undefined;
      if (!from || !to) return;
      const place = (this.places[i] = placeBetween(from, to, share));
      if (this.timeline.instruments[i]!.kind === "needle")
        this.bend(mesh, place, this.timeline.instruments[i]!.radius_m);
      else move(mesh, place);
    });
  }

  private bend(mesh: THREE.Mesh, place: InstrumentPlace, radius: number): void {
    const positions = tubePositions(lastPart(place.points, LONGEST * this.size), radius, SIDES);
    const old = mesh.geometry.getAttribute("position");
    if (!old || old.array.length !== positions.length) {
      mesh.geometry.dispose();
      mesh.geometry = new THREE.BufferGeometry();
      mesh.geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
      mesh.geometry.setIndex(new THREE.BufferAttribute(tubeTriangles(positions.length / 3 / SIDES, SIDES), 1));
    } else {
      (old.array as Float32Array).set(positions);
      old.needsUpdate = true;
    }
    mesh.geometry.computeVertexNormals();
  }

  /** Where an instrument's tip is; null where there is none. */
  tip(instrument: number, time: number): THREE.Vector3 | null {
    const { before, after, share } = this.timeline.at(time);
    const [from, to] = [before.instruments[instrument], after.instruments[instrument]];
    if (!from || !to) return null;
    const point = placeBetween(from, to, share).points.slice(-3);
    return point.length === 3 ? new THREE.Vector3(...(point as [number, number, number])) : null;
  }

  /** What takes light of the tissue: a capsule about each instrument that has a radius. */
  near(): NearTool[] {
    const found: NearTool[] = [];
    this.meshes.forEach((mesh, i) => {
      const form = this.timeline.instruments[i]!;
      const place = mesh.visible ? this.places[i] : undefined;
      if (!place || !(form.radius_m > 0) || form.kind === "wall" || form.kind === "plate") return;
      const tool = capsuleOf(form, place, LONGEST * this.size);
      if (tool) found.push(tool);
    });
    return found;
  }

  private readonly places: InstrumentPlace[] = [];

  colour(tool: string): void {
    this.material.color.set(tool);
    this.glass.color.set(tool);
  }

  dispose(): void {
    for (const mesh of this.meshes) mesh.geometry.dispose();
    this.material.dispose();
    this.glass.dispose();
  }
}

/** A sheet that stands on its edge. */
function bladeGeometry(ends: readonly number[], height: number): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  if (ends.length < 6) return geometry;
  const [a, b] = [ends.slice(0, 3), ends.slice(3, 6)];
  const up = (p: readonly number[]) => [p[0]!, p[1]!, p[2]! + height];
  geometry.setAttribute("position", new THREE.Float32BufferAttribute([...a, ...b, ...up(b), ...up(a)], 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  geometry.computeVertexNormals();
  return geometry;
}

/** From the tip along the instrument's own z axis, or along the end of a needle. */
function capsuleOf(form: InstrumentForm, place: InstrumentPlace, longest: number): NearTool | null {
  const points = form.kind === "needle" ? lastPart(place.points, longest) : place.points;
  const tip = points.slice(-3);
  if (tip.length < 3) return null;
  const triple = (p: readonly number[]): [number, number, number] => [p[0]!, p[1]!, p[2]!];
  if (form.kind === "needle") return { from: triple(points), to: triple(tip), radius: form.radius_m };
  const axis = [place.axes[2] ?? 0, place.axes[5] ?? 0, place.axes[8] ?? 1];
  const along = (length: number) => triple(tip.map((x, k) => x + length * axis[k]!));
  const length = Math.min(form.length_m, longest);
  return { from: along(form.radius_m), to: along(Math.max(length, form.radius_m)), radius: form.radius_m };
}

function move(mesh: THREE.Mesh, place: InstrumentPlace): void {
  const a = place.axes;
  const [x, y, z] = [place.points[0] ?? 0, place.points[1] ?? 0, place.points[2] ?? 0];
  mesh.matrixAutoUpdate = false;
  if (a.length < 9) mesh.matrix.makeTranslation(x, y, z);
  else mesh.matrix.set(a[0]!, a[1]!, a[2]!, x, a[3]!, a[4]!, a[5]!, y, a[6]!, a[7]!, a[8]!, z, 0, 0, 0, 1);
  mesh.matrixWorldNeedsUpdate = true;
}

/** The end of a polyline, at most `length` of it, cut off straight at its beginning. */
function lastPart(points: readonly number[], length: number): number[] {
  let left = length;
  for (let i = points.length - 3; i >= 3; i -= 3) {
    const step = Math.hypot(
      points[i]! - points[i - 3]!,
      points[i + 1]! - points[i - 2]!,
      points[i + 2]! - points[i - 1]!,
    );
    if (step >= left) {
      const share = left / step;
      const cut = [0, 1, 2].map((n) => points[i + n]! * (1 - share) + points[i - 3 + n]! * share);
      return [...cut, ...points.slice(i)];
    }
    left -= step;
  }
  return [...points];
}
