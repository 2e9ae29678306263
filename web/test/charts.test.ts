// Charts choose their lines and ranges, and the cursor its point, as a reader expects.
import { describe, expect, it } from "vitest";
import { energyChart, partsChart } from "../src/charts/column_charts.ts";
import { endOf, namesEnds, spread } from "../src/charts/end_labels.ts";
import { lawCharts } from "../src/charts/law_charts.ts";
import { lineStyle } from "../src/charts/line_style.ts";
import { type Line, extentOf } from "../src/charts/model.ts";
import { isRising, nearestInX, nearestOnScreen } from "../src/charts/nearest.ts";
import { SceneState } from "../src/charts/scene_state.ts";
import { SvgPen } from "../src/charts/svg_pen.ts";
import { variantCharts } from "../src/charts/variant_charts.ts";
import { PROBE_QUANTITIES, probeChart } from "../src/charts/probe_charts.ts";
import type { ChartSpec, SceneData, VariantData } from "../src/report_data.ts";

const line = (x: number[], y: number[]): Line => ({
  id: "a",
  variant: null,
  label: "a",
  style: lineStyle(0),
  x: Float64Array.from(x),
  y: Float64Array.from(y),
  times: null,
});

const variant = (name: string, y = [3600, 3600, 3600]): VariantData => ({
  name,
  label: name,
  summary: {},
  events: [],
  surface: null,
  law_curves: [
    { measure: "equivalent shear strain s [-]", quantity: "modulus", x: [0, 0.5, 1], curves: [{ label: "E", y }] },
  ],
  probes: { columns: [], data: [] },
  instruments: [],
  forces: {
    columns: ["time_s", "depth_m", "force_N", "elastic_N", "viscous_N", "energy_elastic_J"],
    data: [
      [0, 1],
      [0, 0.01],
      [0, 0.005],
      [0, 0.005],
      [0, 0],
      [0, 2e-5],
    ],
  },
});

const scene = (variants: VariantData[], charts: ChartSpec[] = []): SceneData => ({
  name: "s",
  title: "s",
  description: "",
  notes: [],
  advice: [],
  source: "",
  tables: [],
  checks: [],
  variants,
  charts,
});

describe("default charts", () => {
  it("show force on depth and on time in prefixed units", () => {
    const models = variantCharts(scene([variant("a"), variant("b")]));
    expect(models.map((model) => [model.xLabel, model.yLabel])).toEqual([
      ["Depth [mm]", "Force [mN]"],
      ["Time [s]", "Force [mN]"],
    ]);
    expect([...models[0]!.lines[0]!.x]).toEqual([0, 10]);
    expect(models[0]!.lines.map((one) => one.style.dash)).not.toEqual([[], []]);
  });

  it("are those of the scene where it names some, with fits as they are", () => {
    const spec: ChartSpec = {
      title: "t",
      x: { column: "depth_m", label: "d [mm]", scale: 1000 },
      y: { column: "force_N", label: "F [N]", scale: 1 },
      variants: ["b"],
      fits: [{ label: "fit", x: [0, 10], y: [0, 1] }],
    };
    const [model] = variantCharts(scene([variant("a"), variant("b")], [spec]));
    expect(model!.lines.map((one) => [one.label, one.variant])).toEqual([
      ["b", "b"],
      ["fit", null],
    ]);
    expect([...model!.lines[1]!.y]).toEqual([0, 1]);
  });

  it("draw lines of their own, over decades where x is by its logarithm", () => {
    const spec: ChartSpec = {
      title: "t",
      x: { column: "frequency", label: "frequency [Hz]", scale: 1 },
      y: { column: "modulus", label: "modulus [kPa]", scale: 1 },
      variants: [],
      lines: [
        { label: "storage", x: [0.01, 1, 100], y: [1, 2, 3] },
        { label: "loss", x: [0.01, 1, 100], y: [0, 1, 0] },
      ],
      log_x: true,
    };
    const [steep] = variantCharts(
      scene([], [{ ...spec, lines: [{ label: "error", x: [1, 10], y: [100, 0.1] }], log_y: true }]),
    );
    expect(steep!.logY).toBe(true);
    expect([...steep!.lines[0]!.y]).toEqual([2, -1]);
    const [model] = variantCharts(scene([], [spec]));
    expect(model!.logX).toBe(true);
    expect(model!.lines.map((one) => one.label)).toEqual(["storage", "loss"]);
    expect([...model!.lines[1]!.x]).toEqual([-2, 0, 2]);
    expect(model!.lines[0]!.style.dash).toEqual([]);
  });

  it("leave out parts that are zero throughout, and say so", () => {
    const model = partsChart(variant("a"));
    expect(model!.lines.map((one) => one.label)).toEqual(["total", "elastic"]);
    expect(model!.note).toBe("Zero throughout: viscous.");
    expect(energyChart(variant("a"))!.yLabel).toBe("Energy [µJ]");
  });

  it("show stress against stretch of hyperelastic tissues in a chart of their own", () => {
    const law = {
      measure: "stretch, sides free [-]",
      quantity: "nominal stress" as const,
      x: [0.5, 1, 1.5],
      curves: [{ label: "", y: [-9000, 0, 2000] }],
    };
    const models = lawCharts([variant("a", [3600, 3600, 7200]), { ...variant("b"), law_curves: [law] }]);
    expect(models.map((model) => [model.title, model.yLabel])).toEqual([
      ["Law of stiffness", "Modulus E [kPa]"],
      ["Stress against stretch", "Nominal stress [kPa]"],
    ]);
  });

  it("end a law's line where it has no answer, and name what is at once and what is relaxed", () => {
    const curves = [
      { label: "at once", y: [-9000, 0, 2000, 4500] },
      { label: "relaxed", y: [NaN, 0, 1000, 2200] },
    ];
    const law = { measure: "amount of shear [-]", quantity: "shear stress" as const, x: [0, 1, 2, 3], curves };
    const [model] = lawCharts([{ ...variant("a"), law_curves: [law] }]);
    expect(model).toMatchObject({ title: "Stress against shear", yLabel: "Shear stress [kPa]" });
    expect(model!.lines.map((one) => one.label)).toEqual(["a, at once", "a, relaxed"]);
    expect([...model!.lines[1]!.y]).toEqual([NaN, 0, 1, 2.2]);
  });

  it("show laws only where one is not constant, the constant ones with it", () => {
    expect(lawCharts([variant("a"), variant("b")])).toEqual([]);
    const [model] = lawCharts([variant("a"), variant("b", [3600, 3600, 7200])]);
    expect(model).toMatchObject({ xLabel: "Equivalent shear strain s [–]", yLabel: "Modulus E [kPa]" });
    expect(model!.lines.map((one) => one.label)).toEqual(["a", "b"]);
    const [merged] = lawCharts([variant("a"), variant("b", [3600, 3600, 7200]), variant("c", [3600, 3600, 7200])]);
    expect(merged!.lines.map((one) => one.label)).toEqual(["a", "b / c"]);
  });

  it("are none for a variant without forces", () => {
    const empty = { ...variant("a"), forces: { columns: [], data: [] } };
    expect(variantCharts(scene([empty]))).toEqual([]);
    expect([partsChart(empty), energyChart(empty)]).toEqual([null, null]);
  });
});

