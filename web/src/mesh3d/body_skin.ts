// body_skin.ts — the three.js object of a body's surface as it is drawn, and its wireframe, made anew where it is cut.
import * as THREE from "three";
import { DisplaySurface, MOST_SUBDIVIDED, MOST_SUBDIVIDED_PLAIN } from "./display_surface.ts";
import { mottles } from "./mottle.ts";
import { directionsFor, skyShare } from "./occlusion.ts";
import type { Tint } from "./tissue_colours.ts";
import { lookupOf, type TissueMaterial } from "./tissue_material.ts";

/** Triangles times directions that the shade may cost: some 100 ms. A surface that came by a cut gets less. */
const EFFORT = { first: 400_000, again: 80_000 };
/** How raw a triangle of each kind is: skin, cut, skin under a capsule that has torn. */
const RAW = [0, 1, 0.8];

export class BodySkin {
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, TissueMaterial>;
  readonly edges: THREE.LineSegments;
  private surface!: DisplaySurface;
  private shares: Float32Array | null = null; // of the scale, of each display vertex

  /** @param rest  of the coarse vertices @param colourOf  of each of these triangles @param fine  a larger surface is rounded, too */
  constructor(
    private readonly rest: Float32Array,
    private readonly colourOf: (triangles: Uint32Array) => (triangle: number) => Tint,
    material: TissueMaterial,
    line: THREE.LineBasicMaterial,
    public fine = true,
    private time: "first" | "again" = "first",
  ) {
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.edges = new THREE.LineSegments(new THREE.BufferGeometry(), line);
  }

  /** Another surface on the same vertices. @param kind  of each triangle: 0 skin, 1 a face that was cut, 2 torn */
  build(triangles: Uint32Array, kind: Uint8Array | null): void {
    const most = this.fine ? MOST_SUBDIVIDED : MOST_SUBDIVIDED_PLAIN;
    const surface = new DisplaySurface(this.rest, triangles, kind, triangles.length / 3 <= most);
    this.surface = surface;
    const geometry = new THREE.BufferGeometry();
    const set = (name: string, values: Float32Array, components: number) => {
      const attribute = new THREE.BufferAttribute(values, components);
      geometry.setAttribute(name, attribute);
      return attribute;
    };
    for (const name of ["position", "normal"] as const)
      set(name, name === "position" ? surface.positions : surface.normals, 3).setUsage(THREE.DynamicDrawUsage);
    set("hollow", surface.hollow, 1).setUsage(THREE.DynamicDrawUsage);
    set("rest", surface.positions.slice(), 3);
    set("sky", this.shade(surface), 1);
    set("raw", rawness(surface, kind), 1);
    set("mottle", mottles(surface.positions, this.mesh.material.size), 1);
    set("tint", tints(surface, this.colourOf(triangles)), 3);
    this.shares = new Float32Array(surface.count);
    set("value", this.shares, 1).setUsage(THREE.DynamicDrawUsage);
    geometry.setIndex(new THREE.BufferAttribute(surface.triangles, 1));
    const lines = new THREE.BufferGeometry();
    lines.setAttribute("position", geometry.getAttribute("position"));
    lines.setIndex(new THREE.BufferAttribute(surface.lines, 1));
    this.dispose();
    this.mesh.geometry = geometry;
    this.edges.geometry = lines;
  }

  private shade(surface: DisplaySurface): Float32Array {
    const sky = new Float32Array(surface.count);
    if (this.shaded?.triangles === surface.coarse) sky.set(this.shaded.sky);
    else this.bake(surface, sky);
    surface.fillMiddles(sky);
    return sky;
  }

  private shaded: { triangles: Uint32Array; sky: Float32Array } | null = null;

  private bake(surface: DisplaySurface, sky: Float32Array): void {
    const wedges = surface.wedges;
    const [points, normals] = [surface.positions, surface.normals].map((all) => all.subarray(0, 3 * wedges.count));
    const directions = directionsFor(wedges.ofCorner.length / 3, EFFORT[this.time]);
    this.time = "again";
    const share = skyShare(points!, normals!, wedges.ofCorner, directions);
    sky.set(share);
    this.shaded = { triangles: surface.coarse, sky: share };
  }

  /** Follows the coarse vertices. @param shares  of the scale, of each coarse vertex, 0 … 1 */
  update(points: Float32Array, shares: Float32Array): void {
    this.surface.update(points);
    const lookup = this.shares!;
    this.surface.spread(shares, lookup);
    for (let i = 0; i < lookup.length; i++) lookup[i] = lookupOf(lookup[i]!);
    for (const name of ["position", "normal", "hollow", "value"])
      this.mesh.geometry.getAttribute(name).needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.edges.geometry.dispose();
  }
}

/** Mean colour of the triangles around each display vertex. */
function tints(surface: DisplaySurface, of: (triangle: number) => Tint): Float32Array {
  const sum = new Float32Array(3 * surface.count);
  const count = new Float32Array(surface.count);
  const times = surface.subdivide ? 4 : 1;
  for (let c = 0; c < surface.triangles.length; c++) {
    const v = surface.triangles[c]!;
    const colour = of(Math.floor(c / (3 * times)));
    for (let k = 0; k < 3; k++) sum[3 * v + k] = sum[3 * v + k]! + colour[k]!;
    count[v] = count[v]! + 1;
  }
  return sum.map((total, i) => total / (count[Math.floor(i / 3)]! || 1));
}

/** Of each display vertex: 1 on faces that were cut, 0 on skin. */
function rawness(surface: DisplaySurface, kind: Uint8Array | null): Float32Array {
  const raw = new Float32Array(surface.count);
  if (!kind) return raw;
  const times = surface.subdivide ? 4 : 1;
  for (let t = 0; t < kind.length; t++) {
    const value = RAW[kind[t]!] ?? 0;
    for (let c = 3 * times * t; value > 0 && c < 3 * times * (t + 1); c++) raw[surface.triangles[c]!] = value;
  }
  return raw;
}
