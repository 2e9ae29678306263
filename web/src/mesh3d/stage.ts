// stage.ts — camera, light and canvas of a 3D view; draws only when something changed and it can be seen.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { isPrinting } from "../page/theme.ts";
import { watchVisibility } from "../page/visibility.ts";

const HOME_DIRECTION = new THREE.Vector3(0.66, -1, 0.62).normalize();
const FIELD_OF_VIEW = 28; // degrees
const FILL = 0.92; // share of the picture that a fitted box may take
const BAR_ROOM = 78; // CSS pixels at the right, taken by the colour scale
const STILL_MS = 300; // a picture that has stood so long is drawn with all pixels

export class Stage {
  readonly scene = new THREE.Scene();
  private readonly renderer: THREE.WebGLRenderer;
  private readonly camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.001, 100);
  private readonly controls: OrbitControls;
  private readonly stops: (() => void)[] = [];
  private visible = true;
  private request = 0;
  private share = 1; // of the pixels in each direction, while things move
  private sharpening = 0; // timer
  private isSharp = false; // all pixels although the share is less
  /** Called before each drawing: what follows the eye is set there. */
  beforeDrawing: () => void = () => {};
  /** Called after each drawing: what is written over the picture follows it. */
  afterDrawing: () => void = () => {};

  constructor(
    private readonly canvas: HTMLCanvasElement,
    context: WebGL2RenderingContext,
  ) {
    this.renderer = new THREE.WebGLRenderer({
      canvas,
      context,
      antialias: true,
      alpha: true,
      stencil: true, // for the face of a cut
      preserveDrawingBuffer: true,
    });
    this.renderer.setClearAlpha(0);
    this.renderer.localClippingEnabled = true;
    this.camera.up.set(0, 0, 1);
    this.light();
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.zoomSpeed = 1.2;
    this.controls.addEventListener("change", () => this.invalidate());
    this.claimGesturesOnFocus();
    const resize = new ResizeObserver(() => this.resize());
    resize.observe(canvas);
    this.stops.push(() => resize.disconnect());
    this.stops.push(watchVisibility(canvas, (visible) => ((this.visible = visible), visible && this.invalidate())));
    canvas.addEventListener("webglcontextrestored", () => this.invalidate());
    this.resize();
  }

  /** Ambient light and a head light a little to the left: colours stay close to those of the bar. */
  private light(): void {
    const head = new THREE.DirectionalLight(0xffffff, 1.5);
    head.position.set(-0.5, 0.6, 1);
    this.camera.add(head);
    this.scene.add(this.camera, new THREE.AmbientLight(0xffffff, 1.8));
  }

  /** Wheel and fingers scroll the page until the view has been clicked; then they zoom and turn it. */
  private claimGesturesOnFocus(): void {
    const claim = (own: boolean) => {
      this.controls.enableZoom = own;
      this.canvas.style.touchAction = own ? "none" : "pan-y";
    };
    claim(false);
    this.canvas.addEventListener("pointerdown", () => this.canvas.focus({ preventScroll: true }));
    this.canvas.addEventListener("focus", () => claim(true));
    this.canvas.addEventListener("blur", () => claim(false));
  }

  private setPixels(share: number): void {
    this.renderer.setPixelRatio(share * Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(this.canvas.clientWidth, this.canvas.clientHeight, false);
    this.isSharp = share === 1;
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.setPixels(this.share);
    this.camera.aspect = width / height;
    this.camera.setViewOffset(width, height, this.barRoom() / 2, 0, width, height);
    this.invalidate();
  }

  /** What the colour scale takes of the width: all of it matters on a phone, little on a wide view. */
  private barRoom(): number {
    return Math.min(BAR_ROOM, 0.25 * this.canvas.clientWidth);
  }

  /** Asks for one drawing at the next chance; a printer does not wait for it. */
  invalidate(): void {
    if (isPrinting()) return this.draw();
    if (this.request === 0 && this.visible) this.request = requestAnimationFrame(() => this.draw());
  }

  /** Draws now. */
  draw(): void {
    cancelAnimationFrame(this.request);
    this.request = 0;
    if (this.share < 1) this.sharpenLater();
    this.render();
  }

  private render(): void {
    this.beforeDrawing();
    this.renderer.render(this.scene, this.camera);
    this.afterDrawing();
  }

  /** Fewer pixels are for motion: once nothing has been drawn for a while, all are. */
  private sharpenLater(): void {
    if (this.isSharp) this.setPixels(this.share);
    clearTimeout(this.sharpening);
    this.sharpening = window.setTimeout(() => {
      if (!this.isVisible || this.size.width === 0) return;
      this.setPixels(1);
      this.render();
    }, STILL_MS);
  }

  /** Draws and waits until that is done [ms]; null where the canvas has no size. */
  timeDrawing(): number | null {
    if (this.canvas.clientWidth === 0 || this.canvas.clientHeight === 0) return null;
    const context = this.renderer.getContext();
    const begin = performance.now();
    this.draw();
    context.readPixels(0, 0, 1, 1, context.RGBA, context.UNSIGNED_BYTE, new Uint8Array(4)); // waits for what was drawn
    return performance.now() - begin;
  }

  /** Of the canvas [CSS px]. */
  get size(): { width: number; height: number } {
    return { width: this.canvas.clientWidth, height: this.canvas.clientHeight };
  }

  /** Where a point is seen [CSS px from the canvas's upper left]. */
  toScreen(point: THREE.Vector3): { x: number; y: number } {
    const seen = point.clone().project(this.camera);
    const { width, height } = this.size;
    return { x: ((1 + seen.x) * width) / 2, y: ((1 - seen.y) * height) / 2 };
  }

  /** The point under a place of the canvas [CSS px] that is as far from the eye's plane as another. */
  fromScreen(at: { x: number; y: number }, like: THREE.Vector3): THREE.Vector3 {
    const { width, height } = this.size;
    const depth = like.clone().project(this.camera).z;
    return new THREE.Vector3((2 * at.x) / width - 1, 1 - (2 * at.y) / height, depth).unproject(this.camera);
  }

  /** Length that a CSS pixel shows at the distance one looks at [m]. */
  get metresPerPixel(): number {
    const up = 2 * this.distance * Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    return up / Math.max(1, this.canvas.clientHeight);
  }

  /** Draws at twice the resolution, hands the canvas to `use`, and draws as before. */
  withFinePicture(use: (canvas: HTMLCanvasElement) => void): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.renderer.setPixelRatio(Math.max(2, window.devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.draw();
    use(this.canvas);
    this.resize();
    this.draw();
  }

  get isVisible(): boolean {
    return this.visible && !document.hidden;
  }

  /** Looks at the points (xyz each) from the front, a little from above, as near as leaves all in view. */
  fit(points: Float32Array): void {
    const box = new THREE.Box3().setFromArray(points);
    const radius = Math.max(1e-9, box.getSize(new THREE.Vector3()).length() / 2);
    const home = framing(points, box.getCenter(new THREE.Vector3()), this.camera.up, ...this.reach());
    this.controls.target.copy(home.target);
    this.controls.minDistance = radius * 0.05;
    this.controls.maxDistance = radius * 20;
    this.camera.near = radius / 50;
    this.camera.far = radius * 50;
    this.camera.updateProjectionMatrix();
    this.camera.position.copy(home.target).addScaledVector(HOME_DIRECTION, home.distance);
    this.controls.update();
    this.invalidate();
  }

  /** Tangents of the half angles, sideways and upwards, that a fitted mesh may fill. */
  private reach(): [number, number] {
    const up = FILL * Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    return [up * this.camera.aspect * (1 - this.barRoom() / Math.max(1, this.canvas.clientWidth)), up];
  }

  /** A line from the eye through a point of the window [CSS px]. */
  rayThrough(clientX: number, clientY: number): THREE.Raycaster {
    const box = this.canvas.getBoundingClientRect();
    const x = (2 * (clientX - box.left)) / box.width - 1;
    const y = 1 - (2 * (clientY - box.top)) / box.height;
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2(x, y), this.camera);
    return caster;
  }

  /** From the eye to what it looks at [m]. */
  get distance(): number {
    return this.camera.position.distanceTo(this.controls.target);
  }

  /** Direction in which the eye looks. */
  get forward(): THREE.Vector3 {
    return this.camera.getWorldDirection(new THREE.Vector3());
  }

  /** Draws with this share of the pixels in each direction while things move: for what cannot keep up with all of them. */
  coarsen(share: number): void {
    this.share = share;
    this.resize();
  }

  /** Whether a drag turns the view; off while something else is dragged. */
  set turning(on: boolean) {
    this.controls.enabled = on;
  }

  /** Turns the camera about its target [rad]. */
  turn(azimuth: number, elevation: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const length = offset.length();
    const polar = Math.acos(Math.min(1, Math.max(-1, offset.z / length)));
    const around = Math.atan2(offset.y, offset.x) + azimuth;
    const down = Math.min(Math.PI - 0.01, Math.max(0.01, polar + elevation));
    offset
      .set(Math.sin(down) * Math.cos(around), Math.sin(down) * Math.sin(around), Math.cos(down))
      .multiplyScalar(length);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.invalidate();
  }

  /** Moves the camera to `factor` times its distance. */
  zoom(factor: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    offset.clampLength(this.controls.minDistance, this.controls.maxDistance);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.invalidate();
  }

  dispose(): void {
    cancelAnimationFrame(this.request);
    clearTimeout(this.sharpening);
    for (const stop of this.stops) stop();
    this.controls.dispose();
    this.renderer.dispose();
  }
}

/** Where to look and from how far along the home direction, so that all points lie within the given tangents. */
function framing(
  points: Float32Array,
  center: THREE.Vector3,
  vertical: THREE.Vector3,
  tanRight: number,
  tanUp: number,
): { target: THREE.Vector3; distance: number } {
  const right = new THREE.Vector3().crossVectors(vertical, HOME_DIRECTION).normalize();
  const up = new THREE.Vector3().crossVectors(HOME_DIRECTION, right);
  const at = new THREE.Vector3();
  const seen = new THREE.Box3();
  for (let i = 0; i < points.length; i += 3) {
    at.fromArray(points, i).sub(center);
    seen.expandByPoint(new THREE.Vector3(at.dot(right), at.dot(up), 0));
  }
  const middle = seen.getCenter(new THREE.Vector3());
  const target = center.clone().addScaledVector(right, middle.x).addScaledVector(up, middle.y);
  let distance = 0;
  for (let i = 0; i < points.length; i += 3) {
    at.fromArray(points, i).sub(target);
    const aside = Math.max(Math.abs(at.dot(right)) / tanRight, Math.abs(at.dot(up)) / tanUp);
    distance = Math.max(distance, at.dot(HOME_DIRECTION) + aside);
  }
  return { target, distance };
}
