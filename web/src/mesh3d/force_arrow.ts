// force_arrow.ts — the force of a tool on the tissue as an arrow with its size: into the body where it presses, out of it where
// it pulls. Lengths go by the largest force, so that a growing force is a growing arrow.
import * as THREE from "three";
import { formatSignificant } from "../format/number.ts";
import { h } from "../page/dom.ts";
import type { Stage } from "./stage.ts";

const LONGEST = 0.22; // of the body's size
const SHORTEST = 0.02; // of the largest force: less is no arrow
const THICK = 0.0055; // radius of the shaft, of the body's size
const HEAD = 0.05; // length of the head, of the body's size
const GAP = 6; // CSS pixels that a label keeps from others

export interface ForceNow {
  at: THREE.Vector3; // where it acts
  force: THREE.Vector3; // on the tissue [N]
  most: number; // largest of all that is shown [N]
}

export class ForceArrow {
  readonly group = new THREE.Group();
  readonly label = h("output", { class: "force-label", "aria-label": "Force" });
  private readonly material = new THREE.MeshBasicMaterial({ depthTest: false, transparent: true });
  private readonly shaft = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 16).translate(0, 0.5, 0), this.material);
  private readonly head = new THREE.Mesh(new THREE.ConeGeometry(1, 1, 24).translate(0, -0.5, 0), this.material);
  private readonly tail = new THREE.Vector3(); // its free end …
  private readonly tip = new THREE.Vector3(); // … and where it touches the body

  constructor() {
    this.group.add(this.shaft, this.head);
    this.group.traverse((object) => (object.frustumCulled = false));
    this.shaft.renderOrder = this.head.renderOrder = 8;
    this.show(null, new THREE.Vector3(), 1);
  }

  set colour(colour: string) {
    this.material.color.set(colour);
  }

  /** @param middle  of the body @param size  its diagonal [m] */
  show(now: ForceNow | null, middle: THREE.Vector3, size: number): void {
    const strength = now?.force.length() ?? 0;
    const drawn = now !== null && now.most > 0 && strength >= SHORTEST * now.most;
    this.group.visible = drawn;
    this.label.hidden = !drawn;
    if (!drawn) return;
    const along = now.force.clone().divideScalar(strength);
    const head = HEAD * size;
    const length = head + (LONGEST * size - head) * Math.min(1, strength / now.most);
    const presses = middle.clone().sub(now.at).dot(along) > 0;
    const from = presses ? now.at.clone().addScaledVector(along, -length) : now.at.clone();
    const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 1, 0), along);
    this.group.position.copy(from);
    this.group.quaternion.copy(turn);
    this.shaft.scale.set(THICK * size, length - 0.9 * head, THICK * size);
    this.head.scale.set(0.34 * head, head, 0.34 * head);
    this.head.position.set(0, length, 0);
    this.tip.copy(now.at);
    this.tail.copy(presses ? from : from.addScaledVector(along, length));
    this.label.textContent = `${formatSignificant(strength, 3)}\u00a0N`;
  }

  /** Puts the label beside the arrow's free end, off everything else that is written there; where there is no room, none. */
  place(stage: Stage, others: readonly Element[]): void {
    if (this.label.hidden) return;
    const room = stage.size;
    const at = stage.toScreen(this.tail);
    const own = { width: this.label.offsetWidth, height: this.label.offsetHeight };
    const taken = others.map((element) => boxIn(element, this.label.parentElement)).filter((box) => box !== null);
    const tip = stage.toScreen(this.tip);
    const place = freePlace(at, own, room, taken, { x: tip.x - at.x, y: tip.y - at.y });
    this.label.style.visibility = place ? "visible" : "hidden";
    if (place) this.label.style.transform = `translate(${place.x.toFixed(1)}px, ${place.y.toFixed(1)}px)`;
  }

  dispose(): void {
    this.shaft.geometry.dispose();
    this.head.geometry.dispose();
    this.material.dispose();
  }
}

export interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

/**
 * Beside, above or below a point: the first place that is within the room and meets no box.
 * @param along  direction in which a line leaves the point: places across it come first
 */
export function freePlace(
  at: { x: number; y: number },
  own: { width: number; height: number },
  room: { width: number; height: number },
  taken: readonly Box[],
  along: { x: number; y: number } = { x: 0, y: 1 },
): { x: number; y: number } | null {
  const { width, height } = own;
  const onLine = ({ x, y }: { x: number; y: number }) =>
    Math.abs((x + width / 2 - at.x) * along.x + (y + height / 2 - at.y) * along.y) /
    Math.hypot(x + width / 2 - at.x, y + height / 2 - at.y);
  const beside = [
    { x: at.x + 12, y: at.y - height / 2 },
    { x: at.x - 12 - width, y: at.y - height / 2 },
    { x: at.x - width / 2, y: at.y - height - 12 },
    { x: at.x - width / 2, y: at.y + 12 },
  ].sort((a, b) => onLine(a) - onLine(b));
  const tries = [
    ...beside,
    { x: at.x - width / 2, y: at.y - 2 * height - 24 },
    { x: at.x - width / 2, y: at.y - 4 * height - 24 },
  ].map(({ x, y }) => ({
    x: Math.min(room.width - width - GAP, Math.max(GAP, x)),
    y: Math.min(room.height - height - GAP, Math.max(GAP, y)),
  }));
  const meets = (p: { x: number; y: number }, box: Box) =>
    p.x < box.x + box.width + GAP &&
    box.x < p.x + width + GAP &&
    p.y < box.y + box.height + GAP &&
    box.y < p.y + height + GAP;
  return tries.find((place) => !taken.some((box) => meets(place, box))) ?? null;
}

function boxIn(element: Element, parent: Element | null): Box | null {
  const box = element.getBoundingClientRect();
  const origin = parent?.getBoundingClientRect();
  if (!origin || box.width === 0 || box.height === 0) return null;
  return { x: box.x - origin.x, y: box.y - origin.y, width: box.width, height: box.height };
}
