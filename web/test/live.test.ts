// What the live page reads and writes are the bytes that apps/view/ writes and reads.
import { describe, expect, test } from "vitest";
import { History } from "../src/live/history.ts";
import { decodeMessage, encodeCommand } from "../src/live/protocol.ts";

const bytes = (buffer: ArrayBuffer) => Array.from(new Uint8Array(buffer));

describe("commands", () => {
  test("have the layout of docs/view.md", () => {
    expect(bytes(encodeCommand({ kind: "pause", index: 1 }, 0x01020304))).toEqual([6, 0, 0, 0, 4, 3, 2, 1, 1, 0, 0, 0]);
    const place = encodeCommand({ kind: "place", tool: 2, values: [0.5, -1, 2] }, 7);
    expect(place.byteLength).toBe(20);
    expect(new DataView(place).getUint8(1)).toBe(2);
    expect(new DataView(place).getFloat32(12, true)).toBe(-1);
    const grab = encodeCommand({ kind: "grab", index: 9, values: [1, 2, 3] }, 7);
    expect([grab.byteLength, new DataView(grab).getUint32(8, true), new DataView(grab).getFloat32(20, true)]).toEqual([
      24, 9, 3,
    ]);
    expect(encodeCommand({ kind: "reset" }, 1).byteLength).toBe(8);
  });
});

/** A frame with one tool of one point and two vertices. */
function frame(): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(60 + 68 + 14));
  view.setUint8(0, 2);
  view.setUint8(1, 1 | 8);
  view.setUint16(2, 1, true);
  [5, 3, 42].forEach((value, i) => view.setUint32(4 + 4 * i, value, true));
  view.setFloat64(16, 1.5, true);
  view.setFloat32(52, 0.01, true); // reach
  view.setFloat32(56, 0.5, true); // strongest
  view.setFloat32(60, 0.004, true); // depth of the tool
  view.setFloat32(72, -2, true); // its force along z
  view.setUint32(112, 1, true);
  view.setFloat32(116, 7, true);
  view.setInt16(128 + 2, -32767, true);
  view.setUint8(128 + 12 + 1, 255);
  return view.buffer;
}

describe("messages", () => {
  test("a frame is read whole", () => {
    const read = decodeMessage(frame());
    if (read?.kind !== "frame") throw new Error("no frame");
    expect([read.keyframe, read.epoch, read.echo, read.time]).toEqual([5, 3, 42, 1.5]);
    expect([read.paused, read.building, read.grabbing]).toEqual([true, false, true]);
    expect(read.tools[0]!.depth).toBeCloseTo(0.004);
    expect(read.tools[0]!.force).toEqual([0, 0, -2]);
    expect(read.tools[0]!.points).toEqual([7, 0, 0]);
    expect(Array.from(read.displacement)).toEqual([0, -32767, 0, 0, 0, 0]);
    expect(Array.from(read.intensity)).toEqual([0, 255]);
  });

  test("what is cut short, or of another kind, is none", () => {
    for (let length = 0; length < 128; length++) expect(decodeMessage(frame().slice(0, length))).toBeNull();
    expect(decodeMessage(new Uint8Array(64).fill(9).buffer)).toBeNull();
  });
});

describe("history", () => {
  const samples = (epoch: number, ...times: number[]) => ({
    kind: "samples" as const,
    tools: 1,
    rows: times.map((time) => ({ epoch, time, depth: [time / 10], force: [2 * time] })),
  });

  test("keeps one body's forces, each once", () => {
    const history = new History(1);
    history.add(samples(0, 0.001, 0.002));
    history.add(samples(0, 0.002, 0.003)); // a line that was cut brings some again
    expect(history.time).toEqual([0.001, 0.002, 0.003]);
    history.add(samples(1, 0.001));
    history.add(samples(0, 0.004));
    expect(history.time).toEqual([0.001]);
    expect(history.csv(["needle"])).toBe("time_s,needle_depth_m,needle_force_N\n0.001,0.0001,0.002\n");
  });
});
