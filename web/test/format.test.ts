// Numbers and units read the way people write them.
import { describe, expect, it } from "vitest";
import { formatColumn, formatInteger, formatSignificant, formatTick } from "../src/format/number.ts";
import { summaryFields } from "../src/format/summary_fields.ts";
import {
  axisLabel,
  displayUnit,
  formatQuantity,
  largestMagnitude,
  nameOfLabel,
  unitOfLabel,
} from "../src/format/units.ts";

const plain = (text: string) => text.replaceAll("\u202f", " ").replaceAll("\u00a0", " ");

describe("numbers", () => {
  it("keep their significant digits", () => {
    expect(formatSignificant(51.1934, 4)).toBe("51.19");
    expect(formatSignificant(0.51199, 4)).toBe("0.5120");
    expect(formatSignificant(0, 4)).toBe("0");
    expect(formatSignificant(99.996, 4)).toBe("100.0");
  });

  it("carry a true minus sign, and none on a rounded zero", () => {
    expect(formatSignificant(-2.5, 2)).toBe("−2.5");
    expect(formatTick(-0.25, 0.25)).toBe("−0.25");
    expect(formatTick(-1e-17, 0.1)).toBe("0.0");
  });

  it("turn to powers of ten where digits would mean nothing", () => {
    expect(plain(formatSignificant(7.176e5 * 1e3, 4))).toBe("7.176 ×\u00a010⁸".replace("\u00a0", " "));
    expect(plain(formatSignificant(1.2e-7, 3))).toBe("1.2 × 10⁻⁷");
  });

  it("group long whole numbers in threes", () => {
    expect(plain(formatInteger(1234567))).toBe("1 234 567");
    expect(formatInteger(7828)).toBe("7828");
  });

  it("say a gap for what is no number", () => {
    expect([formatSignificant(NaN), formatInteger(Infinity), formatQuantity(NaN, "s")]).toEqual(["–", "–", "–"]);
  });
});

describe("ticks", () => {
  it("show as many decimals as their distance needs, 2.5 included", () => {
    expect([0, 2.5, 5, 7.5].map((value) => formatTick(value, 2.5))).toEqual(["0", "2.5", "5.0", "7.5"]);
    expect([0.05, 0.1].map((value) => formatTick(value, 0.05))).toEqual(["0.05", "0.10"]);
    expect(formatTick(20, 10)).toBe("20");
    expect(formatTick(0.025, 0.025)).toBe("0.025");
  });
});

describe("units", () => {
  it("take the prefix in which the largest value reads best", () => {
    expect(displayUnit("s", 2.125e-5)).toEqual({ unit: "µs", factor: 1e6 });
    expect(displayUnit("Pa", 3600).unit).toBe("kPa");
    expect(displayUnit("N", 0.512).unit).toBe("N");
    expect(displayUnit("N", 0.0512).unit).toBe("mN");
    expect(displayUnit("m", 0.01).unit).toBe("mm");
    expect(displayUnit("N", 2500).unit).toBe("N");
    expect(displayUnit("J", 0).unit).toBe("J");
    expect(displayUnit("J", 1.2e-17).unit).toBe("aJ");
  });

  it("scale by a factor that undoes the prefix", () => {
    const { factor } = displayUnit("J", 2.5e-3);
    expect(2.5e-3 * factor).toBeCloseTo(2.5, 12);
    expect(plain(formatQuantity(2.361e-3, "s"))).toBe("2.361 ms");
  });

  it("are read off labels", () => {
    expect(unitOfLabel("depth [mm]")).toBe("mm");
    expect(unitOfLabel("equivalent shear strain s [-]")).toBe("");
    expect(nameOfLabel("Force [N]")).toBe("Force");
    expect([axisLabel("depth [mm]"), axisLabel("s [-]")]).toEqual(["Depth [mm]", "s [–]"]);
  });

  it("ignore gaps when looking for the largest value", () => {
    expect(largestMagnitude([1, NaN, -3], [Infinity])).toBe(3);
    expect(largestMagnitude([])).toBe(0);
  });
});

describe("columns of tables", () => {
  it("share their decimals", () => {
    expect(formatColumn([0.99999, 0.9871, 1])).toEqual(["0.99999", "0.98710", "1.00000"]);
    expect(formatColumn([1, 20, "n/a"])).toEqual(["1", "20", "n/a"]);
    expect(formatColumn([])).toEqual([]);
  });
});

describe("summary fields", () => {
  it("name every key, known ones in reading order, unknown ones with the unit of their suffix", () => {
    const fields = summaryFields(new Set(["state_hash", "odd_new_key_Pa", "peak_force_N"]));
    expect(fields.map((field) => field.key)).toEqual(["peak_force_N", "state_hash", "odd_new_key_Pa"]);
    expect(fields[2]).toMatchObject({ label: "Odd new key", unit: "Pa", group: "More" });
  });
});
