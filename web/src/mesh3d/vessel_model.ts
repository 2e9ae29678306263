// vessel_model.ts — the container about a body: its wall as thin glass, its floor and its rims as lines, open at the top.
import * as THREE from "three";
import type { VesselForm } from "../report_data.ts";

const AROUND = 96;
const GLASS = 0.14;
const LINE = 0.7;

/** Corners of a horizontal rim about the origin: a circle, or a rectangle. */
export function rimOf(form: VesselForm): [number, number][] {
  if (form.kind === "box") {
    const [x, y] = [(form.width_m ?? 0) / 2, (form.length_m ?? 0) / 2];
    return [
      [-x, -y],
      [x, -y],
      [x, y],
      [-x, y],
    ];
  }
  const radius = form.radius_m ?? 0;
  return Array.from({ length: AROUND }, (_, i) => {
    const angle = (2 * Math.PI * i) / AROUND;
    return [radius * Math.cos(angle), radius * Math.sin(angle)];
  });
}

export class VesselModel {
  readonly group = new THREE.Group();
  private readonly glass = new THREE.MeshBasicMaterial({
    transparent: true,
    opacity: GLASS,
    side: THREE.DoubleSide,
    depthWrite: false,
  });
  private readonly line = new THREE.LineBasicMaterial({ transparent: true, opacity: LINE });
  private readonly geometries: THREE.BufferGeometry[] = [];

  constructor(form: VesselForm) {
    const rim = rimOf(form);
    const ring = (z: number) => [...rim, rim[0]!].map(([x, y]) => new THREE.Vector3(x, y, z));
    const [low, high] = [ring(0), ring(form.height_m)];
    const wall: number[] = [];
    for (let i = 0; i < rim.length; i++)
      for (const corner of [low[i]!, low[i + 1]!, high[i + 1]!, low[i]!, high[i + 1]!, high[i]!]) wall.push(...corner);
    const floor: number[] = [];
    for (let i = 0; i < rim.length; i++)
      for (const corner of [new THREE.Vector3(), low[i]!, low[i + 1]!]) floor.push(...corner);
    this.group.add(this.sheet(wall), this.sheet(floor), this.outline(low), this.outline(high));
    if (form.kind === "box") for (let i = 0; i < 4; i++) this.group.add(this.outline([low[i]!, high[i]!]));
    this.place(form);
  }

  private sheet(points: number[]): THREE.Mesh {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
    this.geometries.push(geometry);
    const mesh = new THREE.Mesh(geometry, this.glass);
    mesh.renderOrder = 6; // after the tissue that is seen through it
    return mesh;
  }

  private outline(points: THREE.Vector3[]): THREE.Line {
    const geometry = new THREE.BufferGeometry().setFromPoints(points);
    this.geometries.push(geometry);
    const line = new THREE.Line(geometry, this.line);
    line.renderOrder = 7;
    return line;
  }

  private place({ axes: a, origin }: VesselForm): void {
    if (a.length === 9) {
      const turn = new THREE.Matrix4().set(
        a[0]!,
        a[1]!,
        a[2]!,
        0,
        a[3]!,
        a[4]!,
        a[5]!,
        0,
        a[6]!,
        a[7]!,
        a[8]!,
        0,
        0,
        0,
        0,
        1,
      );
      this.group.quaternion.setFromRotationMatrix(turn);
    }
    this.group.position.fromArray(origin.length === 3 ? origin : [0, 0, 0]);
  }

  set colour(colour: string) {
    this.glass.color.set(colour);
    this.line.color.set(colour);
  }

  dispose(): void {
    for (const geometry of this.geometries) geometry.dispose();
    this.glass.dispose();
    this.line.dispose();
  }
}
