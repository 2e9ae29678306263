// Maps of the largest value at each place: what they are made of, and that a chart with a map is no chart of lines.
import { describe, expect, it } from "vitest";
import { spacing } from "../src/charts/force_map.ts";
import { variantCharts } from "../src/charts/variant_charts.ts";
import { parseReport } from "../src/data/read_report.ts";

const axis = (column: string) => ({ column, label: column, scale: 1 });
const report = {
  format: 1,
  scenes: [
    {
      name: "s",
      variants: [
        {
          name: "a",
          forces: {
            columns: ["time_s", "force_N"],
            data: [
              [0, 1],
              [0, 2],
            ],
          },
        },
      ],
      charts: [
        {
          title: "map",
          x: axis("time_s"),
          y: axis("force_N"),
          map: { label: "force [N]", of: [{ variant: "a", label: "", x: [1, 2, 3], y: [0, 0], value: [4, null, 6] }] },
        },
      ],
    },
  ],
};

describe("a map", () => {
  it("is read with lists of one length and the variant's name for a label", () => {
    const read = parseReport(JSON.stringify(report));
    if (!read.ok) throw new Error(read.reason);
    const map = read.report.scenes[0]!.charts[0]!.map!;
    expect(map.of[0]).toEqual({ variant: "a", label: "a", x: [1, 2], y: [0, 0], value: [4, NaN] });
    expect(variantCharts(read.report.scenes[0]!)).toEqual([]);
  });

  it("has cells as wide as the distance of its places", () => {
    expect(spacing([10, 0, 10, 30], 1)).toBe(10);
    expect(spacing([5, 5], 7)).toBe(7);
  });
});
