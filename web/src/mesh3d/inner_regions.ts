// inner_regions.ts — vessels, tumours and other regions inside a body: their surfaces, and their faces where it is cut open.
import * as THREE from "three";
import { ClipCap } from "./clip_cap.ts";
import { regionColours } from "./tissue_colours.ts";
import type { SurfaceMotion } from "./timeline.ts";

export class InnerRegions {
  readonly group = new THREE.Group();
  private readonly meshes: THREE.Mesh<THREE.BufferGeometry, THREE.MeshPhysicalMaterial>[] = [];
  private readonly caps: ClipCap[] = [];

  /** @param positions  of the surface's vertices, which move @param size  diagonal of the body [m] */
  constructor(timeline: SurfaceMotion, positions: THREE.BufferAttribute, middle: THREE.Vector3, size: number) {
    timeline.regions.forEach(({ name, triangles }, i) => {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", positions);
      geometry.setAttribute("normal", new THREE.BufferAttribute(new Float32Array(positions.array.length), 3));
      geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
      const { tissue, raw } = regionColours(name, i);
      const material = new THREE.MeshPhysicalMaterial({
        color: tissue,
        roughness: 0.55,
        clearcoat: 0.5,
        clearcoatRoughness: 0.3,
        side: THREE.DoubleSide,
      });
      const mesh = new THREE.Mesh(geometry, material);
      mesh.name = name;
      this.meshes.push(mesh);
      const cap = new ClipCap(geometry, middle, size, i + 1);
      cap.tissue = raw;
      cap.fine = false;
      this.caps.push(cap);
      this.group.add(mesh, cap.group);
    });
    this.group.visible = false;
  }

  /** @param coloured  the body is coloured by a field, its cap says nothing about tissue */
  show(on: boolean, coloured: boolean): void {
    this.group.visible = on && this.meshes.length > 0;
    for (const cap of this.caps) cap.hidden = coloured;
  }

  /** Normals of the moved surface; a region that a cut goes through has other triangles from then on. */
  update(triangles: readonly Uint32Array[]): void {
    this.meshes.forEach(({ geometry }, i) => {
      const now = triangles[i];
      if (now && geometry.index?.array !== now) geometry.setIndex(new THREE.BufferAttribute(now, 1));
    });
    if (!this.group.visible) return;
    for (const { geometry } of this.meshes) {
      geometry.computeVertexNormals();
      geometry.getAttribute("normal").needsUpdate = true;
    }
  }

  set plane(plane: THREE.Plane | null) {
    for (const { material } of this.meshes) material.clippingPlanes = plane ? [plane] : null;
    for (const cap of this.caps) cap.plane = plane;
  }

  dispose(): void {
    for (const { geometry, material } of this.meshes) {
      geometry.dispose();
      material.dispose();
    }
    for (const cap of this.caps) cap.dispose();
  }
}
