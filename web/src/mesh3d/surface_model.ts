// surface_model.ts — the three.js objects of one surface: body, wireframe, rest ghost, marked vertices, inner regions.
//
//   coarse positions (one buffer) ─┬─ held and driven vertices
//                                  ├─ skin: the coarse triangles, met by rays and never drawn
//                                  ├─ body and wireframe: the surface as it is drawn (BodySkin)
//                                  │    └─ cap: closes it where it is cut open
//                                  ├─ inner regions, seen through the body or where it is opened
//                                  └─ isotherms, likewise
//   rest positions ────────────────── ghost: faint skin and its creases
import * as THREE from "three";
import { BodySkin } from "./body_skin.ts";
import type { ClipBody } from "./clip.ts";
import { ClipCap } from "./clip_cap.ts";
import { ContactShadow } from "./contact_shadow.ts";
import { FieldCap } from "./field_cap.ts";
import { InnerRegions } from "./inner_regions.ts";
import { InstrumentModel } from "./instrument_model.ts";
import { drawnIsotherms, Isotherms } from "./isotherms.ts";
import { markTexture } from "./mark_texture.ts";
import { coloursOf, regionTints } from "./tissue_colours.ts";
import type { TissueMaterial } from "./tissue_material.ts";
import { VesselModel } from "./vessel_model.ts";
import type { Span, SurfaceMotion } from "./timeline.ts";

const CREASE_DEGREES = 28;
/** Marks are drawn this share of the mesh's size nearer, or the skin beside a vertex would cut its sign. */
const MARK_LIFT = 0.03;
export const MANY_MARKS = 40;
const MARK_PIXELS = { square: 9, disc: 12 };

export interface ModelColours {
  edge: string;
  ghost: string;
  held: string;
  driven: string;
  instrument: string;
  cap: string; // of a body that a field colours
}

/** How a body is drawn. */
export interface ModelLook {
  coloured: boolean; // by the field, else as tissue
  seeThrough: boolean;
  fine: boolean;
}

