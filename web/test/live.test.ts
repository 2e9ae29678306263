// What the live page reads and writes are the bytes that apps/view/ writes and reads.
import { describe, expect, test } from "vitest";
import { ColourRange, valuesOf } from "../src/live/colouring.ts";
import { COLOURINGS, colouringOf, unitOf } from "../src/mesh3d/fields.ts";
import { History } from "../src/live/history.ts";
import { paceText } from "../src/live/pace.ts";
import { legsTo, Placing, startOf } from "../src/live/placing.ts";
import { decodeMessage, decodeText, encodeCommand } from "../src/live/protocol.ts";
import { rimOf } from "../src/mesh3d/vessel_model.ts";

const bytes = (buffer: ArrayBuffer) => Array.from(new Uint8Array(buffer));

describe("commands", () => {
  test("have the layout of docs/view.md", () => {
    expect(bytes(encodeCommand({ kind: "pause", index: 1 }, 0x01020304))).toEqual([6, 0, 0, 0, 4, 3, 2, 1, 1, 0, 0, 0]);
    const place = encodeCommand({ kind: "place", tool: 2, values: [0.5, -1, 2] }, 7);
    expect(place.byteLength).toBe(20);
    expect(new DataView(place).getUint8(1)).toBe(2);
    expect(new DataView(place).getFloat32(12, true)).toBe(-1);
    const grab = encodeCommand({ kind: "grab", tool: 0, index: 9, values: [1, 2, 3] }, 7);
    expect([grab.byteLength, new DataView(grab).getUint32(8, true), new DataView(grab).getFloat32(20, true)]).toEqual([
      24, 9, 3,
    ]);
    expect(encodeCommand({ kind: "reset" }, 1).byteLength).toBe(8);
    expect(bytes(encodeCommand({ kind: "visible", index: 0 }, 1))).toEqual([17, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0]);
    const cut = encodeCommand({ kind: "cut", index: 1, values: [1, 2, 3, 4, 5, 6] }, 7);
    expect([cut.byteLength, new DataView(cut).getUint8(0), new DataView(cut).getFloat32(32, true)]).toEqual([
      36, 13, 6,
    ]);
  });
});

/** A keyframe of three vertices and two triangles, one of them cut, with one region. */
function keyframe(): ArrayBuffer {
  const words = (text: string) => [...u32(text.length), ...new TextEncoder().encode(text), ...pad(text.length)];
  const u32 = (value: number) => [...new Uint8Array(Uint32Array.of(value).buffer)];
  const pad = (length: number) => new Array<number>((4 - (length % 4)) % 4).fill(0);
  const head = [1, 0, 0, 0, ...u32(7), ...u32(3), ...u32(2)];
  const body = [...new Array<number>(36).fill(0), ...[0, 1, 2, 0, 2, 1].flatMap(u32), 0, 2, 0];
  const inside = [0, 1, ...pad(5), ...words("liver"), ...u32(1), ...words("portal vein"), ...u32(1)];
  return Uint8Array.from([...head, ...body, ...inside, ...[2, 1, 0].flatMap(u32)]).buffer;
}

