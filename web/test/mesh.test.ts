// The recorded motion is decoded, interpolated and played back as it was.
import { describe, expect, it } from "vitest";
import { interpolate } from "../src/mesh3d/interpolate.ts";
import { speedsFor } from "../src/mesh3d/player.ts";
import { sectionOf } from "../src/mesh3d/field_cap.ts";
import { Timeline } from "../src/mesh3d/timeline.ts";
import * as THREE from "three";

const base64 = (bytes: ArrayBufferView) =>
  btoa(String.fromCharCode(...new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength)));

const frame = (time: number, uz: number) => ({
  time_s: time,
  instruments: [],
  displacement_scale_m: 0.01,
  intensity_max: 0.5,
  displacement: base64(Int16Array.from([0, 0, Math.round((uz / 0.01) * 32767), 0, 0, 0, 0, 0, 0])),
  intensity: base64(Uint8Array.from([Math.round((-uz / 0.01) * 255), 0, 0])),
});

const surface = {
  vertices: 3,
  triangles: base64(Uint32Array.from([0, 1, 2, 0, 1, 9])),
  rest: base64(Float32Array.from([0, 0, 1, 1, 0, 0, 0, 1, 0])),
  fixed: base64(Uint8Array.from([2, 1, 1])),
  instruments: [],
  frames: [frame(0, 0), frame(1, -0.004), frame(2, -0.008)],
};

function zAt(time: number, exaggeration = 1): number {
  const positions = new Float32Array(9);
  new Timeline(surface).sample(time, exaggeration, positions, new Float32Array(3));
  return positions[2]!;
}

describe("timeline", () => {
  it("gives each frame at its time and straight lines between", () => {
    // 16-bit steps of a 0.01 m scale are 3e-7 m, floats at 1 m carry 6e-8
    expect(zAt(1)).toBeCloseTo(0.996, 6);
    expect(zAt(1.5)).toBeCloseTo(0.994, 6);
    expect([zAt(-1), zAt(9)].map((z) => Number(z.toFixed(5)))).toEqual([1, 0.992]);
  });

  it("exaggerates the displacement, not the position", () => {
    expect(zAt(1, 10)).toBeCloseTo(0.96, 5);
  });

  it("leaves out triangles that name vertices which are not there", () => {
    expect([...new Timeline(surface).triangles]).toEqual([0, 1, 2]);
  });

  it("is the rest shape where no frames were recorded or their data is short", () => {
    const still = new Timeline({ ...surface, frames: [] });
    expect(still.recorded).toBe(false);
    const positions = new Float32Array(9);
    still.sample(0, 5, positions, new Float32Array(3));
    expect([...positions]).toEqual([0, 0, 1, 1, 0, 0, 0, 1, 0]);
    const short = new Timeline({ ...surface, frames: [{ ...frame(0, -0.004), displacement: "AAA=", intensity: "" }] });
    expect(short.frames[0]!.displacement.length).toBe(9);
    expect(short.spanAt(0, false)).toEqual({ low: 0, high: 0 });
  });
});

describe("playback", () => {
  it("offers speeds at which any motion lasts a few seconds", () => {
    for (const duration of [0.02, 0.3, 1.1, 5, 60, 900]) {
      const { speeds, preferred } = speedsFor(duration);
      expect(speeds).toContain(preferred);
      expect(speeds).toContain(1);
      expect(duration / preferred).toBeGreaterThan(0.35);
      expect(duration / preferred).toBeLessThan(13);
    }
    expect(speedsFor(0).preferred).toBe(1);
  });

  it("reads quantities between samples", () => {
    expect(interpolate([0, 1, 2], [0, 10, 40], 1.5)).toBe(25);
    expect(interpolate([0, 1], [3, 4], 9)).toBe(4);
    expect(interpolate([], [], 1)).toBeNaN();
  });
});

describe("fields of a timeline", () => {
  const field = { low: -2, high: 3, values: base64(Uint8Array.from([0, 102, 255])) };
  const frames = [
    { ...frame(0, 0), fields: { pressure: field } },
    { ...frame(1, -0.004), fields: { pressure: field } },
  ];
  const values = (name: "pressure" | "displacement", time: number) => {
    const timeline = new Timeline({ ...surface, frames });
    timeline.field = name;
    const read = new Float32Array(3);
    timeline.sample(time, 1, new Float32Array(9), read);
    return [...read];
  };

  it("are those that were recorded, in their range, and the displacement's length", () => {
    expect(values("pressure", 0.5)).toEqual([-2, 0, 3].map((value) => expect.closeTo(value, 6)));
    expect(values("displacement", 1)).toEqual([0.004, 0, 0].map((value) => expect.closeTo(value, 6)));
  });

  it("have a range at the surface, and another with what is inside", () => {
    const inner = {
      ...surface,
      vertices: 4,
      rest: base64(new Float32Array(12)),
      tets: base64(Uint32Array.from([0, 1, 2, 3])),
    };
    const bytes = base64(Uint8Array.from([0, 0, 51, 255]));
    const timeline = new Timeline({
      ...inner,
      frames: [{ ...frame(0, 0), fields: { von_mises: { low: 0, high: 10, values: bytes } } }],
    });
    timeline.field = "von_mises";
    expect(timeline.span(false).high).toBeCloseTo(2, 6);
    expect(timeline.span(true).high).toBeCloseTo(10, 6);
    expect([...timeline.tetsAt(0)!]).toEqual([0, 1, 2, 3]);
  });
});

describe("the face of a body that is cut open", () => {
  // Six tets about a diagonal of the unit cube.
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1, (i >> 1) & 1, (i >> 2) & 1]);
  const tets = [
    [1, 3],
    [1, 5],
    [2, 3],
    [2, 6],
    [4, 5],
    [4, 6],
  ].flatMap(([a, b]) => [0, a!, b!, 7]);
  const area = (points: number[]) => {
    let sum = 0;
    for (let i = 0; i < points.length; i += 9) {
      const [a, b, c] = [0, 3, 6].map((k) => new THREE.Vector3().fromArray(points, i + k)) as [
        THREE.Vector3,
        THREE.Vector3,
        THREE.Vector3,
      ];
      sum += b.sub(a).cross(c.sub(a)).length() / 2;
    }
    return sum;
  };

  it("has the area of the section and a linear field exactly", () => {
    for (const normal of [new THREE.Vector3(0, 0, 1), new THREE.Vector3(1, 2, 3).normalize()]) {
      const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, new THREE.Vector3(0.5, 0.4, 0.3));
      const { points, values } = sectionOf(
        plane,
        corners.flat(),
        corners.map(([x, y, z]) => x! - 2 * y! + z!),
        tets,
      );
      values.forEach((value, i) => {
        const [x, y, z] = points.slice(3 * i, 3 * i + 3);
        expect(value).toBeCloseTo(x! - 2 * y! + z!, 12);
        expect(Math.abs(plane.distanceToPoint(new THREE.Vector3(x, y, z)))).toBeLessThan(1e-12);
      });
      if (normal.z === 1) expect(area(points)).toBeCloseTo(1, 12);
      else expect(area(points)).toBeGreaterThan(1);
    }
    expect(
      sectionOf(
        new THREE.Plane(new THREE.Vector3(0, 0, 1), -5),
        corners.flat(),
        corners.map(() => 0),
        tets,
      ).values,
    ).toEqual([]);
  });
});
