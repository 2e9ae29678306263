// Small charts put numbers where their axes say, and ticks at round numbers inside them.
import { describe, expect, it } from "vitest";
import { nearestPoint, orderAlongX } from "../src/fit/plot/nearest_point.ts";
import type { PointsMark } from "../src/fit/plot/marks.ts";
import { makeScale, place, roundStep, scaleOf, tickValues, valueAt } from "../src/fit/plot/scale.ts";
import { bandPath, dotPath, linePath } from "../src/fit/plot/trace.ts";

describe("scales", () => {
  it("place the geometric mean in the middle of a logarithmic axis, and undo it", () => {
    const scale = makeScale(1, 1e4, true);
    expect(place(scale, 100)).toBeCloseTo(0.5, 12);
    expect(valueAt(scale, 0.25)).toBeCloseTo(10, 9);
    expect(valueAt(makeScale(-2, 6), place(makeScale(-2, 6), 1.7))).toBeCloseTo(1.7, 12);
  });

  it("are linear where a logarithm does not exist, and never of no length", () => {
    expect(makeScale(0, 5, true).log).toBe(false);
    expect(makeScale(-1, 5, true).log).toBe(false);
    for (const value of [0, 3, -3, NaN]) {
      const scale = makeScale(value, value);
      expect(scale.high).toBeGreaterThan(scale.low);
    }
  });

  it("hold all finite numbers with air around them", () => {
    const scale = scaleOf([1, NaN, 3, Infinity], 0.1);
    expect([scale.low, scale.high]).toEqual([0.8, 3.2]);
    expect(scaleOf([])).toMatchObject({ low: 0, high: 1 });
    expect(scaleOf([-1, 0, 10, 1000], 0, true)).toEqual({ low: 10, high: 1000, log: true });
  });

  it("have ticks at steps of 1, 2 or 5, and at decades", () => {
    expect(tickValues(makeScale(0, 60), 4)).toEqual([0, 20, 40, 60]);
    expect(tickValues(makeScale(0.31, 0.499), 4)).toEqual([0.35, 0.4, 0.45]);
    expect(tickValues(makeScale(100, 1e5, true), 4)).toEqual([100, 1000, 1e4, 1e5]);
    expect(tickValues(makeScale(1e-8, 1e8, true), 4)).toEqual([1e-8, 1e-4, 1, 1e4, 1e8]);
    expect(roundStep(0.021)).toBeCloseTo(0.05, 12);
  });

  it("show at least one tick wherever the axis lies", () => {
    for (const high of [1.03, 1.4, 2.5, 9, 30, 1e3, 1e7]) {
      const ticks = tickValues(makeScale(1.01, high, true), 3);
      expect(ticks.length, `to ${high}`).toBeGreaterThan(0);
      expect(ticks.every((tick) => tick >= 1.01 * (1 - 1e-9) && tick <= high * (1 + 1e-9))).toBe(true);
    }
  });
});

describe("paths", () => {
  const unit = makeScale(0, 1);

  it("start anew after a gap and leave out points that would not be told apart", () => {
    expect(linePath([0, 0.5, NaN, 0.6, 1], [0, 1, 0, 0, 1], unit, unit)).toBe("M0 1000L500 0M600 1000L1000 0");
    expect(linePath([0, 1e-5, 2e-5, 1], [0, 0, 0, 0], unit, unit)).toBe("M0 1000L1000 1000");
  });

  it("make dots of lines without length and bands open to the end of the axis", () => {
    expect(dotPath([0.5, NaN], [0.25, 0], unit, unit)).toBe("M500 750h0");
    expect(bandPath([0.2, null], [null, null], unit, unit)).toBe("M200 1000H1000V0H200Z");
  });

  it("keep coordinates of far points in what a browser draws", () => {
    const largest = linePath([0, 1], [0, 1e12], unit, unit)
      .split(/[ML ]/)
      .map((part) => Math.abs(Number(part)));
    expect(Math.max(...largest)).toBeLessThanOrEqual(20_000);
  });
});

describe("the point meant", () => {
  const marks: PointsMark[] = [
    { kind: "dots", className: "", name: "a", x: [0, 1], y: [0, 1] },
    { kind: "dots", className: "", name: "b", x: [0.5, NaN], y: [0.5, 0] },
  ];
  const unit = makeScale(0, 1);

  it("is the nearest one in pixels, none where all are far", () => {
    const box = { width: 100, height: 50 };
    expect(nearestPoint(marks, unit, unit, 97, 4, box)).toMatchObject({ index: 1, mark: { name: "a" } });
    expect(nearestPoint(marks, unit, unit, 52, 25, box)).toMatchObject({ index: 0, mark: { name: "b" } });
    expect(nearestPoint(marks, unit, unit, 97, 40, box, 20)).toBeNull();
  });

  it("moves from left to right with the arrow keys, over gaps", () => {
    expect(orderAlongX(marks).map(({ mark, index }) => `${mark.name}${index}`)).toEqual(["a0", "b0", "a1"]);
  });
});
