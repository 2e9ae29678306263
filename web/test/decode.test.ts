// The bytes of the contract come back as the numbers that were packed.
import { describe, expect, it } from "vitest";
import { decodeF32, decodeI16Scaled, decodeU32, decodeU8, decodeU8Scaled } from "../src/data/decode.ts";

/** Little-endian bytes written by DataView, independent of the machine and of the code under test. */
function pack(size: number, values: number[], write: (view: DataView, at: number, value: number) => void): string {
  const view = new DataView(new ArrayBuffer(size * values.length));
  values.forEach((value, index) => write(view, index * size, value));
  return btoa(String.fromCharCode(...new Uint8Array(view.buffer)));
}

describe("decode", () => {
  it("reads little-endian u32 beyond 16 bits", () => {
    const text = pack(4, [0, 1, 65536, 4294967295], (view, at, value) => view.setUint32(at, value, true));
    expect([...decodeU32(text)]).toEqual([0, 1, 65536, 4294967295]);
  });

  it("reads f32 to the bit", () => {
    const values = [0, -0.5, 0.0123, 3.4e38].map(Math.fround);
    expect([...decodeF32(pack(4, values, (view, at, value) => view.setFloat32(at, value, true)))]).toEqual(values);
  });

  it("undoes the 16-bit quantisation within half a step of the scale", () => {
    const scale = 0.01;
    const metres = [-0.01, -0.00333, 0, 0.0071, 0.01];
    const text = pack(
      2,
      metres.map((u) => Math.round((u / scale) * 32767)),
      (view, at, value) => view.setInt16(at, value, true),
    );
    decodeI16Scaled(text, scale).forEach((value, index) => {
      expect(Math.abs(value - metres[index]!)).toBeLessThanOrEqual((0.5 * scale) / 32767 + 1e-9);
    });
  });

  it("undoes the 8-bit quantisation: 255 is the maximum exactly", () => {
    const values = decodeU8Scaled(btoa(String.fromCharCode(0, 51, 255)), 0.4);
    expect(values[0]).toBe(0);
    expect(values[1]).toBeCloseTo(0.08, 7);
    expect(values[2]).toBe(Math.fround(0.4));
  });

  it("gives nothing for missing or damaged text, and drops bytes short of a number", () => {
    expect(decodeU8(undefined).length).toBe(0);
    expect(decodeU8("not base64!").length).toBe(0);
    expect(decodeU32(btoa("abcde")).length).toBe(1);
  });
});