export class SurfaceModel {
  readonly group = new THREE.Group();
  readonly heldCount: number;
  readonly drivenCount: number;
  private readonly positions: THREE.BufferAttribute;
  private readonly intensity: Float32Array; // and shares of the scale, once it has been brought to it
  private readonly edgeMaterial = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.35 });
  private readonly ghostLine = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.7, depthWrite: false });
  private readonly ghostSkin = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.08, depthWrite: false });
  private readonly box: THREE.Box3; // of the rest shape
  private readonly size: number; // its diagonal [m]
  private readonly held: THREE.Points;
  private readonly driven: THREE.Points;
  private readonly hiddenDriven: THREE.Points;
  private readonly body: BodySkin;
  private readonly inner: InnerRegions;
  private readonly isotherms: Isotherms;
  private readonly shadow: ContactShadow;
  private readonly ghost = new THREE.Group();
  private readonly disposables: { dispose(): void }[] = [];
  readonly skin: THREE.Mesh;
  private readonly skinGeometry: THREE.BufferGeometry;
  private readonly instruments: InstrumentModel;
  private readonly vessel: VesselModel | null;
  private readonly cap: ClipCap;
  private readonly fieldCap = new FieldCap();
  private tets: Uint32Array | null; // of the whole body now; null: its surfaces alone are known
  private shown: Uint32Array; // triangles of the skin now …
  private shownKinds: Uint8Array | null; // … and their kinds
  private look: ModelLook = { coloured: false, seeThrough: false, fine: true };

  /**
   * @param material  of the body; it is the caller's, since making one anew with each surface would be slow
   * @param time  whether the body is seen for the first time, or has become another one while it moves
   */
  constructor(
    readonly timeline: SurfaceMotion,
    private readonly material: TissueMaterial,
    fine: boolean,
    time: "first" | "again" = "first",
  ) {
    this.shown = timeline.triangles;
    this.tets = timeline.tetsAt(timeline.frames[0]!.time);
    this.shownKinds = timeline.kindsAt(timeline.frames[0]!.time);
    this.look.fine = fine;
    this.box = new THREE.Box3().setFromArray(timeline.rest);
    this.size = this.box.getSize(new THREE.Vector3()).length();
    this.positions = new THREE.BufferAttribute(timeline.rest.slice(0, 3 * timeline.vertices), 3);
    this.positions.setUsage(THREE.DynamicDrawUsage);
    this.intensity = new Float32Array(timeline.vertices);
    material.size = this.size;
    const { tissue, raw } = coloursOf(timeline.tissue);
    material.raw = raw;
    const rest = timeline.rest.subarray(0, 3 * timeline.vertices);
    const colourOf = regionTints(tissue, timeline);
    this.body = new BodySkin(rest, colourOf, material, this.edgeMaterial, fine, time);
    this.body.build(this.shown, this.shownKinds);
    this.held = this.points(1, "square");
    this.driven = this.points(2, "disc");
    this.hiddenDriven = this.seenThrough(this.driven);
    this.heldCount = this.held.geometry.index?.count ?? 0;
    this.drivenCount = this.driven.geometry.index?.count ?? 0;
    this.skin = new THREE.Mesh(
      this.shared(timeline.triangles),
      new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }),
    );
    this.skinGeometry = this.skin.geometry;
    this.instruments = new InstrumentModel(timeline, this.size);
    this.vessel = timeline.container ? new VesselModel(timeline.container) : null;
    if (this.vessel) {
      this.group.add(this.vessel.group);
      this.disposables.push(this.vessel);
    }
    const middle = this.box.getCenter(new THREE.Vector3());
    this.cap = new ClipCap(this.body.mesh.geometry, middle, this.size);
    this.cap.tissue = raw;
    this.inner = new InnerRegions(timeline, this.positions, middle, this.size);
    this.isotherms = new Isotherms(drawnIsotherms(timeline.isotherms));
    this.shadow = new ContactShadow(timeline.rest, timeline.triangles, this.box);
    this.group.add(
      this.shadow.mesh,
      this.body.mesh,
      this.cap.group,
      this.fieldCap.mesh,
      this.inner.group,
      this.isotherms.group,
      this.body.edges,
      this.held,
      this.hiddenDriven,
      this.driven,
      this.ghost,
      this.instruments.group,
    );
    this.group.traverse((object) => (object.frustumCulled = false));
    this.disposables.push(this.fieldCap, this.instruments, this.cap, this.edgeMaterial, this.ghostLine, this.ghostSkin);
    this.disposables.push(this.body, this.inner, this.isotherms, this.shadow, this.skin.material as THREE.Material);
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

  /** Shape and colours at a time [s]; colours go from `low` to `high`. */
  update(time: number, exaggeration: number, { low, high }: Span): void {
    this.timeline.sample(time, exaggeration, this.positions.array as Float32Array, this.intensity);
    const perUnit = high > low ? 1 / (high - low) : 0;
    for (let i = 0; i < this.intensity.length; i++)
      this.intensity[i] = Math.min(1, Math.max(0, (this.intensity[i]! - low) * perUnit));
    this.tets = this.timeline.tetsAt(time);
    this.positions.needsUpdate = true;
    this.showTriangles(this.timeline.trianglesAt(time), this.timeline.kindsAt(time));
    this.body.update(this.positions.array as Float32Array, this.intensity);
    this.inner.update(this.timeline.regionsAt(time));
    this.showIsotherms(time);
    this.instruments.update(time);
    this.material.tools = this.instruments.near();
  }

  private showIsotherms(time: number): void {
    const temperature = this.timeline.isotherms.length > 0 ? this.timeline.temperatureAt(time) : null;
    if (temperature && this.tets) this.isotherms.update(this.positions.array as Float32Array, temperature, this.tets);
  }

  /** Tissue or field, whole or seen through, fine or plain. */
  setLook(look: ModelLook): void {
    const plainer = look.fine !== this.look.fine;
    this.look = { ...look };
    this.material.coloured = look.coloured;
    this.material.seeThrough = look.seeThrough;
    this.material.fine = look.fine;
    this.cap.coloured = look.coloured;
    this.inner.show(look.seeThrough || this.cap.open, look.coloured);
    if (!plainer) return;
    this.body.fine = look.fine;
    this.rebuild();
  }

  /** The instruments' own objects, in their order. */
  get instrumentObjects(): readonly THREE.Object3D[] {
    return this.instruments.group.children;
  }

  get hasInstruments(): boolean {
    return this.instruments.count > 0;
  }

  /** A surface that was cut, or whose capsule has torn, is another one from then on. */
  private showTriangles(triangles: Uint32Array, kinds: Uint8Array | null): void {
    if (triangles === this.shown && kinds === this.shownKinds) return;
    this.shown = triangles;
    this.shownKinds = kinds;
    this.skinGeometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    this.rebuild();
  }

  private rebuild(): void {
    this.body.build(this.shown, this.shownKinds);
    this.cap.skin = this.body.mesh.geometry;
  }

  /** Cuts the body open and closes it with a face: what the plane's normal points to stays; null: all of it. Instruments stay whole. */
  cutOpen(plane: THREE.Plane | null): void {
    const planes = plane ? [plane] : null;
    const cut = [this.body.mesh, this.body.edges, this.held, this.driven, this.hiddenDriven, ...this.ghost.children];
    for (const object of cut) ((object as THREE.Mesh).material as THREE.Material).clippingPlanes = planes;
    this.cap.plane = plane;
    const known = this.look.coloured && this.tets !== null;
    this.cap.hidden = known; // the field is known inside, too
    if (known && this.tets) this.fieldCap.show(plane, this.positions.array as Float32Array, this.intensity, this.tets);
    else this.fieldCap.hide();
    this.shadow.mesh.visible = plane === null; // the shadow is that of the whole body
    this.inner.plane = plane;
    this.isotherms.plane = plane;
    this.inner.show(this.look.seeThrough || this.cap.open, this.look.coloured);
  }

  /** Of the box about it at rest. */
  get middle(): THREE.Vector3 {
    return this.box.getCenter(new THREE.Vector3());
  }

  /** Where the first tool acts: amid the vertices that it drives, else the first instrument's tip; null: there is none. */
  toolPlace(time: number): THREE.Vector3 | null {
    const driven = this.driven.geometry.index;
    const at = new THREE.Vector3();
    if (driven && driven.count > 0) {
      const each = new THREE.Vector3();
      for (let i = 0; i < driven.count; i++) at.add(each.fromBufferAttribute(this.positions, driven.getX(i)));
      return at.divideScalar(driven.count);
    }
    return this.instruments.tip(0, time);
  }

  /** Diagonal of the box about it at rest [m]. */
  get diagonal(): number {
    return this.size;
  }

  /** What a plane is laid through: by its heart the way of the first instrument is seen. */
  get clipBody(): ClipBody {
    const tip = this.timeline.frames[this.timeline.frames.length - 1]!.instruments[0]?.points.slice(-3);
    const heart =
      tip && tip.length === 3
        ? new THREE.Vector3(...(tip as [number, number, number]))
        : this.box.getCenter(new THREE.Vector3());
    return { box: this.box, heart };
  }

  show(parts: { edges: boolean; ghost: boolean; marks: boolean; held?: boolean; isotherms?: boolean }): void {
    this.isotherms.group.visible = parts.isotherms === true;
    this.body.edges.visible = parts.edges;
    if (parts.ghost && this.ghost.children.length === 0) this.buildGhost();
    this.ghost.visible = parts.ghost;
    this.held.visible = parts.marks && parts.held !== false;
    this.driven.visible = this.hiddenDriven.visible = parts.marks;
  }

  colour(colours: ModelColours): void {
    this.edgeMaterial.color.set(colours.edge);
    this.ghostLine.color.set(colours.ghost);
    this.ghostSkin.color.set(colours.ghost);
    (this.held.material as THREE.PointsMaterial).color.set(colours.held);
    (this.driven.material as THREE.PointsMaterial).color.set(colours.driven);
    (this.hiddenDriven.material as THREE.PointsMaterial).color.set(colours.driven);
    this.instruments.colour(colours.instrument);
    if (this.vessel) this.vessel.colour = colours.instrument;
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
