// live_view.ts — the streamed organ in a canvas: drag tissue to pull or cut it, a tool to push it along its axis, the rest
// to turn.
import * as THREE from "three";
import { strokeOf } from "../charts/line_style.ts";
import { type ClipBody, clipKey, clipPlane, firstSeen, rememberClip, rememberedClip } from "../mesh3d/clip.ts";
import { ClipControls } from "../mesh3d/clip_controls.ts";
import { AS_TISSUE, type Colouring, LIVE_COLOURINGS, colouringOf } from "../mesh3d/fields.ts";
import { fineIsFast, hopeForFine, Pace } from "../mesh3d/drawing_speed.ts";
import { lookKey, rememberedLook, rememberLook, TISSUE } from "../mesh3d/look.ts";
import { LookControls } from "../mesh3d/look_controls.ts";
import { ScaleBar } from "../mesh3d/scale_bar.ts";
import { Stage } from "../mesh3d/stage.ts";
import { MANY_MARKS, SurfaceModel } from "../mesh3d/surface_model.ts";
import { TissueMaterial } from "../mesh3d/tissue_material.ts";
import { drawsInSoftware, webglContext } from "../mesh3d/webgl.ts";
import { h } from "../page/dom.ts";
import { currentTheme, onTheme, themeColour } from "../page/theme.ts";
import { ColourScale } from "./colour_scale.ts";
import { CutTool } from "./cut_tool.ts";
import { ForceShown } from "./force_shown.ts";
import { LiveSurface } from "./live_surface.ts";
import type { Hello, Keyframe, LiveFrame } from "./protocol.ts";

const DRIVEN = 2;
const EASINGS = [0.7, 0.5]; // shares of the pixels in each direction

export interface Hands {
  mayAct(): boolean;
  /** @param bonded  to the pointer, else by springs */
  grab(vertex: number, at: THREE.Vector3, bonded: boolean): void;
  /** Puts the chosen tool before a point of the surface. */
  place(at: THREE.Vector3): void;
  drag(to: THREE.Vector3): void;
  letGo(): void;
  push(tool: number, depth: number): void;
  cut(begins: boolean, from: THREE.Vector3, to: THREE.Vector3): void;
}

/** What a drag does. */
export type DragMode = "pull" | "grasp" | "place" | "cut" | "turn";

type Drag =
  | { what: "tissue"; vertex: number; plane: THREE.Plane; offset: THREE.Vector3 }
  | { what: "tool"; tool: number; axis: THREE.Ray; from: number; depth: number };

/** Whether a picture of one frame is that of the other. */
function showsTheSame(a: LiveFrame, b: LiveFrame): boolean {
  const numbers = ["keyframe", "epoch", "time", "field", "low", "high", "grabbing", "stopped"] as const;
  return numbers.every((key) => a[key] === b[key]) && JSON.stringify(a.tools) === JSON.stringify(b.tools);
}

export class LiveView {
  readonly element: HTMLElement;
  readonly canvas = h("canvas", {
    class: "mesh-canvas live-canvas",
    tabindex: 0,
    "aria-label":
      "The body in three dimensions. Arrow keys turn it, plus and minus zoom, 0 shows all of it, C cuts it open, G sees " +
      "through it, F colours it by a field or as tissue. With the cutting tool (K) arrow keys move the blade, Enter puts it down and lifts it.",
  });
  edges = false;
  onColour: (colouring: Colouring) => void = () => {};
  private readonly lookSettings = rememberedLook("live", [TISSUE, ...LIVE_COLOURINGS.map(({ name }) => name)]);
  readonly look = new LookControls(
    this.lookSettings,
    LIVE_COLOURINGS.map(({ name, label }) => ({ value: name, label })),
    () => this.lookChanged(),
  );
  private readonly clip = rememberedClip("live", { on: false, axis: "y", at: null, flipped: false });
  readonly cut = new ClipControls(
    this.clip,
    () => this.clipBody,
    () => this.cutChanged(),
  );
  private readonly stage: Stage | null;
  private surface: LiveSurface | null = null;
  private model: SurfaceModel | null = null;
  private keyframe = -1;
  private epoch = -1;
  private readonly scale = new ColourScale(colouringOf(this.lookSettings.colour), () => this.model?.diagonal ?? 1);
  readonly force: ForceShown;
  private readonly material = new TissueMaterial();
  private readonly scaleBar = new ScaleBar();
  private readonly pace = new Pace();
  private canBeFine = hopeForFine();
  private measured = false;
  private dragMode: DragMode = "pull";
  readonly cutTool: CutTool | null = null;
  private frame: LiveFrame | null = null;
  private fitted = false;
  private dragged: Drag | null = null;
  private readonly thread = new THREE.Line(
    new THREE.BufferGeometry(),
    new THREE.LineBasicMaterial({ depthTest: false }),
  );