/** A frame with one tool of one point and two vertices. */
function frame(field = 3): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(64 + 76 + 14));
  view.setUint8(0, 2);
  view.setUint8(1, 1 | 8);
  view.setUint8(2, 1);
  view.setUint8(3, field);
  [5, 3, 42].forEach((value, i) => view.setUint32(4 + 4 * i, value, true));
  view.setFloat64(16, 1.5, true);
  view.setFloat32(52, 0.01, true); // reach
  view.setFloat32(56, -100, true); // from where to where the field goes
  view.setFloat32(60, 155, true);
  view.setFloat32(64, 0.004, true); // depth of the tool
  view.setFloat32(76, -2, true); // its force along z
  view.setFloat32(116, 0.5, true); // how far aside it is
  view.setFloat32(120, -0.25, true);
  view.setUint32(124, 1, true);
  view.setFloat32(128, 7, true);
  view.setInt16(140 + 2, -32767, true);
  view.setUint8(140 + 12 + 1, 255);
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
    expect(read.tools[0]!.aside).toEqual([0.5, -0.25]);
    expect(read.tools[0]!.points).toEqual([7, 0, 0]);
    expect(Array.from(read.displacement)).toEqual([0, -32767, 0, 0, 0, 0]);
    expect([read.field, read.low, read.high, ...read.values]).toEqual([3, -100, 155, 0, 255]);
  });

  test("a keyframe tells what its triangles are, and has the surfaces of inner regions", () => {
    const read = decodeMessage(keyframe());
    if (read?.kind !== "keyframe") throw new Error("no keyframe");
    expect([read.rest.length, ...read.triangles, ...read.marks]).toEqual([9, 0, 1, 2, 0, 2, 1, 0, 2, 0]);
    expect([...read.kinds!]).toEqual([0, 1]);
    expect([read.tissue, read.regions[0]!.name]).toEqual(["liver", "portal vein"]);
    expect([...read.regions[0]!.triangles]).toEqual([2, 1, 0]);
    const older = decodeMessage(keyframe().slice(0, 16 + 36 + 24 + 3));
    expect(older).toMatchObject({ kinds: null, tissue: "", regions: [] });
  });

  test("samples are read tool by tool", () => {
    const view = new DataView(new ArrayBuffer(8 + 2 * 24));
    view.setUint8(0, 3);
    view.setUint8(1, 2);
    view.setUint32(4, 2, true);
    [0.25, 1, 2, 3, 4].forEach((value, i) => view.setFloat32(8 + 24 + 4 + 4 * i, value, true));
    view.setUint32(8 + 24, 9, true);
    const read = decodeMessage(view.buffer);
    if (read?.kind !== "samples") throw new Error("no samples");
    expect(read.rows[1]).toEqual({ epoch: 9, time: 0.25, depth: [1, 3], force: [2, 4] });
    expect(decodeMessage(view.buffer.slice(0, 55))).toBeNull();
  });

  test("the whole body's tets come last", () => {
    const tets = Uint32Array.of(1, 0, 1, 2, 2);
    const whole = new Uint8Array([...new Uint8Array(keyframe()), ...new Uint8Array(tets.buffer)]).buffer;
    expect(decodeMessage(whole)).toMatchObject({ kind: "keyframe", tets: Uint32Array.of(0, 1, 2, 2) });
    expect(decodeMessage(whole.slice(0, -4))).toBeNull();
  });

  test("a text has the fields of its message, of their kinds", () => {
    const role = { type: "role", drives: true, led: true, viewers: 2 };
    expect(decodeText(JSON.stringify(role))).toEqual(role);
    expect(decodeText(JSON.stringify({ ...role, viewers: undefined }))).toBeNull();
    expect(decodeText(JSON.stringify({ ...role, drives: 1 }))).toBeNull();
    expect(decodeText(JSON.stringify({ ...role, type: "rule" }))).toBeNull();
    const numbers = { epoch: 1, cut_area_m2: 0, cut_longest_s: null, pieces: 1, events_before: 0 }; // null: not finite
    const state = { type: "state", ...numbers, parameters: [], speeds_m_s: [], events: [] };
    expect(decodeText(JSON.stringify(state))).toEqual(state);
    expect(decodeText(JSON.stringify({ ...state, events: null }))).toBeNull();
  });

  test("what is cut short, or of another kind, is none", () => {
    for (let length = 0; length < 132; length++) expect(decodeMessage(frame().slice(0, length))).toBeNull();
    expect(decodeMessage(new Uint8Array(64).fill(9).buffer)).toBeNull();
  });
});

