// field_cap.ts — the face of a body that is cut open, with the field on it: where the plane meets the tets.
import * as THREE from "three";
import { colourTexels } from "./colour_map.ts";
import { levelSurface } from "./level_surface.ts";
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
  const { from, to, shares, triangles } = levelSurface(heights, tets);
  for (const corner of triangles) {
    const [a, b, share] = [from[corner]!, to[corner]!, shares[corner]!];
    for (let k = 0; k < 3; k++)
      section.points.push(positions[3 * a + k]! + share * (positions[3 * b + k]! - positions[3 * a + k]!));
    section.values.push(values[a]! + share * (values[b]! - values[a]!));
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