  constructor(
    private readonly hello: () => Hello | null,
    private readonly hands: Hands,
  ) {
    this.force = new ForceShown(hello);
    const context = webglContext(this.canvas, !drawsInSoftware());
    this.element = h("div", { class: "mesh-viewport live-viewport" }, this.canvas, this.scale.bar.element);
    this.element.append(this.scaleBar.element, this.force.arrow.label);
    this.stage = context ? new Stage(this.canvas, context) : null;
    if (!this.stage) {
      this.element.replaceChildren(
        h(
          "p",
          { class: "mesh-missing" },
          "This browser has no WebGL 2: forces and controls work, the body is not drawn.",
        ),
      );
      return;
    }
    this.thread.visible = this.thread.frustumCulled = false;
    this.thread.renderOrder = 10;
    this.stage.scene.add(this.thread);
    this.stage.beforeDrawing = () => {
      this.model?.cutOpen(this.plane);
      if (this.stage) this.force.arrow.keepInside(this.stage);
    };
    this.stage.afterDrawing = () => this.annotate();
    this.stage.scene.add(this.force.arrow.group);
    this.cutTool = new CutTool(this.stage, this.canvas, this.hands, (caster) => this.seenAt(caster));
    this.stage.scene.add(this.cutTool.lines);
    this.element.append(this.cutTool.crosshair);
    onTheme(() => this.recolour());
    this.element.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    this.element.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel"] as const)
      this.element.addEventListener(end, (event) => event.isPrimary && this.up());
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  /** Another skin: the first, or one that was cut. The old one stays until a frame tells where the new one is. */
  takeKeyframe(keyframe: Keyframe): void {
    this.coming = keyframe;
  }

  private coming: Keyframe | null = null;

  private build(keyframe: Keyframe): void {
    const hello = this.hello();
    if (!hello || !this.stage) return;
    this.coming = null;
    if (this.model) {
      this.stage.scene.remove(this.model.group);
      this.model.dispose();
    }
    const sets = hello.tools.filter((tool) => !tool.instrument).length;
    this.surface = new LiveSurface(keyframe, hello.instruments, sets, hello.container ?? null);
    this.model = new SurfaceModel(this.surface, this.material, this.fine, this.fitted ? "again" : "first");
    this.keyframe = keyframe.number;
    this.stage.scene.add(this.model.group);
    if (this.cutTool) this.cutTool.size = this.model.diagonal;
    this.recolour();
    this.cut.refresh();
    if (!this.fitted) this.fit();
    this.fitted = true;
  }

  /** The newest frame is drawn at the browser's own pace; those that come between are not. */
  takeFrame(frame: LiveFrame): void {
    if (frame !== this.newest && this.frame && showsTheSame(frame, this.frame)) return; // stands still
    this.newest = frame;
    if (this.request === 0) this.request = requestAnimationFrame(() => this.drawNewest());
  }

  /** Where drawing is slow, the fine look goes first, then pixels: motion is worth more than sharpness. */
  private easeDrawing(): void {
    if (!this.pace.tooSlow(performance.now())) return;
    if (this.fine && this.lookSettings.detail === "auto") this.canBeFine = false;
    else if (this.eased < EASINGS.length) this.stage?.coarsen(EASINGS[this.eased++]!);
  }

  private get fine(): boolean {
    const { detail } = this.lookSettings;
    return detail === "auto" ? this.canBeFine : detail === "fine";
  }

  private eased = 0;
  private newest: LiveFrame | null = null;
  private request = 0;

  private drawNewest(): void {
    this.request = 0;
    this.easeDrawing();
    const frame = this.newest;
    if (frame && frame.keyframe === this.coming?.number) this.build(this.coming);
    if (!frame || !this.surface || !this.model || frame.keyframe !== this.keyframe) return;
    if (frame.epoch !== this.epoch) this.scale.reset();
    this.epoch = frame.epoch;
    this.frame = frame;
    this.scale.take(this.surface.take(frame, this.scale.colouring), this.surface);
    this.model.setLook({
      coloured: this.scale.colouring.name !== TISSUE,
      seeThrough: this.lookSettings.seeThrough,
      fine: this.fine,
    });
    this.model.show({ edges: this.edges, ghost: false, marks: true, held: this.model.heldCount <= MANY_MARKS });
    this.model.update(0, 1, { low: 0, high: 1 });
    const held = frame.grabbing && this.dragged?.what === "tissue" ? this.place(this.dragged.vertex) : null;
    this.force.show(frame, this.model, held);
    this.drawThread();
    this.canvas.dataset["look"] = this.fine ? "fine" : "plain";
    if (!this.measured && this.stage) this.measure(this.stage);
    else this.stage?.draw();
  }

  /** The first frame tells whether the fine look is fast enough here. */
  private measure(stage: Stage): void {
    this.measured = true;
    if (this.lookSettings.detail === "auto") this.canBeFine = fineIsFast(stage);
    if (!this.canBeFine) this.request = requestAnimationFrame(() => this.drawNewest());
    else stage.draw();
  }

  /** What is written over the picture follows it. */
  private annotate(): void {
    if (!this.stage) return;
    this.scaleBar.show(this.stage.metresPerPixel, this.stage.size.width);
    this.force.arrow.place(this.stage, [this.scale.bar.element, this.scaleBar.element]);
  }

  private get clipBody(): ClipBody | null {
    return this.model?.clipBody ?? null;
  }

  private get plane(): THREE.Plane | null {
    return this.model && this.stage ? clipPlane(this.clip, this.model.clipBody, this.stage.forward) : null;
  }

  /** Whether the whole body is needed: a field on the face of a cut. */
  get wantsInside(): boolean {
    return this.clip.on && this.scale.colouring.name !== TISSUE;
  }

  onInside: (wanted: boolean) => void = () => {};
  private told = false;

  private askInside(): void {
    if (this.told === this.wantsInside) return;
    this.told = this.wantsInside;
    this.onInside(this.told);
  }

  /** The line is new: what was asked for is not known there. */
  askAgain(): void {
    this.told = false;
    this.askInside();
  }

  private cutChanged(): void {
    this.askInside();
    rememberClip("live", this.clip);
    this.stage?.invalidate();
  }

  private lookChanged(): void {
    rememberLook("live", this.lookSettings);
    this.look.refresh();
    const colouring = colouringOf(this.lookSettings.colour);
    if (colouring.name !== this.scale.colouring.name) {
      this.scale.colouring = colouring;
      this.onColour(colouring);
    }
    this.askInside();
    if (this.newest) this.takeFrame(this.newest); // a body that is paused is drawn anew, too
  }

  /** What colours stand for; a body without stress has no pressure to show. */
  get colours(): Colouring {
    return this.scale.colouring;
  }

  /** Tells which fields there are. */
  offer(hasStress: boolean): void {
    const fields = ["pressure", "von_mises", "contact_pressure"];
    for (const name of fields)
      this.look.colour.querySelector<HTMLOptionElement>(`[value=${name}]`)!.hidden = !hasStress;
    if (hasStress || !fields.includes(this.scale.colouring.name)) return;
    this.lookSettings.colour = AS_TISSUE.name;
    this.lookChanged();
  }

  /** What a drag on the body does. */
  set mode(mode: DragMode) {
    this.dragMode = mode;
    this.canvas.dataset["mode"] = mode;
    this.cutTool?.clear();
    this.cutTool?.showCrosshair(false);
  }

  fit(): void {
    if (this.model) this.stage?.fit(this.model.extremes(1));
  }

  /** The picture at twice the size. */
  picture(use: (canvas: HTMLCanvasElement) => void): void {
    this.stage?.withFinePicture(use);
  }

  private recolour(): void {
    const driven = strokeOf({ colour: 1, dash: [] }, currentTheme());
    this.model?.colour({
      edge: themeColour("--mesh-edge"),
      ghost: themeColour("--mesh-ghost"),
      held: themeColour("--mesh-held"),
      instrument: themeColour("--mesh-instrument"),
      cap: themeColour("--mesh-cap"),
      driven,
    });
    for (const line of [this.thread, this.cutTool?.lines])
      (line?.material as THREE.LineBasicMaterial | undefined)?.color.set(driven);
    this.force.arrow.colour = themeColour("--mesh-force");
    this.stage?.invalidate();
  }

  private down(event: PointerEvent): void {
    if (!this.stage || !this.model || event.button !== 0 || !event.isPrimary || event.target !== this.canvas) return;
    if (this.dragMode === "cut" && this.hands.mayAct()) return this.beginCut(event);
    if (this.dragMode === "place" && this.hands.mayAct() && this.pick(event)) return;
    this.dragged = this.hands.mayAct() ? this.take(event) : null;
    this.stage.turning = this.dragged === null;
    if (!this.dragged) return;
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    if (this.dragged.what !== "tissue") return;
    this.hands.grab(this.dragged.vertex, this.place(this.dragged.vertex), this.dragMode === "grasp");
  }

  /** The point of the surface under the pointer is where the tool is to be; whether there is one. */
  private pick(event: PointerEvent): boolean {
    const { stage, model } = this;
    if (!stage || !model) return false;
    const caster = stage.rayThrough(event.clientX, event.clientY);
    model.skin.geometry.computeBoundingSphere();
    const { hit } = firstSeen(caster.intersectObject(model.skin, false), this.plane, caster.ray);
    if (!hit) return false;
    this.hands.place(hit.point);
    return true;
  }

  /** How far the body reaches against a direction from a point [m]: less is before all of it. */
  reachAlong(from: readonly number[], direction: readonly number[]): number {
    const position = this.model?.skin.geometry.getAttribute("position") as THREE.BufferAttribute | undefined;
    let least = Infinity;
    for (let i = 0; position && i < position.count; i++) {
      const at = [position.getX(i), position.getY(i), position.getZ(i)];
      least = Math.min(
        least,
        at.reduce((sum, x, k) => sum + (x - from[k]!) * direction[k]!, 0),
      );
    }
    return least;
  }

  /** Diagonal of the body [m]; 0 before it has come. */
  get size(): number {
    return this.model?.diagonal ?? 0;
  }

  /** How far from the eye the body is seen in a line of sight; null: beside it. */
  private seenAt(caster: THREE.Raycaster): number | null {
    if (!this.model) return null;
    this.model.skin.geometry.computeBoundingSphere();
    const seen = firstSeen(caster.intersectObject(this.model.skin, false), this.plane, caster.ray);
    return Number.isFinite(seen.distance) ? seen.distance : null;
  }

  private beginCut(event: PointerEvent): void {
    this.stage!.turning = false;
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    this.cutTool?.showCrosshair(false);
    this.cutTool?.begin({ x: event.clientX, y: event.clientY });
  }

  /** What lies under the pointer: a tool, driven vertices, tissue. */
  private take(event: PointerEvent): Drag | null {
    const { stage, model, frame } = this;
    const hello = this.hello();
    if (!stage || !model || !frame || !hello) return null;
    const caster = stage.rayThrough(event.clientX, event.clientY);
    model.skin.geometry.computeBoundingSphere();
    const objects = model.instrumentObjects as THREE.Object3D[];
    for (const object of objects) (object as THREE.Mesh).geometry?.computeBoundingSphere();
    const tool = caster.intersectObjects(objects, false)[0];
    const seen = firstSeen(caster.intersectObject(model.skin, false), this.plane, caster.ray);
    const skin = seen.hit;
    const sets = hello.tools.filter((each) => !each.instrument).length;
    if (tool && tool.distance <= seen.distance)
      return this.takeTool(sets + objects.indexOf(tool.object), tool.point, caster.ray);
    if (!skin?.face || !this.surface) return null;
    const corners = [skin.face.a, skin.face.b, skin.face.c];
    if (sets > 0 && corners.some((corner) => this.surface!.fixed[corner] === DRIVEN))
      return this.takeTool(0, skin.point, caster.ray);
    if ((this.dragMode !== "pull" && this.dragMode !== "grasp") || !hello.can_grab) return null;
    const far = (corner: number) => this.place(corner).distanceTo(skin.point);
    const vertex = corners.reduce((best, corner) => (far(corner) < far(best) ? corner : best));
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(stage.forward, skin.point);
    return { what: "tissue", vertex, plane, offset: this.place(vertex).sub(skin.point) };
  }

  private takeTool(tool: number, point: THREE.Vector3, ray: THREE.Ray): Drag | null {
    const info = this.hello()?.tools[tool];
    const state = this.frame?.tools[tool];
    if (!info || !state) return null;
    const axis = new THREE.Ray(point.clone(), new THREE.Vector3(...(info.direction as [number, number, number])));
    return { what: "tool", tool, axis, from: alongAxis(axis, ray), depth: state.depth };
  }

  private move(event: PointerEvent): void {
    if (event.isPrimary && event.buttons > 0) this.cutTool?.moveTo({ x: event.clientX, y: event.clientY });
    if (!this.dragged || !this.stage) return;
    const { ray } = this.stage.rayThrough(event.clientX, event.clientY);
    if (this.dragged.what === "tool") {
      this.hands.push(this.dragged.tool, this.dragged.depth + alongAxis(this.dragged.axis, ray) - this.dragged.from);
      return;
    }
    const to = ray.intersectPlane(this.dragged.plane, new THREE.Vector3());
    if (!to) return;
    to.add(this.dragged.offset);
    this.target.copy(to);
    this.hands.drag(to);
  }

  private readonly target = new THREE.Vector3();

  private up(): void {
    this.cutTool?.end();
    if (this.dragged?.what === "tissue") this.hands.letGo();
    this.dragged = null;
    this.thread.visible = false;
    if (this.stage) this.stage.turning = true;
  }

  /** Where a vertex of the skin is now. */
  private place(vertex: number): THREE.Vector3 {
    const position = this.model!.skin.geometry.getAttribute("position") as THREE.BufferAttribute;
    return new THREE.Vector3().fromBufferAttribute(position, vertex);
  }

  /** From what is held to where the hand is. */
  private drawThread(): void {
    const drag = this.dragged;
    this.thread.visible = drag?.what === "tissue" && this.frame?.grabbing === true && this.target.lengthSq() > 0;
    if (!this.thread.visible || drag?.what !== "tissue") return;
    this.thread.geometry.setFromPoints([this.place(drag.vertex), this.target]);
  }

  private key(event: KeyboardEvent): void {
    if (this.dragMode === "cut" && this.hands.mayAct() && this.cutTool?.keyDown(event)) return event.preventDefault();
    const turn: Record<string, [number, number]> = {
      ArrowLeft: [-0.12, 0],
      ArrowRight: [0.12, 0],
      ArrowUp: [0, -0.12],
      ArrowDown: [0, 0.12],
    };
    const by = turn[event.key];
    if (by) this.stage?.turn(...by);
    else if (event.key === "+" || event.key === "=") this.stage?.zoom(0.85);
    else if (event.key === "-") this.stage?.zoom(1 / 0.85);
    else if (event.key === "0") this.fit();
    else if (this.clipBody && !event.ctrlKey && !event.metaKey && clipKey(event.key, this.clip, this.clipBody)) {
      this.cutChanged();
      this.cut.refresh();
    } else if (!event.ctrlKey && !event.metaKey && lookKey(event.key, this.lookSettings, LIVE_COLOURINGS[0]!.name))
      this.lookChanged();
    else return;
    event.preventDefault();
  }
}

/** Way along an axis of the point that is nearest to a ray [m]; nearly parallel ones give none. */
function alongAxis(axis: THREE.Ray, ray: THREE.Ray): number {
  const w = ray.origin.clone().sub(axis.origin);
  const b = axis.direction.dot(ray.direction);
  const denominator = 1 - b * b;
  if (denominator < 0.02) return 0;
  return (w.dot(axis.direction) - b * w.dot(ray.direction)) / denominator;
}
