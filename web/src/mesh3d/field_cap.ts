// field_cap.ts — the face of a body that is cut open, with the field on it: where the plane meets the tets.
//
//   a tet with one corner on one side: a triangle      two and two: a quadrilateral, drawn as two
//
// Corners of the face lie on edges of tets; place and value go along an edge in proportion to the distance from the plane.
import * as THREE from "three";
import { colourTexels } from "./colour_map.ts";
import { lookupOf } from "./tissue_material.ts";

const TEXELS = 256;

/** Corners of the face, three a triangle: places xyz, and the value at each. */
export interface Section {
  points: number[];
  values: number[];
}

/**
 * Where a plane meets tets.
 * @param positions  xyz of each vertex @param values  at each vertex @param tets  four vertices each
 */
export function sectionOf(
  plane: THREE.Plane,
  positions: ArrayLike<number>,
  values: ArrayLike<number>,
  tets: ArrayLike<number>,
): Section {
  const { normal, constant } = plane;
  const heights = new Float64Array(values.length);
  for (let v = 0; v < heights.length; v++)
    heights[v] =
      normal.x * positions[3 * v]! + normal.y * positions[3 * v + 1]! + normal.z * positions[3 * v + 2]! + constant;
  const section: Section = { points: [], values: [] };
  const corner = (a: number, b: number) => {
    const share = heights[a]! / (heights[a]! - heights[b]!);
    for (let k = 0; k < 3; k++)
      section.points.push(positions[3 * a + k]! + share * (positions[3 * b + k]! - positions[3 * a + k]!));
    section.values.push(values[a]! + share * (values[b]! - values[a]!));
  };
  const [above, below]: [number[], number[]] = [[], []];
  for (let t = 0; t + 4 <= tets.length; t += 4) {
    above.length = below.length = 0;
    for (let k = 0; k < 4; k++) (heights[tets[t + k]!]! >= 0 ? above : below).push(tets[t + k]!);
    if (above.length === 0 || below.length === 0) continue;
    if (above.length === 2) {
      const [a, b] = above as [number, number];
      const [c, d] = below as [number, number];
      for (const [from, to] of [
        [a, c],
        [a, d],
        [b, d],
        [a, c],
        [b, d],
        [b, c],
      ] as const)
        corner(from, to);
    } else {
      const [one, others] = above.length === 1 ? [above[0]!, below] : [below[0]!, above];
      for (const other of others) corner(one, other);
    }
  }
  return section;
}

export class FieldCap {
  readonly mesh: THREE.Mesh;
  private readonly texture: THREE.DataTexture;
  private readonly material: THREE.MeshBasicMaterial;

  constructor() {
    this.texture = new THREE.DataTexture(colourTexels(TEXELS), TEXELS, 1);
    this.texture.colorSpace = THREE.SRGBColorSpace;
    this.texture.minFilter = this.texture.magFilter = THREE.LinearFilter;
    this.texture.needsUpdate = true;
    this.material = new THREE.MeshBasicMaterial({ map: this.texture, side: THREE.DoubleSide });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), this.material);
    this.mesh.frustumCulled = this.mesh.visible = false;
  }

  /** @param shares  of the scale, of each vertex, 0 … 1; null plane: the body is whole */
  show(plane: THREE.Plane | null, positions: Float32Array, shares: Float32Array, tets: Uint32Array): void {
    this.mesh.visible = plane !== null;
    if (!plane) return;
    const { points, values } = sectionOf(plane, positions, shares, tets);
    const lookup = new Float32Array(2 * values.length);
    values.forEach((value, i) => lookup.set([lookupOf(value), 0.5], 2 * i));
    this.mesh.geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(points), 3));
    geometry.setAttribute("uv", new THREE.BufferAttribute(lookup, 2));
    this.mesh.geometry = geometry;
  }

  hide(): void {
    this.mesh.visible = false;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.material.dispose();
    this.texture.dispose();
  }
}
