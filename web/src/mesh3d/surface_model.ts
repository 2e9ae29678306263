// surface_model.ts — the three.js objects of one surface: skin, edges, rest ghost, marked vertices.
//
//   positions (one buffer) ─┬─ skin: triangles, coloured by equivalent shear strain through a 1D texture
//                           ├─ edges
//                           └─ held and driven vertices
//                           ├─ cap: closes the skin where it is cut open
//   rest positions ─────────── ghost: faint skin and its creases
import * as THREE from "three";
import type { ClipBody } from "./clip.ts";
import { ClipCap } from "./clip_cap.ts";
import { colourTexels } from "./colour_map.ts";
import { uniqueEdges } from "./edges.ts";
import { InstrumentModel } from "./instrument_model.ts";
import { markTexture } from "./mark_texture.ts";
import type { SurfaceMotion } from "./timeline.ts";

const TEXELS = 256;
const CREASE_DEGREES = 28;
/** Above this many edges the wireframe would be a solid tint. */
const MANY_EDGES = 30_000;
/** Marks are drawn this share of the mesh's size nearer, or the skin beside a vertex would cut its sign. */
const MARK_LIFT = 0.03;
const MANY_MARKS = 40;
const MARK_PIXELS = { square: 9, disc: 12 };

export interface ModelColours {
  edge: string;
  ghost: string;
  held: string;
  driven: string;
  instrument: string;
  cap: string;
}

