// isotherms.ts — nested isotherms within a body, each a translucent surface that grows and shrinks with the temperature.
import * as THREE from "three";
import type { IsothermData } from "../report_data.ts";
import { levelSurface, turnDownhill } from "./level_surface.ts";

const BODY_TEMPERATURE = 37; // °C; isotherms above it are of heat, those below of cold
const COLD = ["#a8dcff", "#4f9bff", "#3b4fd8", "#2a1f8f"]; // from the warmest on
const HOT = ["#ffd27a", "#ff9a3d", "#e8452c", "#9c1022"]; // from the coolest on
const OPACITY = 0.34;

/** What is drawn of an isotherm. */
export interface DrawnIsotherm {
  temperature: number; // °C
  label: string; // "0 °C (ice)"
  colour: string;
}

/** Colours by how far an isotherm is from the body's temperature, among those on its side of it; the nearest first. */
export function drawnIsotherms(isotherms: readonly IsothermData[]): DrawnIsotherm[] {
  const of = (temperature: number) => temperature > BODY_TEMPERATURE;
  const distance = ({ temperature_C }: IsothermData) => Math.abs(temperature_C - BODY_TEMPERATURE);
  const sorted = [...isotherms].sort((a, b) => distance(a) - distance(b));
  const one = sorted.filter(({ temperature_C: t }, i) => sorted.findIndex((o) => o.temperature_C === t) === i);
  return one.map((each) => {
    const hot = of(each.temperature_C);
    const colours = hot ? HOT : COLD;
    const rank = one.filter((other) => of(other.temperature_C) === hot).indexOf(each);
    const number = String(each.temperature_C).replace("-", "\u2212");
    return {
      temperature: each.temperature_C,
      label: `${number} °C` + (each.name === "" ? "" : ` (${each.name})`),
      colour: colours[Math.min(rank, colours.length - 1)]!,
    };
  });
}

export class Isotherms {
  readonly group = new THREE.Group();
  private readonly meshes: THREE.Mesh<THREE.BufferGeometry, THREE.MeshLambertMaterial>[];
  private heights = new Float32Array(0);

  constructor(private readonly drawn: readonly DrawnIsotherm[]) {
    this.meshes = drawn.map(({ colour }, i) => {
      const material = new THREE.MeshLambertMaterial({
        color: colour,
        emissive: colour,
        emissiveIntensity: 0.25,
        transparent: true,
        opacity: OPACITY,
        side: THREE.DoubleSide,
        depthWrite: false,
      });
      const mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
      mesh.frustumCulled = false;
      mesh.renderOrder = 5 - i / drawn.length; // the innermost first
      this.group.add(mesh);
      return mesh;
    });
  }

  /** @param temperature  at each vertex [°C] @param tets  four vertices each */
  update(positions: Float32Array, temperature: Float32Array, tets: Uint32Array): void {
    if (!this.group.visible) return;
    if (this.heights.length !== temperature.length) this.heights = new Float32Array(temperature.length);
    this.drawn.forEach(({ temperature: level }, i) => {
      for (let v = 0; v < temperature.length; v++) this.heights[v] = temperature[v]! - level;
      const surface = levelSurface(this.heights, tets);
      const points = new Float32Array(3 * surface.from.length);
      surface.shares.forEach((share, corner) => {
        const [a, b] = [3 * surface.from[corner]!, 3 * surface.to[corner]!];
        for (let k = 0; k < 3; k++)
          points[3 * corner + k] = positions[a + k]! + share * (positions[b + k]! - positions[a + k]!);
      });
      turnDownhill(surface, points, positions);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
      geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(surface.triangles), 1));
      geometry.computeVertexNormals();
      this.meshes[i]!.geometry.dispose();
      this.meshes[i]!.geometry = geometry;
    });
  }

  set plane(plane: THREE.Plane | null) {
    for (const { material } of this.meshes) material.clippingPlanes = plane ? [plane] : null;
  }

  dispose(): void {
    for (const { geometry, material } of this.meshes) {
      geometry.dispose();
      material.dispose();
    }
  }
}
