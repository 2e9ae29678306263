// The right columns are found in tables of any program version, also in empty and broken ones.
import { describe, expect, it } from "vitest";
import {
  column,
  columnLabel,
  depthColumn,
  energyColumns,
  forceColumn,
  isZero,
  partColumns,
  rowCount,
} from "../src/data/columns.ts";
import { toCsv } from "../src/data/csv.ts";

const table = {
  columns: ["time_s", "depth_m", "force_x_N", "force_N", "elastic_N", "load_N", "energy_elastic_J", "work_tools_J"],
  data: [
    [0, 1],
    [0, 2],
    [0, 0],
    [0, 5],
    [0, 5],
    [0, 0],
    [0, NaN],
    [0, 7],
  ],
};

describe("columns", () => {
  it("are found by name and by kind", () => {
    expect(column(table, "depth_m")).toEqual([0, 2]);
    expect(column(table, "missing")).toBeNull();
    expect(forceColumn(table)).toBe("force_N");
    expect(depthColumn(table)).toBe("depth_m");
    expect(partColumns(table)).toEqual(["elastic_N", "load_N"]);
    expect(energyColumns(table)).toEqual(["energy_elastic_J", "work_tools_J"]);
  });

  it("fall back to those of a named tool", () => {
    const named = { columns: ["needle_depth_m", "needle_force_N"], data: [[0], [1]] };
    expect(forceColumn(named)).toBe("needle_force_N");
    expect(depthColumn(named)).toBe("needle_depth_m");
  });

  it("of no length count as missing", () => {
    const empty = { columns: ["force_N"], data: [[]] };
    expect(forceColumn(empty)).toBeNull();
    expect(rowCount(empty)).toBe(0);
    expect(rowCount({ columns: [], data: [] })).toBe(0);
  });

  it("know when they are zero throughout", () => {
    expect(isZero([0, NaN, 0])).toBe(true);
    expect(isZero([0, 1e-30])).toBe(false);
  });

  it("have names without units for people", () => {
    expect(columnLabel("energy_dissipated_J")).toBe("dissipated");
    expect(columnLabel("needle_force_N")).toBe("needle force");
  });
});

describe("CSV", () => {
  it("has the header, all digits and empty cells for gaps", () => {
    expect(
      toCsv({
        columns: ["a_s", "b_N"],
        data: [
          [0, 0.1],
          [NaN, 1e-9],
        ],
      }),
    ).toBe("a_s,b_N\n0,\n0.1,1e-9\n");
  });
});
