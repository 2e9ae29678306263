// Instruments are drawn where they were, events stand where they happened, and a surface that is cut becomes another one.
import * as THREE from "three";
import { describe, expect, it } from "vitest";
import { eventMarks, placeLabels } from "../src/charts/event_marks.ts";
import { containerChart, partsChart } from "../src/charts/column_charts.ts";
import { variantCharts } from "../src/charts/variant_charts.ts";
import { parseReport } from "../src/data/read_report.ts";
import { InnerRegions } from "../src/mesh3d/inner_regions.ts";
import { placeBetween, tubePositions, tubeTriangles } from "../src/mesh3d/instrument_shape.ts";
import { Timeline } from "../src/mesh3d/timeline.ts";
import { regionTints } from "../src/mesh3d/tissue_colours.ts";
import type { ChartSpec, SurfaceData, VariantData } from "../src/report_data.ts";

const base64 = (bytes: ArrayBufferView) =>
  btoa(String.fromCharCode(...new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength)));

describe("tube of a needle", () => {
  const line = [0, 0, 0.1, 0, 0, 0.05, 0, 0, 0];
  const sides = 12;
  const positions = tubePositions(line, 0.001, sides);
  const rings = positions.length / 3 / sides;

  it("keeps its radius along the shaft and ends in the tip", () => {
    expect(rings).toBe(4); // two of the shaft, one where the tip begins, the tip
    for (let i = 0; i < (rings - 1) * sides; i++) {
      expect(Math.hypot(positions[3 * i]!, positions[3 * i + 1]!)).toBeCloseTo(0.001, 8);
    }
    expect(positions[3 * 2 * sides + 2]).toBeCloseTo(0.003, 8); // three radii above the tip
    expect([...positions.slice(-3)]).toEqual([0, 0, 0].map((x) => expect.closeTo(x, 9)));
  });

  it("is closed around and points outwards", () => {
    const triangles = tubeTriangles(rings, sides);
    expect(triangles.length).toBe(3 * 2 * sides * (rings - 1));
    let volume = 0; // of the open tube about the axis: its ends lie on planes through which no flux of x and y goes
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => [...positions.slice(3 * triangles[t + k]!, 3 * triangles[t + k]! + 3)]);
      const u = b!.map((x, n) => x - a![n]!);
      const v = c!.map((x, n) => x - a![n]!);
      const normal = [u[1]! * v[2]! - u[2]! * v[1]!, u[2]! * v[0]! - u[0]! * v[2]!];
      const middle = [0, 1].map((n) => (a![n]! + b![n]! + c![n]!) / 3);
      volume += (middle[0]! * normal[0]! + middle[1]! * normal[1]!) / 4;
    }
    // ∮ (x, y, 0)·n dA / 2 = volume: a twelve-sided prism of 97 mm and a pyramid of 3 mm
    const area = (sides / 2) * 1e-6 * Math.sin((2 * Math.PI) / sides);
    expect(volume).toBeCloseTo(area * (0.097 + 0.001), 11);
  });

  it("survives a line of one point, or none, or two in one place", () => {
    expect(tubePositions([1, 2, 3], 0.1, 4).length).toBe(12);
    expect(tubePositions([], 0.1, 4).length).toBe(0);
    expect([...tubePositions([1, 2, 3, 1, 2, 3], 0.1, 4)].every(Number.isFinite)).toBe(true);
  });
});

describe("place of an instrument", () => {
  it("is on the straight line between two frames", () => {
    const place = placeBetween({ points: [0, 0, 1], axes: [1] }, { points: [0, 2, 3], axes: [2] }, 0.25);
    expect(place).toEqual({ points: [0, 0.5, 1.5], axes: [1] });
  });

  it("is that of the nearer frame where the needle has got another number of points", () => {
    const before = { points: [0, 0, 1], axes: [] };
    const after = { points: [0, 0, 1, 0, 0, 0], axes: [] };
    expect(placeBetween(before, after, 0.4)).toBe(before);
    expect(placeBetween(before, after, 0.6)).toBe(after);
  });
});

