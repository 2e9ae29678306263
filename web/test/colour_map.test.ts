// The colour map keeps the order and the spacing of numbers for every kind of eye.
import { describe, expect, it } from "vitest";
import { barTicks } from "../src/mesh3d/colour_bar.ts";
import { colourGradient, colourOf, colourTexels, type Rgb } from "../src/mesh3d/colour_map.ts";

/** OKLab of an sRGB colour, by the published matrices (Ottosson 2020). */
function oklab([r, g, b]: Rgb): [number, number, number] {
  const linear = (v: number) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4);
  const [R, G, B] = [linear(r), linear(g), linear(b)];
  const l = Math.cbrt(0.4122214708 * R + 0.5363325363 * G + 0.0514459929 * B);
  const m = Math.cbrt(0.2119034982 * R + 0.6806995451 * G + 0.1073969566 * B);
  const s = Math.cbrt(0.0883024619 * R + 0.2817188376 * G + 0.6299787005 * B);
  return [
    0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
  ];
}

const samples = Array.from({ length: 33 }, (_, n) => oklab(colourOf(n / 32)));

describe("colour map", () => {
  it("rises in lightness all the way, from dark to light", () => {
    for (let n = 1; n < samples.length; n++) expect(samples[n]![0]).toBeGreaterThan(samples[n - 1]![0]);
    expect(samples[0]![0]).toBeLessThan(0.42);
    expect(samples[32]![0]).toBeGreaterThan(0.9);
  });

  it("has steps of equal distance in OKLab within 12 %", () => {
    // 8-bit rounding of a channel is up to 0.3 % of the path; a step is 3 % of it.
    const steps = samples.slice(1).map((lab, n) => Math.hypot(...lab.map((v, k) => v - samples[n]![k]!)));
    const mean = steps.reduce((sum, step) => sum + step, 0) / steps.length;
    for (const step of steps) expect(Math.abs(step / mean - 1)).toBeLessThan(0.12);
  });

  it("clamps what lies outside and takes NaN for the low end", () => {
    expect(colourOf(-1)).toEqual(colourOf(0));
    expect(colourOf(NaN)).toEqual(colourOf(0));
    expect(colourOf(7)).toEqual(colourOf(1));
  });

  it("fills textures with opaque texels whose ends are the ends of the map", () => {
    const texels = colourTexels(16);
    expect([...texels.slice(0, 4)]).toEqual([...colourOf(0), 255]);
    expect([...texels.slice(60)]).toEqual([...colourOf(1), 255]);
    expect(colourGradient("to top")).toMatch(/^linear-gradient\(to top, #/);
  });
});

describe("colour bar", () => {
  it("has round numbers that start at 0 and stay inside the range", () => {
    const { values, increment } = barTicks(0.47);
    expect(values[0]).toBe(0);
    expect(increment).toBeCloseTo(0.2, 12);
    expect(Math.max(...values)).toBeLessThanOrEqual(0.47 * 1.0001);
    expect(barTicks(1).values.length).toBeGreaterThanOrEqual(4);
  });

  it("has round numbers between two that are not", () => {
    expect(barTicks(130, -260).values).toEqual([-200, -100, 0, 100]);
    expect(barTicks(1, 0.873).values.map((v) => v.toFixed(2))).toEqual(["0.90", "0.95", "1.00"]);
  });

  it("copes with a range of nothing", () => {
    expect(barTicks(0).values).toEqual([0]);
    expect(barTicks(NaN).values).toEqual([0]);
  });
});
