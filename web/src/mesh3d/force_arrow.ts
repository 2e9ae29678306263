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
const EDGE = 16; // CSS pixels that an arrow keeps from the edge of the picture
const SHORTENED = 0.25; // of its length that an arrow keeps at least

/** A force in newtons as it is written beside the arrow and in panels, so that both agree. */
export const forceText = (force: number): string => formatSignificant(force, 3);

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
  private presses = true;
  private headLength = 0;
  private thickness = 0;

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
    this.group.quaternion.copy(turn);
    this.presses = presses;
    this.headLength = head;
    this.thickness = THICK * size;
    this.tip.copy(now.at);
    this.tail.copy(presses ? from : from.addScaledVector(along, length));
    this.lay();
    this.label.textContent = `${forceText(strength)}\u00a0N`;
  }

  /** To be called before a drawing: an arrow whose free end would lie beside the picture is drawn shorter, and where the place that it
   * acts on has left the picture, at its edge. */
  keepInside(stage: Stage): void {
    if (!this.group.visible) return;
    const { width, height } = stage.size;
    const within = (p: { x: number; y: number }) =>
      p.x >= EDGE && p.x <= width - EDGE && p.y >= EDGE && p.y <= height - EDGE;
    const tip = stage.toScreen(this.tip);
    if (!within(tip)) {
      const to = {
        x: Math.min(width - EDGE, Math.max(EDGE, tip.x)),
        y: Math.min(height - EDGE, Math.max(EDGE, tip.y)),
      };
      const shift = stage.fromScreen(to, this.tip).sub(this.tip);
      this.tip.add(shift);
      this.tail.add(shift);
    }
    let [inside, outside] = [0, 1];
    const at = (share: number) => this.tip.clone().lerp(this.tail, share);
    if (!within(stage.toScreen(this.tail))) {
      for (let i = 0; i < 12; i++) {
        const middle = (inside + outside) / 2;
        if (within(stage.toScreen(at(middle)))) inside = middle;
        else outside = middle;
      }
      this.tail.copy(at(Math.max(SHORTENED, inside)));
    }
    this.lay();
  }

  /** Shaft and head between tail and tip, as far apart as they are. */
  private lay(): void {
    const [from, to] = this.presses ? [this.tail, this.tip] : [this.tip, this.tail];
    const length = from.distanceTo(to);
    const head = Math.min(this.headLength, 0.9 * length);
    this.group.position.copy(from);
    this.shaft.scale.set(this.thickness, length - 0.9 * head, this.thickness);
    this.head.scale.set(0.34 * head, head, 0.34 * head);
    this.head.position.set(0, length, 0);
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