const variant = (events: [number, number, string][], more: Record<string, number[]> = {}): VariantData => {
  const columns = { time_s: [0, 1, 2], depth_m: [0, 0.01, 0.02], force_N: [0, 1, 0.5], ...more };
  return {
    name: "fast",
    label: "fast",
    summary: {},
    forces: { columns: Object.keys(columns), data: Object.values(columns) },
    instruments: [{ name: "needle", kind: "needle", forces: null }],
    probes: { columns: [], data: [] },
    events: events.map(([time_s, depth_m, event]) => ({ time_s, depth_m, event, instrument: "needle" })),
    law_curves: [],
    surface: null,
  };
};

/** Marks along a column, on no line. */
const marksAlong = (made: VariantData, name: string, scale = 1) =>
  eventMarks(made, { table: made.forces, x: { column: name, scale }, y: null, instrument: null });

describe("events", () => {
  it("stand at their time, or where a column was then", () => {
    const made = variant([[0.5, 0.005, "contact"]], { work_J: [0, 4, 6] });
    expect(marksAlong(made, "time_s")).toEqual([{ variant: "fast", x: 0.5, y: null, label: "contact" }]);
    expect(marksAlong(made, "depth_m", 1000)[0]!.x).toBeCloseTo(5, 12);
    expect(marksAlong(made, "work_J")[0]!.x).toBeCloseTo(2, 12);
    expect(marksAlong(made, "nowhere")).toEqual([]);
  });

  it("lie on the line of the instrument that they happened to, and on no other's", () => {
    const other = { time_s: 1.5, depth_m: 0, event: "contact", instrument: "plate" };
    const pressed = variant([[0.5, 0.005, "contact"]]);
    const plate = {
      columns: ["time_s", "depth_m", "force_N"],
      data: [
        [0, 1, 2],
        [0, 0.1, 0.2],
        [0, 0, 8],
      ],
    };
    const made: VariantData = {
      ...pressed,
      events: [...pressed.events, other],
      instruments: [...pressed.instruments, { name: "plate", kind: "plate", forces: plate }],
    };
    const charts = variantCharts({ ...parsed({}), variants: [made] });
    expect(charts.map(({ title, events }) => [title, events.map(({ x, y }) => [x, y])])).toEqual([
      ["Force against depth", [[expect.closeTo(5, 9), 0.5]]],
      ["Force against time", [[0.5, 0.5]]],
      ["Force of plate against depth", [[expect.closeTo(150, 9), expect.closeTo(4, 9)]]],
      ["Force of plate against time", [[1.5, expect.closeTo(4, 9)]]],
    ]);
  });

  it("lie where the axes put them: over decades in charts of decades", () => {
    const spec = {
      title: "t",
      x: { column: "time_s", label: "t [s]", scale: 1 },
      y: { column: "force_N", label: "F [N]", scale: 10 },
      variants: null,
      log_x: true,
      log_y: true,
    };
    const scene = { ...parsed({}), variants: [variant([[1, 0.01, "contact"]])], charts: [spec] };
    expect(variantCharts(scene)[0]!.events).toEqual([{ variant: "fast", x: 0, y: 1, label: "contact" }]);
  });

  it("do not put a needle's chart behind others", () => {
    const needle = variant([]);
    const plate = { name: "plate", kind: "plate" as const, forces: null };
    const table = { ...needle.forces };
    const second = { ...needle, instruments: [plate, { name: "n", kind: "needle" as const, forces: table }] };
    const titles = (made: VariantData, charts: ChartSpec[]) =>
      variantCharts({ ...parsed({}), charts, variants: [made] }).map(({ title }) => title);
    const axis = (column: string) => ({ column, label: column, scale: 1 });
    const load = { title: "load", x: axis("depth_m"), y: axis("depth_m"), variants: null };
    const force = { title: "force", x: axis("depth_m"), y: axis("force_N"), variants: null };
    expect(titles(needle, [load, force])).toEqual(["force", "load"]);
    expect(titles({ ...needle, instruments: [plate] }, [load, force])).toEqual(["load", "force"]);
    expect(titles(second, [load])).toEqual(["Force of n against depth", "Force of n against time", "load"]);
    expect(titles(second, [])[0]).toBe("Force of n against depth");
  });

  it("are left out where they would be a hatching", () => {
    const many = (n: number) => Array.from({ length: n }, (_, i): [number, number, string] => [0.02 * i, 0, "contact"]);
    expect(marksAlong(variant(many(24)), "time_s")).toHaveLength(24);
    expect(marksAlong(variant(many(25)), "time_s")).toEqual([]);
  });

  it("are in every chart of the scene", () => {
    const scene = { ...parsed({}), variants: [variant([[0.5, 0.005, "contact"]])] };
    expect(variantCharts(scene).map((chart) => chart.events[0]!.x)).toEqual([5, 0.5].map((x) => expect.closeTo(x, 9)));
  });

  it("have labels that do not cover each other and stay inside", () => {
    const marks = [10, 12, 14, 16, 18, 195].map((x, i) => ({ variant: "v", x, y: null, label: `event ${i}` }));
    const placed = placeLabels(
      marks,
      (x) => x,
      () => 40,
      200,
      4,
    );
    expect(placed.map((label) => label.row)).toEqual([0, 1, 2, 3, -1, 0]);
    expect(placed[5]!.left).toBe(195 - 4 - 40);
    expect(
      placeLabels(
        marks,
        (x) => x - 100,
        () => 40,
        200,
        4,
      ).length,
    ).toBe(1);
  });
});

