// A plane takes away what lies before it and nothing else, stands where it says, and hides what it took from the hand.
import * as THREE from "three";
import { describe, expect, it } from "vitest";
import { type ClipSettings, clipKey, clipPlace, clipPlane, clipShare, firstSeen } from "../src/mesh3d/clip.ts";

const body = {
  box: new THREE.Box3(new THREE.Vector3(0, 0, 0), new THREE.Vector3(0.04, 0.02, 0.08)),
  heart: new THREE.Vector3(0.01, 0.01, 0.06),
};
const ahead = new THREE.Vector3(-0.6, 0.8, 0);
const settings = (more: Partial<ClipSettings>): ClipSettings => ({
  on: true,
  axis: "y",
  at: null,
  flipped: false,
  ...more,
});
const kept = (s: ClipSettings, x: number, y: number, z: number): boolean =>
  clipPlane(s, body, ahead)!.distanceToPoint(new THREE.Vector3(x, y, z)) >= 0;

describe("the plane", () => {
  it("is none while the body is closed", () => expect(clipPlane(settings({ on: false }), body, ahead)).toBeNull());

  it("goes through the heart at first, and takes what is towards the home view", () => {
    expect(clipPlace(settings({ axis: "x" }), body)).toBeCloseTo(0.01, 12);
    expect(kept(settings({ axis: "x" }), 0.009, 0, 0)).toBe(true);
    expect(kept(settings({ axis: "x" }), 0.011, 0, 0)).toBe(false);
    expect(kept(settings({}), 0, 0.011, 0)).toBe(true);
    expect(kept(settings({}), 0, 0.009, 0)).toBe(false);
    expect(kept(settings({ axis: "z" }), 0, 0, 0.059)).toBe(true);
    expect(kept(settings({ axis: "z" }), 0, 0, 0.061)).toBe(false);
  });

  it("takes the other side when it is flipped", () =>
    expect(kept(settings({ axis: "x", flipped: true }), 0.011, 0, 0)).toBe(true));

  it("stands at a share of the way through", () => {
    expect(clipPlace(settings({ axis: "z", at: 0.25 }), body)).toBeCloseTo(0.02, 12);
    expect(clipPlace(settings({ axis: "x", at: 1 }), body)).toBeCloseTo(0.04, 12);
  });

  it("stands across the view wherever one looks from, its near side taken", () => {
    const middle = new THREE.Vector3(0.02, 0.01, 0.04);
    const plane = clipPlane(settings({ axis: "view" }), body, ahead)!;
    expect(plane.distanceToPoint(middle)).toBeCloseTo(0, 12);
    expect(plane.distanceToPoint(middle.clone().add(ahead))).toBeCloseTo(1, 12);
  });

  it("of an instrument outside the body stays within it", () => {
    const outside = { ...body, heart: new THREE.Vector3(0.01, 0.01, 0.2) };
    expect(clipShare(settings({ axis: "z" }), outside)).toBe(1);
  });
});

describe("keys", () => {
  it("open, choose, move within the body, and leave all others alone", () => {
    const s = settings({ on: false });
    expect(clipKey("x", s, body)).toBe(false);
    expect(clipKey("c", s, body) && s.on).toBe(true);
    expect(clipKey("v", s, body) && s.axis).toBe("view");
    expect(clipKey("z", s, body) && s.axis).toBe("z");
    expect(clipKey("[", s, body)).toBe(true);
    expect(s.at).toBeCloseTo(0.75 - 0.02, 12);
    for (let i = 0; i < 60; i++) clipKey("[", s, body);
    expect(s.at).toBe(0);
    expect(clipKey("q", s, body)).toBe(false);
  });
});

describe("what is seen under a ray", () => {
  const box = new THREE.Mesh(new THREE.BoxGeometry(1, 1, 1), new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }));
  const from = (x: number, y: number, z: number, along: THREE.Vector3) => {
    const caster = new THREE.Raycaster(new THREE.Vector3(x, y, z), along.normalize());
    return { hits: caster.intersectObject(box), ray: caster.ray };
  };
  const plane = new THREE.Plane(new THREE.Vector3(-1, 0, 0), 0); // x > 0 is taken away

  it("is the nearest skin of a closed body", () => {
    const { hits, ray } = from(3, 0.1, 0.1, new THREE.Vector3(-1, 0, 0));
    expect(firstSeen(hits, null, ray).distance).toBeCloseTo(2.5, 12);
  });

  it("is the cut, not the skin behind it nor that which was taken away", () => {
    const { hits, ray } = from(3, 0.1, 0.1, new THREE.Vector3(-1, 0, 0));
    const seen = firstSeen(hits, plane, ray);
    expect(seen.hit).toBeNull();
    expect(seen.distance).toBeCloseTo(3, 12);
  });

  it("is skin that stays, seen from the other side", () => {
    const { hits, ray } = from(-3, 0.1, 0.1, new THREE.Vector3(1, 0, 0));
    expect(firstSeen(hits, plane, ray).hit?.distance).toBeCloseTo(2.5, 12);
  });

  it("is nothing where all that the ray meets was taken away", () => {
    const { hits, ray } = from(0.3, 0.1, 3, new THREE.Vector3(0, 0, -1));
    expect(firstSeen(hits, plane, ray)).toEqual({ hit: null, distance: Infinity });
  });
});
