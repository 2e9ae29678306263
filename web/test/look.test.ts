// The look: what keys and storage make of it, what a fold sees of the sky, how long the bar is, where numbers stand.
import { describe, expect, it } from "vitest";
import { freePlace } from "../src/mesh3d/force_arrow.ts";
import { firstLook, isLook, lookKey, TISSUE } from "../src/mesh3d/look.ts";
import { Pace } from "../src/mesh3d/drawing_speed.ts";
import { DisplaySurface } from "../src/mesh3d/display_surface.ts";
import { directionsFor, skyShare } from "../src/mesh3d/occlusion.ts";
import { mottles } from "../src/mesh3d/mottle.ts";
import { lengthText, roundLength } from "../src/mesh3d/scale_bar.ts";
import { coloursOf, regionColours } from "../src/mesh3d/tissue_colours.ts";
import { lookupOf } from "../src/mesh3d/tissue_material.ts";
import { ball, box } from "./shapes.ts";

describe("the look", () => {
  it("is tissue at first, whole, and as fine as is fast", () =>
    expect(firstLook()).toEqual({ colour: TISSUE, seeThrough: false, detail: "auto" }));

  it("changes by keys: f to the field and back, g through the surface and back", () => {
    const look = firstLook();
    expect(lookKey("f", look, "intensity") && look.colour).toBe("intensity");
    expect(lookKey("f", look, "intensity") && look.colour).toBe(TISSUE);
    expect(lookKey("g", look, "intensity") && look.seeThrough).toBe(true);
    expect(lookKey("c", look, "intensity")).toBe(false);
  });

  it("is taken from storage only where it is one", () => {
    const colours = [TISSUE, "intensity"];
    expect(isLook({ colour: "intensity", seeThrough: true, detail: "plain" }, colours)).toBe(true);
    for (const odd of [null, 3, "fine", {}, { ...firstLook(), colour: "heat" }, { ...firstLook(), detail: "most" }])
      expect(isLook(odd, colours)).toBe(false);
  });

  it("becomes plain after many late drawings, not after one, and not where there was nothing to draw", () => {
    const after = (interval: number, count: number) => {
      const pace = new Pace();
      return Array.from({ length: count }, (_, i) => pace.tooSlow(10_000 + interval * i)).some(Boolean);
    };
    expect(after(60, 40)).toBe(true);
    expect(after(60, 8)).toBe(false);
    expect(after(17, 400)).toBe(false);
    expect(after(3000, 40)).toBe(false);
  });
});

describe("the sky over a surface", () => {
  const over = (shape: ReturnType<typeof box>) => {
    const surface = new DisplaySurface(shape.rest, shape.triangles, null, false);
    return { surface, sky: skyShare(surface.positions, surface.normals, surface.triangles, 48) };
  };

  it("is whole on what is convex", () => {
    for (const shape of [ball(8, 0.1), box(5, [0.04, 0.02, 0.08])])
      expect(Math.min(...over(shape).sky)).toBeGreaterThan(0.97);
  });

  it("is a half in the corner of a step, by the walls' own symmetry", () => {
    // A floor z = 0 and a wall x = 0, both 2 wide and far: at the middle of their common edge half of the floor's sky is hidden.
    const n = 20;
    const points: number[] = [];
    const triangles: number[] = [];
    const sheet = (at: (u: number, v: number) => number[]) => {
      const first = points.length / 3;
      for (let i = 0; i <= n; i++) for (let k = 0; k <= n; k++) points.push(...at(i / n, k / n));
      for (let i = 0; i < n; i++)
        for (let k = 0; k < n; k++) {
          const a = first + i * (n + 1) + k;
          triangles.push(a, a + n + 1, a + n + 2, a, a + n + 2, a + 1);
        }
    };
    sheet((u, v) => [2 * u, 2 * v - 1, 0]);
    sheet((u, v) => [0, 2 * v - 1, 2 * u]);
    const normals = Float32Array.from(points, (_, i) => {
      const wall = i >= points.length / 2;
      return i % 3 === (wall ? 0 : 2) ? 1 : 0;
    });
    const sky = skyShare(Float32Array.from(points), normals, Uint32Array.from(triangles), 400);
    const nearEdge = n + 1 + n / 2; // 0.1 from the wall, which is 2 high
    expect(sky[nearEdge]!).toBeGreaterThan(0.45);
    expect(sky[nearEdge]!).toBeLessThan(0.65);
    expect(sky[n * (n + 1) + n / 2]!).toBeGreaterThan(0.8); // far from it
  });

  it("costs no more directions than a large surface affords, and no less than show a fold", () => {
    expect(directionsFor(100, 400_000)).toBe(48);
    expect(directionsFor(20_000, 400_000)).toBe(20);
    expect(directionsFor(1e6, 400_000)).toBe(8);
  });
});

