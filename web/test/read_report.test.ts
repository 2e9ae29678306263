// Whatever the program wrote, or did not get to write, becomes a report without holes.
import { describe, expect, it } from "vitest";
import { parseReport } from "../src/data/read_report.ts";

function read(data: unknown) {
  const result = parseReport(JSON.stringify(data));
  if (!result.ok) throw new Error(result.reason);
  return result.report;
}

describe("reading the report", () => {
  it("says that the bare template holds no data", () => {
    const result = parseReport("/*GLISSON" + "_DATA*/");
    expect(result).toMatchObject({ ok: false });
    expect(result.ok ? "" : result.reason).toMatch(/No data/);
  });

  it("refuses another format by its number", () => {
    const result = parseReport('{"format": 2}');
    expect(result.ok ? "" : result.reason).toMatch(/format 2/);
  });

  it("fills in everything that is missing", () => {
    const report = read({ format: 1, scenes: [{ variants: [{}] }] });
    expect(report.scenes[0]).toMatchObject({
      name: "scene-1",
      title: "scene-1",
      notes: [],
      advice: [],
      charts: [],
      checks: [],
    });
    expect(report.scenes[0]!.variants[0]).toMatchObject({
      label: "variant-1",
      law_curves: [],
      surface: null,
      forces: { columns: [], data: [] },
    });
  });

  it("reads advice, a kind that it does not know as a remark", () => {
    const locks = { rule: "locking", kind: "warning", text: "ν = 0.49", variants: ["stiff"] };
    const scene = read({ format: 1, scenes: [{ advice: [locks, { rule: "new", kind: "other", text: "…" }] }] })
      .scenes[0]!;
    expect(scene.advice).toEqual([locks, { rule: "new", kind: "remark", text: "…", variants: [] }]);
  });

  it("takes null in columns for NaN and drops names without data", () => {
    const forces = {
      columns: ["time_s", "force_N", "lost"],
      data: [
        [0, 1],
        [null, 2],
      ],
    };
    const columns = read({ format: 1, scenes: [{ variants: [{ forces, summary: { peak: null } }] }] }).scenes[0]!
      .variants[0]!;
    expect(columns.forces.columns).toEqual(["time_s", "force_N"]);
    expect(columns.forces.data[1]).toEqual([NaN, 2]);
    expect(columns.summary["peak"]).toBeNaN();
  });

  it("takes a law without curves and a surface without triangles for none", () => {
    const variant = {
      law_curves: [{ measure: "s", x: [], curves: [] }],
      surface: { vertices: 3, rest: "AAAA", triangles: "" },
    };
    expect(read({ format: 1, scenes: [{ variants: [variant] }] }).scenes[0]!.variants[0]).toMatchObject({
      law_curves: [],
      surface: null,
    });
  });

  it("counts a check as passed only where it says so", () => {
    const checks = read({ format: 1, scenes: [{ checks: [{ what: "a", pass: true }, { what: "b" }] }] }).scenes[0]!
      .checks;
    expect(checks.map((check) => check.pass)).toEqual([true, false]);
  });
});
