// The recorded motion is decoded, interpolated and played back as it was.
import { describe, expect, it } from "vitest";
import { interpolate } from "../src/mesh3d/interpolate.ts";
import { speedsFor } from "../src/mesh3d/player.ts";
import { Timeline } from "../src/mesh3d/timeline.ts";

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
    expect(short.intensityAt(0)).toBe(0);
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