describe("the bar of scale", () => {
  it("is the longest of 1, 2, 5 × 10ⁿ that fits, at its true length", () => {
    for (const [perPixel, metres] of [
      [1e-4, 0.01],
      [2.1e-4, 0.02],
      [5e-4, 0.05],
      [1e-6, 1e-4],
    ] as const) {
      const bar = roundLength(perPixel, 110);
      expect(bar.metres).toBeCloseTo(metres, 12);
      expect(bar.pixels).toBeCloseTo(metres / perPixel, 9);
      expect(bar.pixels).toBeLessThanOrEqual(110);
      expect(bar.pixels).toBeGreaterThan(40);
    }
    expect(roundLength(NaN).metres).toBe(0);
  });

  it("names its unit", () =>
    expect([2, 0.05, 0.001, 2e-5].map(lengthText)).toEqual(["2\u00a0m", "50\u00a0mm", "1\u00a0mm", "20\u00a0µm"]));
});

describe("a number beside an arrow", () => {
  const own = { width: 60, height: 20 };
  const room = { width: 360, height: 260 };
  const inside = (p: { x: number; y: number }) =>
    p.x >= 0 && p.y >= 0 && p.x + own.width <= room.width && p.y + own.height <= room.height;

  it("stays within the view, wherever the arrow ends", () => {
    for (const at of [
      { x: -80, y: 40 },
      { x: 500, y: 130 },
      { x: 180, y: -20 },
      { x: 180, y: 400 },
    ])
      expect(inside(freePlace(at, own, room, [])!)).toBe(true);
  });

  it("stands across the arrow, not on it", () => {
    const at = { x: 180, y: 130 };
    const level = freePlace(at, own, room, [], { x: 50, y: 3 })!;
    expect(level.y + own.height <= at.y || level.y >= at.y).toBe(true);
    const upright = freePlace(at, own, room, [], { x: -4, y: 60 })!;
    expect(upright.x + own.width <= at.x || upright.x >= at.x).toBe(true);
  });

  it("keeps off what is written there, and is left out where there is no room", () => {
    const scale = { x: 250, y: 0, width: 110, height: 200 };
    const place = freePlace({ x: 240, y: 100 }, own, room, [scale])!;
    expect(place.x + own.width <= scale.x || place.y >= scale.height).toBe(true);
    expect(freePlace({ x: 100, y: 100 }, own, room, [{ x: 0, y: 0, ...room }])).toBeNull();
  });
});

describe("mottles", () => {
  const points = Float32Array.from({ length: 3 * 4000 }, (_, i) => 0.1 * (((i * 7919) % 4001) / 4001));

  it("vary about a half, neither flat nor beyond the scale, and are the same each time", () => {
    const values = mottles(points, 0.17);
    const mean = values.reduce((sum, x) => sum + x, 0) / values.length;
    expect(mean).toBeGreaterThan(0.42);
    expect(mean).toBeLessThan(0.58);
    expect(Math.min(...values)).toBeGreaterThanOrEqual(0);
    expect(Math.max(...values)).toBeLessThanOrEqual(1);
    expect(Math.max(...values) - Math.min(...values)).toBeGreaterThan(0.4);
    expect(mottles(points, 0.17)).toEqual(values);
  });

  it("go by the body's size: twice as large, twice as broad", () =>
    expect(
      mottles(
        points.map((x) => 2 * x),
        0.34,
      ),
    ).toEqual(mottles(points, 0.17)));

  it("are continuous, across the cells of the lattice, too", () => {
    const line = Float32Array.from({ length: 3 * 2001 }, (_, i) => (i % 3 === 0 ? i / 6000 : 0.03));
    const values = mottles(line, 1);
    for (let i = 1; i < values.length; i++) expect(Math.abs(values[i]! - values[i - 1]!)).toBeLessThan(0.02);
  });
});

describe("colours of tissue", () => {
  it("go by the names of regions, and never hide one in the liver", () => {
    expect(coloursOf("liver")).toEqual(coloursOf(""));
    expect(regionColours("Portal vein", 0)).toEqual(coloursOf("portal veins"));
    const unnamed = [0, 1, 2].map((i) => regionColours(`region ${i}`, i).tissue);
    expect(new Set([...unnamed, coloursOf("").tissue]).size).toBe(4);
  });

  it("of a scale end in the middles of its first and last texel", () => {
    expect([lookupOf(0) * 256, lookupOf(1) * 256, lookupOf(9) * 256]).toEqual([0.5, 255.5, 255.5]);
  });
});