describe("ranges", () => {
  it("hold all points and start at zero where zero is near", () => {
    expect(extentOf([line([0, 10], [0.2, 1])])).toMatchObject({ xMin: 0, xMax: 10, yMin: 0 });
    const far = extentOf([line([5, 6], [100, 101])]);
    expect(far.yMin).toBeGreaterThan(99);
    expect(far.xMin).toBe(5);
    expect(extentOf([line([0, 9.97], [0, 1])]).xMax).toBe(10);
    expect(extentOf([line([0, 9.3], [0, 1])]).xMax).toBe(9.5);
    expect(extentOf([line([0, 1.1], [0, 1])]).xMax).toBe(1.1);
  });

  it("ignore gaps and cope with nothing and with one value", () => {
    expect(extentOf([line([0, 1], [NaN, 2])]).yMax).toBeGreaterThan(2);
    expect(extentOf([])).toMatchObject({ xMin: 0, xMax: 1 });
    const flat = extentOf([line([0, 1], [3, 3])]);
    expect(flat.yMin).toBeLessThan(3);
    expect(flat.yMax).toBeGreaterThan(3);
    expect(extentOf([line([0, 1], [0, 0])]).yMax).toBeGreaterThan(0);
  });
});

describe("cursor", () => {
  it("finds the nearest x of a rising line, nothing beyond its ends", () => {
    const x = Float64Array.from([0, 1, 2, 4]);
    expect(nearestInX(x, 2.9, 0.5)).toBe(-1);
    expect(nearestInX(x, 2.9, 2)).toBe(2);
    expect(nearestInX(x, 3.1, 2)).toBe(3);
    expect(nearestInX(x, 9, 1)).toBe(-1);
    expect(nearestInX(new Float64Array(0), 0, 1)).toBe(-1);
  });

  it("tells loading from unloading by the height of the pointer", () => {
    const x = Float64Array.from([0, 1, 2, 1, 0]);
    const y = Float64Array.from([0, 10, 20, 4, 0]);
    expect(isRising(x)).toBe(false);
    expect(nearestOnScreen(x, y, 1, 9, 100, 10)).toBe(1);
    expect(nearestOnScreen(x, y, 1, 5, 100, 10)).toBe(3);
  });
});