describe("charts of one variant", () => {
  it("show the parts of an instrument's force", () => {
    const made = partsChart(variant([], { normal_N: [0, 1, 0], friction_N: [0, 0, 0.3], cutting_N: [0, 0, 0.2] }))!;
    expect(made.lines.map((line) => line.label)).toEqual(["total", "pressing", "friction", "cutting"]);
  });

  it("show what the container carries, and nothing where there is none", () => {
    const loads = { bottom_z_N: [0, -1, -0.3], side_z_N: [0, -0.1, 0], side_radial_N: [0, 2, 1] };
    const made = containerChart(variant([[1, 0.01, "puncture"]], loads))!;
    expect(made.lines.map((line) => line.label)).toEqual([
      "total",
      "bottom, along z",
      "side, along z",
      "side, outwards",
    ]);
    expect(made.events[0]!.x).toBe(1);
    expect(containerChart(variant([]))).toBeNull();
  });
});

function parsed(surface: unknown) {
  const read = parseReport(JSON.stringify({ format: 1, scenes: [{ variants: [{ surface }] }] }));
  if (!read.ok) throw new Error(read.reason);
  return read.report.scenes[0]!;
}

describe("a surface that is cut", () => {
  const surface = {
    vertices: 4,
    triangles: base64(Uint32Array.from([0, 1, 2])),
    rest: base64(Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0])),
    fixed: base64(new Uint8Array(4)),
    instruments: [{ kind: "needle", name: "n", radius_m: 0.001 }],
    frames: [0, 1, 2].map((time) => ({
      time_s: time,
      displacement_scale_m: 1,
      displacement: base64(new Int16Array(time === 2 ? 12 : 9).fill(3276 * time)),
      intensity_max: 1,
      intensity: base64(new Uint8Array(time === 2 ? 4 : 3)),
      instruments: [{ points: [0, 0, time], axes: [] }],
      ...(time === 2 ? { triangles: base64(Uint32Array.from([3, 1, 2])) } : {}),
    })),
  };
  const read = parsed(surface).variants[0]!.surface as SurfaceData;
  const timeline = new Timeline(read);

  it("is the old one until the frame of the cut, and waits there as it was", () => {
    expect([...timeline.trianglesAt(1.5)]).toEqual([0, 1, 2]);
    expect([...timeline.trianglesAt(2)]).toEqual([3, 1, 2]);
    expect(timeline.at(1.9).share).toBe(0);
    expect(timeline.at(0.5).share).toBe(0.5);
  });

  it("says which of its triangles were cut, and keeps that until it is told otherwise", () => {
    const kinds = base64(Uint8Array.of(1));
    const frames = surface.frames.map((frame, i) => (i === 1 ? { ...frame, kinds } : frame));
    const told = new Timeline(parsed({ ...surface, frames }).variants[0]!.surface!);
    expect(told.kindsAt(0)).toBeNull();
    expect([...told.kindsAt(1)!]).toEqual([1]);
    expect([...told.kindsAt(1.5)!]).toEqual([1]);
    expect(told.kindsAt(2)).toBeNull(); // other triangles, of which nothing is said
  });

  it("has the surfaces of inner regions by their names", () => {
    const regions = [{ name: "tumour", triangles: base64(Uint32Array.from([0, 2, 1, 0, 1, 99])) }];
    const told = new Timeline(parsed({ ...surface, tissue: "liver", regions }).variants[0]!.surface!);
    expect(told.tissue).toBe("liver");
    expect(told.regions.map(({ name, triangles }) => [name, ...triangles])).toEqual([["tumour", 0, 2, 1]]);
  });

  it("has those of regions that the cut goes through from its frame on", () => {
    const regions = [
      { name: "tumour", triangles: base64(Uint32Array.from([0, 2, 1])) },
      { name: "vein", triangles: base64(Uint32Array.from([0, 1, 2])) },
    ];
    const frames = surface.frames.map((frame, i) =>
      i === 2 ? { ...frame, regions: [base64(Uint32Array.from([3, 2, 1, 0, 1, 99])), ""] } : frame,
    );
    const told = new Timeline(parsed({ ...surface, regions, frames }).variants[0]!.surface!);
    expect(told.regionsAt(1.9).map((triangles) => [...triangles])).toEqual([
      [0, 2, 1],
      [0, 1, 2],
    ]);
    expect(told.regionsAt(2).map((triangles) => [...triangles])).toEqual([[3, 2, 1], []]);
    expect(told.regionsAt(0)[0]).toBe(told.regions[0]!.triangles);
    const tint = regionTints("#000000", told)(Uint32Array.from([1, 2, 3, 0, 1, 3]));
    expect(tint(0)).not.toEqual([0, 0, 0]); // a face of the tumour that only the cut has laid open
    expect(tint(1)).toEqual([0, 0, 0]);
  });

  it("draws them so: each region has the triangles of the time", () => {
    const told = new Timeline(
      parsed({ ...surface, regions: [{ name: "tumour", triangles: base64(Uint32Array.from([0, 2, 1])) }] }).variants[0]!
        .surface!,
    );
    const positions = new THREE.BufferAttribute(told.rest.slice(), 3);
    const inner = new InnerRegions(told, positions, new THREE.Vector3(), 1);
    const drawn = () => [...((inner.group.children[0] as THREE.Mesh).geometry.index!.array as Uint32Array)];
    expect(drawn()).toEqual([0, 2, 1]);
    inner.update([Uint32Array.from([3, 2, 1])]);
    expect(drawn()).toEqual([3, 2, 1]);
    inner.dispose();
  });

  it("comes with its instruments", () => {
    expect(timeline.instruments[0]!.kind).toBe("needle");
    expect(timeline.at(1).after.instruments[0]!.points[2]).toBe(2);
  });

  it("reads what older programs wrote: neither instruments nor events", () => {
    const { instruments: _, ...old } = surface;
    const variant = parsed({ ...old, frames: [] }).variants[0]!;
    expect(variant.surface!.instruments).toEqual([]);
    expect(variant.events).toEqual([]);
  });
});

describe("measured points", () => {
  it("are drawn as points in the chart that asks for them", () => {
    const raw = { title: "f", x: { column: "depth_m", scale: 1000 }, y: { column: "force_N" } };
    const read = parseReport(
      JSON.stringify({
        format: 1,
        scenes: [{ charts: [{ ...raw, points: [{ label: "1999", x: [1, 2], y: [3, null] }] }] }],
      }),
    );
    if (!read.ok) throw new Error(read.reason);
    const chart = variantCharts({ ...read.report.scenes[0]!, variants: [variant([])] })[0]!;
    expect(chart.lines.map((line) => [line.label, line.points ?? false])).toEqual([
      ["fast", false],
      ["1999", true],
    ]);
    expect([...chart.lines[1]!.x]).toEqual([1, 2]);
    expect(chart.lines[1]!.y[1]).toBeNaN();
  });
});
