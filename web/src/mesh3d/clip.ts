// clip.ts — the plane that cuts a body open: along an axis or across the line of sight, moved through the body.
//
//   home view looks from +x −y +z: the side taken away is the one towards it      x: x > at · y: y < at · z: z > at
//   "view"                         stands across the line of sight, wherever one looks from
import * as THREE from "three";

export const CLIP_AXES = ["x", "y", "z", "view"] as const;
export type ClipAxis = (typeof CLIP_AXES)[number];

export interface ClipSettings {
  on: boolean;
  axis: ClipAxis;
  at: number | null; // share of the way through the body, 0 … 1; null: through its heart
  flipped: boolean; // the other side is taken away
}

/** What a plane is laid through. */
export interface ClipBody {
  box: THREE.Box3;
  heart: THREE.Vector3; // tip of an instrument, or the middle
}

const KEPT: Record<"x" | "y" | "z", THREE.Vector3> = {
  x: new THREE.Vector3(-1, 0, 0),
  y: new THREE.Vector3(0, 1, 0),
  z: new THREE.Vector3(0, 0, -1),
};
const KEY_STEP = 0.02;

/** Where an axis enters and leaves the body [m]; across the view, by its radius from its middle. */
function reach(axis: ClipAxis, body: ClipBody): [number, number] {
  if (axis !== "view") return [body.box.min[axis], body.box.max[axis]];
  const radius = body.box.getSize(new THREE.Vector3()).length() / 2;
  return [-radius, radius];
}

/** The share at which the plane stands now. */
export function clipShare(settings: ClipSettings, body: ClipBody): number {
  if (settings.at !== null) return settings.at;
  if (settings.axis === "view") return 0.5;
  const [low, high] = reach(settings.axis, body);
  const share = high > low ? (body.heart[settings.axis] - low) / (high - low) : 0.5;
  return Math.min(1, Math.max(0, share));
}

/** Coordinate of the plane along its axis; across the view, how far behind the middle [m]. */
export function clipPlace(settings: ClipSettings, body: ClipBody): number {
  const [low, high] = reach(settings.axis, body);
  return low + clipShare(settings, body) * (high - low);
}

/** The plane, its normal into what stays; null where nothing is cut. @param forward  in which the eye looks */
export function clipPlane(settings: ClipSettings, body: ClipBody, forward: THREE.Vector3): THREE.Plane | null {
  if (!settings.on) return null;
  const place = clipPlace(settings, body);
  if (settings.axis === "view") {
    const through = body.box.getCenter(new THREE.Vector3()).addScaledVector(forward, place);
    return new THREE.Plane().setFromNormalAndCoplanarPoint(forward.clone(), through);
  }
  const normal = KEPT[settings.axis].clone().multiplyScalar(settings.flipped ? -1 : 1);
  const through = new THREE.Vector3();
  through[settings.axis] = place;
  return new THREE.Plane().setFromNormalAndCoplanarPoint(normal, through);
}

/** c opens and closes, x y z v choose, [ and ] move: whether a key was one of these. */
export function clipKey(key: string, settings: ClipSettings, body: ClipBody): boolean {
  const axis = key === "v" ? "view" : CLIP_AXES.find((name) => name === key);
  if (key === "c") settings.on = !settings.on;
  else if (!settings.on) return false;
  else if (axis) Object.assign(settings, { axis, at: null });
  else if (key === "[" || key === "]") {
    const moved = clipShare(settings, body) + (key === "]" ? KEY_STEP : -KEY_STEP);
    settings.at = Math.min(1, Math.max(0, moved));
  } else return false;
  return true;
}

/** What lies first under a ray: a point of the skin that can be seen, or where the ray goes into the cut. */
export function firstSeen(
  hits: readonly THREE.Intersection[],
  plane: THREE.Plane | null,
  ray: THREE.Ray,
): { hit: THREE.Intersection | null; distance: number } {
  const first = hits.find((hit) => plane === null || plane.distanceToPoint(hit.point) >= 0);
  if (!first) return { hit: null, distance: Infinity };
  // Skin that is met from within lies behind the cut: the ray went in through it.
  if (plane === null || !first.face || first.face.normal.dot(ray.direction) <= 0)
    return { hit: first, distance: first.distance };
  return { hit: null, distance: ray.distanceToPlane(plane) ?? first.distance };
}

const storeKey = (name: string): string => `glisson-cut:${location.pathname}:${name}`;

/** The settings of a view of that name as they were left, else `otherwise`. */
export function rememberedClip(name: string, otherwise: ClipSettings): ClipSettings {
  try {
    const kept: unknown = JSON.parse(localStorage.getItem(storeKey(name)) ?? "null");
    return isSettings(kept) ? kept : otherwise;
  } catch {
    return otherwise; // no storage, or something else in it
  }
}

export function rememberClip(name: string, settings: ClipSettings): void {
  try {
    localStorage.setItem(storeKey(name), JSON.stringify(settings));
  } catch {
    // no storage for this page: it lasts as long as the page
  }
}

function isSettings(kept: unknown): kept is ClipSettings {
  if (typeof kept !== "object" || kept === null) return false;
  const { on, axis, at, flipped } = kept as Partial<ClipSettings>;
  const place = at === null || (typeof at === "number" && at >= 0 && at <= 1);
  return typeof on === "boolean" && typeof flipped === "boolean" && place && CLIP_AXES.some((name) => name === axis);
}