describe("colours", () => {
  const read = () => {
    const message = decodeMessage(frame());
    if (message?.kind !== "frame") throw new Error("no frame");
    return message;
  };

  test("are the field's numbers, or lengths of displacements; none where another field came", () => {
    const out = new Float32Array(2);
    expect(valuesOf(colouringOf("pressure"), read(), out)).toEqual({ low: -100, high: 155 });
    expect(Array.from(out)).toEqual([-100, 155]);
    expect(valuesOf(colouringOf("displacement"), read(), out)!.high).toBeCloseTo(0.01);
    expect(out[1]).toBe(0);
    expect(valuesOf(colouringOf("intensity"), read(), out)).toBeNull();
  });

  test("have a range that grows at once and shrinks late", () => {
    const range = new ColourRange();
    range.reset(COLOURINGS[0]!, 0.02);
    expect(range.follow(0, 0.01, 0, 0.02, 0)).toBe(false);
    expect(range.follow(0, 0.1, 0, 0.02, 1)).toBe(true);
    expect(range.high).toBeCloseTo(0.115);
    expect(range.follow(0, 0.001, 0, 0.02, 3000)).toBe(false);
    expect(range.follow(0, 0.001, 0, 0.02, 4500)).toBe(true);
    expect(range.low).toBe(0);
    expect(range.high).toBeCloseTo(0.02, 12);
    range.reset(colouringOf("shape"), 0.002);
    range.follow(0.9, 1, 1, 0.002, 0);
    expect(range.low).toBeCloseTo(0.885);
    expect(range.high).toBe(1);
  });

  test("name units that suit their numbers", () => {
    expect(unitOf(colouringOf("pressure"), -500, 20).unit).toBe("Pa");
    expect(unitOf(colouringOf("pressure"), -5000, 20)).toMatchObject({ unit: "kPa", perUnit: 1e-3 });
    expect(unitOf(colouringOf("displacement"), 0, 0.01).unit).toBe("mm");
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

describe("force against depth", () => {
  const row = (time: number, depth: number, force: number) => ({ epoch: 1, time, depth: [depth], force: [force] });

  test("keeps what was gone however long the tool stands, and the force that it comes to", () => {
    const history = new History(1);
    const press = Array.from({ length: 100 }, (_, i) => row(0.001 * (i + 1), 1e-4 * i, 0.01 * i));
    history.add({ kind: "samples", tools: 1, rows: press });
    for (let part = 0; part < 40; part++) {
      const rest = Array.from({ length: 10_000 }, (_, i) => row(0.1 + 0.001 * (10_000 * part + i + 1), 99e-4, 0.5));
      history.add({ kind: "samples", tools: 1, rows: rest });
    }
    expect(history.time.length).toBeLessThan(140_000);
    const { depth, force } = history.paths[0]!;
    expect(depth.length).toBe(101);
    expect(depth.slice(0, 3)).toEqual([0, 1e-4, 2e-4]);
    expect([force[99], force[100]]).toEqual([0.99, 0.5]);
    history.clear(2);
    expect(history.paths[0]!.depth).toEqual([]);
  });
});

describe("placing a tool", () => {
  const info = {
    name: "n",
    instrument: true,
    direction: [0, 0, -1],
    side: [1, 0, 0],
    third: [0, 1, 0],
    least_m: -0.05,
    most_m: 0.05,
    speed_m_s: 0.01,
    can_play: true,
  };
  // It started at (0, 0, 0.1), and is 4 cm deep and 1 cm aside now.
  const state = {
    depth: 0.04,
    aside: [0.01, 0],
    force: [0, 0, 0] as [number, number, number],
    axes: [],
    points: [0.01, 0, 0.06],
  };

  test("goes out, aside and down, each leg from where the last one ended", () => {
    expect(startOf(info, state)).toEqual([0, 0, 0.1].map((x) => expect.closeTo(x, 12)));
    const legs = legsTo([0.02, -0.01, 0.07], info, state, 0.02, 0.1); // all of the body is deeper than 2 cm
    const close = (depth: number, x: number, y: number, quick: boolean) => ({
      depth: expect.closeTo(depth, 12),
      aside: [expect.closeTo(x, 12), expect.closeTo(y, 12)],
      quick,
    });
    expect(legs).toEqual([
      close(0.017, 0.01, 0, false),
      close(0.017, 0.02, -0.01, true),
      close(0.027, 0.02, -0.01, true),
    ]);
    expect(legsTo([0, 0, 0], info, { ...state, points: [] }, 0, 0.1)).toEqual([]);
  });

  test("sends a leg once the one before it is gone, and gives the speed back at the end", () => {
    const sent: number[] = [];
    const speeds: (number | null)[] = [];
    const placing = new Placing(
      ({ depth }) => sent.push(depth),
      (speed) => speeds.push(speed),
    );
    placing.begin(legsTo([0.02, -0.01, 0.07], info, state, 0.02, 0.1));
    placing.follow(state);
    expect(sent.length).toBe(1);
    for (const leg of [
      [0.017, 0.01, 0],
      [0.017, 0.02, -0.01],
      [0.027, 0.02, -0.01],
    ])
      placing.follow({ ...state, depth: leg[0]!, aside: leg.slice(1) });
    expect(sent.map((depth) => Number(depth.toFixed(6)))).toEqual([0.017, 0.017, 0.027]);
    expect([placing.busy, speeds[speeds.length - 1]]).toEqual([false, null]);
  });
});

describe("the container", () => {
  test("has the rim of its shape", () => {
    const circle = rimOf({ kind: "cylinder", radius_m: 0.05, height_m: 0.1, origin: [0, 0, 0], axes: [] });
    for (const [x, y] of circle) expect(Math.hypot(x, y)).toBeCloseTo(0.05, 12);
    const box = rimOf({ kind: "box", width_m: 0.04, length_m: 0.02, height_m: 0.1, origin: [0, 0, 0], axes: [] });
    expect(box.map(([x, y]) => [Math.abs(x), Math.abs(y)])).toEqual(Array(4).fill([0.02, 0.01]));
  });

  test("and the pace are told as people say it", () => {
    expect(paceText(0.3)).toBe("0.30 × real time");
  });
});