describe("names at the ends of lines", () => {
  it("keep their distance, each as near to its line's end as that allows, and stay inside", () => {
    expect(spread([10, 50, 90], 12, 0, 100)).toEqual([10, 50, 90]);
    expect(spread([50, 50, 50], 10, 0, 100)).toEqual([40, 50, 60]);
    expect(spread([95, 96, 20], 10, 0, 100)).toEqual([90, 100, 20]);
    const sixteen = spread(
      Array.from({ length: 16 }, () => 30),
      14,
      0,
      260,
    );
    const steps = sixteen.slice(1).map((y, i) => y - sixteen[i]!);
    expect(Math.min(...steps)).toBeGreaterThan(13.99);
    expect([sixteen[0]! >= 0, sixteen[15]! <= 260]).toEqual([true, true]);
  });

  it("stand where a line ends, or where one that comes back was farthest", () => {
    const view = { xMin: 0, xMax: 10, yMin: 0, yMax: 10 };
    expect(endOf(line([0, 5, 10, 12], [0, 1, 2, 3]), view)).toEqual({ x: 10, y: 2 });
    expect(endOf(line([0, 5, 9, 5, 0], [0, 4, 8, 1, 0]), view)).toEqual({ x: 9, y: 8 });
    expect(endOf(line([20, 30], [1, 1]), view)).toBeNull();
  });

  it("are there for many lines of a wide chart alone", () => {
    const lines = ["a", "b", "c", "d"].map((label) => ({ ...line([0], [0]), label }));
    expect([namesEnds(lines, 600), namesEnds(lines, 300), namesEnds(lines.slice(1), 600)]).toEqual([
      true,
      false,
      false,
    ]);
  });
});

describe("a chart as SVG", () => {
  it("has the strokes and letters that a canvas would get", () => {
    const pen = new SvgPen(() => 40);
    pen.save();
    pen.beginPath();
    pen.rect(0, 0, 100, 50);
    pen.clip();
    pen.strokeStyle = "#0068a8";
    pen.globalAlpha = 0.5;
    pen.lineWidth = 2;
    pen.setLineDash([4, 2]);
    pen.beginPath();
    pen.moveTo(0, 0);
    pen.lineTo(10, 20);
    pen.stroke();
    pen.restore();
    pen.font = '600 12px "Some Face", serif';
    pen.textBaseline = "middle";
    pen.fillText("a < b & c", 5, 6);
    expect(pen.content.split("\n")).toEqual([
      '<clipPath id="c1"><path d="M0 0h100v50h-100z"/></clipPath>',
      '<path d="M0 0L10 20" fill="none" stroke="#0068a8" stroke-width="2" stroke-linejoin="miter" stroke-linecap="butt"' +
        ' stroke-dasharray="4 2" stroke-opacity="0.5" clip-path="url(#c1)"/>',
      '<text x="5" y="10.08" font-family="&quot;Some Face&quot;, serif" font-size="12" font-weight="600" fill="#000">' +
        "a &lt; b &amp; c</text>",
    ]);
  });
});

describe("scene state", () => {
  it("highlights what is pointed at, and what was chosen where nothing is", () => {
    const state = new SceneState(["a", "b"]);
    state.pin("b");
    state.point("a");
    expect(state.highlight).toBe("a");
    state.point(null);
    expect(state.highlight).toBe("b");
    state.pin("b");
    expect(state.highlight).toBeNull();
  });

  it("hides, shows, and shows alone; alone once more shows all", () => {
    const state = new SceneState(["a", "b", "c"]);
    const hidden = () => ["a", "b", "c"].filter((name) => state.isHidden(name));
    state.toggle("a", false);
    expect(hidden()).toEqual(["a"]);
    state.toggle("b", true);
    expect(hidden()).toEqual(["a", "c"]);
    state.toggle("b", true);
    expect(hidden()).toEqual([]);
  });
});

describe("probes", () => {
  const probed: VariantData = {
    ...variant("a"),
    probes: {
      columns: ["time_s", "tip_displacement_x_m", "tip_displacement_z_m", "tip_stress_zz_Pa", "cut_force_z_N"],
      data: [
        [0, 1],
        [0, 0],
        [0, -0.004],
        [0, -2500],
        [0, -0.2],
      ],
    },
  };
  const charts = (of: VariantData) =>
    PROBE_QUANTITIES.map((quantity) => probeChart(of, quantity)).filter((c) => c !== null);

  it("have a chart for each quantity, in its unit, without what is zero", () => {
    expect(charts(probed).map((chart) => [chart.title, chart.yLabel, chart.lines.map((line) => line.label)])).toEqual([
      ["Displacement at probes", "Displacement [mm]", ["tip displacement z"]],
      ["Force of sections and sets", "Force [N]", ["cut force z"]],
      ["Stress at probes", "Stress [kPa]", ["tip stress zz"]],
    ]);
    expect(charts(variant("b"))).toEqual([]);
  });

  it("can be the columns of a scene's own chart", () => {
    const spec: ChartSpec = {
      title: "creep",
      x: { column: "time_s", label: "time [s]", scale: 1 },
      y: { column: "tip_displacement_z_m", label: "z [mm]", scale: 1000 },
      variants: null,
    };
    expect(Array.from(variantCharts(scene([probed], [spec]))[0]!.lines[0]!.y)).toEqual([0, -4]);
  });
});