export class SurfaceModel {
  readonly group = new THREE.Group();
  readonly edgesByDefault: boolean;
  readonly heldCount: number;
  readonly drivenCount: number;
  private readonly positions: THREE.BufferAttribute;
  private readonly lookup: THREE.BufferAttribute; // texture coordinates: (intensity / range, ½)
  private readonly intensity: Float32Array;
  private readonly edgeMaterial = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.35 });
  private readonly ghostLine = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.7, depthWrite: false });
  private readonly ghostSkin = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.08, depthWrite: false });
  private readonly box: THREE.Box3; // of the rest shape
  private readonly size: number; // its diagonal [m]
  private readonly held: THREE.Points;
  private readonly driven: THREE.Points;
  private readonly hiddenDriven: THREE.Points;
  private readonly edges: THREE.LineSegments;
  private readonly ghost = new THREE.Group();
  private readonly disposables: { dispose(): void }[] = [];
  readonly skin: THREE.Mesh;
  private readonly skinGeometry: THREE.BufferGeometry;
  private readonly instruments: InstrumentModel;
  private readonly cap: ClipCap;
  private shown: Uint32Array; // triangles of the skin now

  constructor(readonly timeline: SurfaceMotion) {
    this.shown = timeline.triangles;
    this.box = new THREE.Box3().setFromArray(timeline.rest);
    this.size = this.box.getSize(new THREE.Vector3()).length();
    this.positions = new THREE.BufferAttribute(timeline.rest.slice(0, 3 * timeline.vertices), 3);
    this.positions.setUsage(THREE.DynamicDrawUsage);
    this.lookup = new THREE.BufferAttribute(new Float32Array(2 * timeline.vertices).fill(0.5), 2);
    this.intensity = new Float32Array(timeline.vertices);
    const edgeIndex = uniqueEdges(timeline.triangles, timeline.vertices);
    this.edgesByDefault = edgeIndex.length / 2 <= MANY_EDGES;
    this.edges = new THREE.LineSegments(this.shared(edgeIndex), this.edgeMaterial);
    this.held = this.points(1, "square");
    this.driven = this.points(2, "disc");
    this.hiddenDriven = this.seenThrough(this.driven);
    this.heldCount = this.held.geometry.index?.count ?? 0;
    this.drivenCount = this.driven.geometry.index?.count ?? 0;
    this.skin = this.makeSkin();
    this.skinGeometry = this.skin.geometry;
    this.instruments = new InstrumentModel(timeline, this.size);
    this.cap = new ClipCap(this.skinGeometry, this.box.getCenter(new THREE.Vector3()), this.size);
    this.group.add(
      this.skin,
      this.cap.group,
      this.edges,
      this.held,
      this.hiddenDriven,
      this.driven,
      this.ghost,
      this.instruments.group,
    );
    this.group.traverse((object) => (object.frustumCulled = false));
    this.disposables.push(this.instruments, this.cap, this.edgeMaterial, this.ghostLine, this.ghostSkin);
  }

  private keep<T extends { dispose(): void }>(thing: T): T {
    this.disposables.push(thing);
    return thing;
  }

  /** Geometry on the common positions. */
  private shared(index: Uint32Array): THREE.BufferGeometry {
    const geometry = this.keep(new THREE.BufferGeometry());
    geometry.setAttribute("position", this.positions);
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    return geometry;
  }

  private makeSkin(): THREE.Mesh {
    const texture = this.keep(new THREE.DataTexture(colourTexels(TEXELS), TEXELS, 1));
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    const material = this.keep(
      new THREE.MeshLambertMaterial({
        map: texture,
        flatShading: true,
        side: THREE.DoubleSide,
        polygonOffset: true,
        polygonOffsetFactor: 1,
        polygonOffsetUnits: 1,
      }),
    );
    const geometry = this.shared(this.timeline.triangles);
    geometry.setAttribute("uv", this.lookup);
    return new THREE.Mesh(geometry, material);
  }

  private points(kind: number, shape: "square" | "disc"): THREE.Points {
    const index: number[] = [];
    this.timeline.fixed.forEach((value, vertex) => value === kind && index.push(vertex));
    const map = this.keep(markTexture(shape));
    const material = this.keep(
      new THREE.PointsMaterial({
        size: index.length > MANY_MARKS ? 7 : MARK_PIXELS[shape],
        sizeAttenuation: false,
        map,
        transparent: true,
        alphaTest: 0.3,
      }),
    );
    material.onBeforeCompile = (shader) => bringForward(shader, MARK_LIFT * this.size);
    return new THREE.Points(this.shared(Uint32Array.from(index)), material);
  }

  /** The driven vertices once more, faint and through the mesh: where the tool acts must not be lost in a dent. */
  private seenThrough(points: THREE.Points): THREE.Points {
    const material = this.keep((points.material as THREE.PointsMaterial).clone());
    material.depthTest = false;
    material.opacity = 0.4;
    material.alphaTest = 0.1;
    return new THREE.Points(points.geometry, material);
  }

  private buildGhost(): void {
    const rest = this.keep(new THREE.BufferGeometry());
    rest.setAttribute(
      "position",
      new THREE.BufferAttribute(this.timeline.rest.slice(0, 3 * this.timeline.vertices), 3),
    );
    rest.setIndex(new THREE.BufferAttribute(this.timeline.triangles, 1));
    const creases = this.keep(new THREE.EdgesGeometry(rest, CREASE_DEGREES));
    this.ghost.add(new THREE.Mesh(rest, this.ghostSkin), new THREE.LineSegments(creases, this.ghostLine));
    this.ghost.visible = false;
  }

  /** Shape and colours at a time [s]; colours reach their end at `range`. */
  update(time: number, exaggeration: number, range: number): void {
    this.timeline.sample(time, exaggeration, this.positions.array as Float32Array, this.intensity);
    const perUnit = range > 0 ? 1 / range : 0;
    const inset = 0.5 / TEXELS;
    for (let i = 0; i < this.intensity.length; i++) {
      const t = Math.min(1, this.intensity[i]! * perUnit);
      this.lookup.setX(i, inset + t * (1 - 2 * inset));
    }
    this.positions.needsUpdate = true;
    this.lookup.needsUpdate = true;
    this.showTriangles(this.timeline.trianglesAt(time));
    this.instruments.update(time);
  }

  /** The instruments' own objects, in their order. */
  get instrumentObjects(): readonly THREE.Object3D[] {
    return this.instruments.group.children;
  }

  get hasInstruments(): boolean {
    return this.instruments.count > 0;
  }

  /** A surface that was cut is another one from then on. */
  private showTriangles(triangles: Uint32Array): void {
    if (triangles === this.shown) return;
    this.shown = triangles;
    this.skinGeometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    const edges = uniqueEdges(triangles, this.timeline.vertices);
    this.edges.geometry.setIndex(new THREE.BufferAttribute(edges, 1));
  }

  /** Cuts the body open and closes it with a face: what the plane's normal points to stays; null: all of it. Instruments stay whole. */
  cutOpen(plane: THREE.Plane | null): void {
    const planes = plane ? [plane] : null;
    for (const object of [this.skin, this.edges, this.held, this.driven, this.hiddenDriven, ...this.ghost.children])
      ((object as THREE.Mesh).material as THREE.Material).clippingPlanes = planes;
    this.cap.plane = plane;
  }

  /** What a plane is laid through: by its heart the way of the first instrument is seen. */
  /** Diagonal of the box about it at rest [m]. */
  get diagonal(): number {
    return this.size;
  }

  get clipBody(): ClipBody {
    const tip = this.timeline.frames[this.timeline.frames.length - 1]!.instruments[0]?.points.slice(-3);
    const heart =
      tip && tip.length === 3
        ? new THREE.Vector3(...(tip as [number, number, number]))
        : this.box.getCenter(new THREE.Vector3());
    return { box: this.box, heart };
  }

  show(parts: { edges: boolean; ghost: boolean; marks: boolean }): void {
    this.edges.visible = parts.edges;
    if (parts.ghost && this.ghost.children.length === 0) this.buildGhost();
    this.ghost.visible = parts.ghost;
    this.held.visible = this.driven.visible = this.hiddenDriven.visible = parts.marks;
  }

  colour(colours: ModelColours): void {
    this.edgeMaterial.color.set(colours.edge);
    this.ghostLine.color.set(colours.ghost);
    this.ghostSkin.color.set(colours.ghost);
    (this.held.material as THREE.PointsMaterial).color.set(colours.held);
    (this.driven.material as THREE.PointsMaterial).color.set(colours.driven);
    (this.hiddenDriven.material as THREE.PointsMaterial).color.set(colours.driven);
    this.instruments.colour(colours.instrument);
    this.cap.colour = colours.cap;
  }

  /** All vertices at rest and in the last frame, displacement exaggerated: what a view should hold. */
  extremes(exaggeration: number): Float32Array {
    const points = new Float32Array(6 * this.timeline.vertices);
    const half = points.subarray(0, 3 * this.timeline.vertices);
    this.timeline.sample(this.timeline.end, exaggeration, half, new Float32Array(this.timeline.vertices));
    points.set(this.timeline.rest.subarray(0, half.length), half.length);
    return points;
  }

  dispose(): void {
    for (const thing of this.disposables) thing.dispose();
  }
}

/** Changes only the depth at which points are drawn, by `lift` towards the camera [m]. */
function bringForward(shader: THREE.WebGLProgramParametersWithUniforms, lift: number): void {
  shader.vertexShader = shader.vertexShader.replace(
    "#include <project_vertex>",
    `#include <project_vertex>
    vec4 lifted = projectionMatrix * ( mvPosition + vec4( 0.0, 0.0, ${lift.toExponential(6)}, 0.0 ) );
    gl_Position.z = lifted.z / lifted.w * gl_Position.w;`,
  );
}
