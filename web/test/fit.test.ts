// What the page of a fit says in words and numbers follows from the fit.
import { describe, expect, it } from "vitest";
import { lineStyle } from "../src/charts/line_style.ts";
import { rowsToCsv } from "../src/data/csv.ts";
import { formatCorrelation } from "../src/fit/correlations.ts";
import { csvFiles, curvesCsv, parametersCsv } from "../src/fit/fit_csv.ts";
import { fittedText, keyFigureTexts, readable, wallText } from "../src/fit/fit_head.ts";
import { fitLines } from "../src/fit/fit_lines.ts";
import { aboveLeast, shrinkText, spreadRatio } from "../src/fit/fit_tables.ts";
import { forceText, velocityText } from "../src/fit/force_unit.ts";
import { barPart, digitsFor, intervalText, valueShare } from "../src/fit/intervals.ts";
import { parameterUnit, plainName, shortName, shortNames } from "../src/fit/names.ts";
import { closestPairs, correlationOf, pearson, strongWords } from "../src/fit/pairs.ts";
import { commonExtent, curveCharts, panelsOf } from "../src/fit/panels.ts";
import { profileWords, riseTop } from "../src/fit/profiles.ts";
import { residualScale, residualsOf } from "../src/fit/residuals.ts";
import { startEnds } from "../src/fit/starts.ts";
import { verdictTone } from "../src/fit/verdicts.ts";
import type { FitParameter } from "../src/report_data.ts";
import { bareFit, cylinderForce, fitFixture, largeFit } from "./fit_fixture.mjs";

const parameter = (changes: Partial<FitParameter>): FitParameter => ({ ...fitFixture().parameters[0]!, ...changes });

describe("names of parameters", () => {
  it("are symbols and words without their unit, elements of lists counted from 1", () => {
    const names = ["tissue.hyperelastic.mu_Pa[0]", "tissue.poisson_ratio", "tissue.viscosity_Pa_s", "a.tau_s[11]"];
    expect(names.map((name) => plainName(shortName(name)))).toEqual(["μ₁", "Poisson’s ratio", "viscosity", "τ₁₂"]);
  });

  it("tell two of the same last part apart by the part before", () => {
    const names = shortNames([{ name: "tissue.mu_Pa" }, { name: "capsule.mu_Pa" }, { name: "tissue.nu" }]);
    expect(names.map(plainName)).toEqual(["tissue μ", "capsule μ", "ν"]);
  });

  it("come with prefixed units only where a prefix means what it seems to", () => {
    expect(parameterUnit({ unit: "Pa", value: 1192 })).toEqual({ unit: "kPa", factor: 1e-3 });
    expect(parameterUnit({ unit: "m²", value: 1e-6 })).toEqual({ unit: "m²", factor: 1 });
    expect(parameterUnit({ unit: "-", value: 0.4 })).toEqual({ unit: "", factor: 1 });
  });
});

describe("intervals", () => {
  it("ask for two digits of their half width", () => {
    expect(digitsFor(1192, [1131, 1253])).toBe(4); // ± 61 → 1192
    expect(digitsFor(1192, [1191.4, 1192.6])).toBe(6); // ± 0.6 → 1192.00
    expect(digitsFor(1192, [100, 1e5])).toBe(3);
    expect(digitsFor(1192, null)).toBe(4);
  });

  it("say which end is open", () => {
    expect(intervalText([1131, 1253], 1e-3, 4)).toBe("1.131 – 1.253");
    expect(intervalText([1131, null], 1, 4)).toBe("above 1131");
    expect(intervalText([null, -2], 1, 2)).toBe("below −2.0");
    expect(intervalText([null, null], 1, 4)).toBe("open");
    expect(intervalText(null, 1, 4)).toBe("–");
  });

  it("lie between the bounds on the parameter's own scale, cut at them", () => {
    const log = parameter({ low: 100, high: 1e4, scale: "log", value: 1000 });
    expect(valueShare(log)).toBeCloseTo(0.5, 12);
    expect(barPart(log, [-5, 1e9])).toEqual({ start: 0, end: 1, openLow: false, openHigh: false });
    const linear = parameter({ low: 0, high: 10, scale: "linear" });
    expect(barPart(linear, [2.5, null])).toEqual({ start: 0.25, end: 1, openLow: false, openHigh: true });
  });

  it("have a tone that goes with the verdict", () => {
    const verdicts = ["identified", "negligible", "weak", "at bound", "not identifiable"] as const;
    expect(verdicts.map(verdictTone)).toEqual(["pass", "pass", "warn", "warn", "fail"]);
  });
});

describe("profiles", () => {
  const profile = (rise: number[], words = "") => ({
    parameter: "p",
    values: rise.map((_, at) => at),
    rise,
    threshold: 3.84,
    words,
  });

  it("are flat, open or bounded by where they cross the threshold", () => {
    expect(profileWords(profile([5, 0, 5]))).toMatch(/Bounded/);
    expect(profileWords(profile([1, 0, 1]))).toMatch(/Flat/);
    expect(profileWords(profile([5, 0, 1]))).toMatch(/larger/);
    expect(profileWords(profile([1, 0, 5]))).toMatch(/smaller/);
    expect(profileWords(profile([1, 0, 5], "As the engine says."))).toBe("As the engine says.");
  });

  it("always show their threshold, and not far beyond it", () => {
    expect(riseTop(profile([0.1, 0, 0.1]))).toBeGreaterThan(3.84);
    expect(riseTop(profile([1e6, 0, NaN]))).toBeLessThan(4 * 3.84);
  });
});

describe("correlations", () => {
  it("of replicates are found where the fit brings none", () => {
    const fit = { ...fitFixture(), correlation: [] };
    const matrix = correlationOf(fit);
    expect(matrix[0]![0]).toBeCloseTo(1, 12);
    expect(matrix[0]![1]!).toBeCloseTo(-0.94, 1); // 200 replicates of −0.94: standard error 0.008
    expect(pearson([1, 1, 1], [1, 2, 3])).toBeNull();
  });

  it("are in order of their size, without those unknown", () => {
    const matrix = [
      [1, 0.2, null],
      [0.2, 1, -0.95],
      [null, -0.95, 1],
    ];
    expect(closestPairs(matrix, 9)).toEqual([
      { a: 1, b: 2, r: -0.95 },
      { a: 0, b: 1, r: 0.2 },
    ]);
    expect(strongWords(matrix, ["μ", "α", "ν"])).toMatch(/α and ν\. One can compensate/);
    expect(
      strongWords(
        [
          [1, 0.2],
          [0.2, 1],
        ],
        ["μ", "α"],
      ),
    ).toMatch(/^No two/);
  });

  it("are written with two decimals, and never rounded to 1", () => {
    expect([0.5, -0.944, 0.9987, -0.001, 1].map(formatCorrelation)).toEqual(["0.50", "−0.94", "0.999", "0.00", "1.00"]);
  });
});

describe("charts of curves", () => {
  it("are one for each group and use, fitted ones first", () => {
    const panels = panelsOf(fitFixture());
    expect(panels.map((panel) => [panel.group.held_out, panel.curves.length])).toEqual([
      [false, 3],
      [true, 2],
    ]);
    expect(panelsOf(largeFit())).toHaveLength(10);
  });

  it("draw measured below simulated, in the units of the axes, one entry of the legend for each", () => {
    const fit = fitFixture();
    const [model] = curveCharts(panelsOf(fit));
    expect([...new Set(model!.lines.map((line) => line.entry))]).toEqual(["measured", "simulated", "further"]);
    expect(model!.lines).toHaveLength(8);
    const simulated = model!.lines[3]!;
    expect(simulated.x.at(-1)).toBeCloseTo(60, 9);
    const expected = cylinderForce(0.018, { mu: 1192, alpha: 6.38 }) * fit.y.scale * (1 + 0.12 * Math.log10(1 / 0.6));
    expect(simulated.y.at(-1)! / expected).toBeCloseTo(1, 9);
    expect(model!.lines[0]!.style).not.toEqual(lineStyle(0));
  });

  it("share their range unless one would be flat in it", () => {
    const extent = (xMax: number, yMax: number) => ({ xMin: 0, xMax, yMin: 0, yMax });
    expect(commonExtent([extent(10, 5), extent(8, 3)])).toEqual(extent(10, 5));
    expect(commonExtent([extent(10, 5), extent(10, 1)])).toBeNull();
    expect(commonExtent([])).toBeNull();
  });
});

describe("residuals", () => {
  it("are measured minus simulated in the unit of the charts, gaps kept", () => {
    const curve = { ...fitFixture().curves[0]!, measured: [1, 2, 3], fitted: [0.5, 2.5, NaN] };
    expect(residualsOf({ ...curve, y: { label: "force [N]", scale: 10 } })).toEqual([5, -5, NaN]);
  });

  it("have a scale however many samples there are", () => {
    const curve = bareFit().curves[0]!;
    const many = { ...curve, measured: Array(300_000).fill(1), fitted: Array(300_000).fill(3) };
    const y = { label: "force [N]", scale: 1 };
    expect(residualScale({ ...bareFit(), curves: [{ ...many, y }] }, y).high).toBeCloseTo(2.16, 9);
  });

  it("share a symmetric scale that holds all of them and the noise", () => {
    const fit = largeFit();
    const scale = residualScale(fit, fit.y);
    expect(scale.low).toBe(-scale.high);
    const largest = fit.curves.flatMap(residualsOf).map(Math.abs);
    expect(scale.high).toBeGreaterThan(Math.max(...largest));
  });
});

describe("a fit in short", () => {
  const words = (fit: Parameters<typeof fitLines>[0]) =>
    Object.fromEntries(fitLines(fit).map((l) => [l.name, l.words]));

  it("is five lines, each one sentence, whatever is known", () => {
    for (const fit of [fitFixture(), bareFit(), largeFit()]) {
      const lines = fitLines(fit);
      expect(lines.map(({ name }) => name)).toEqual(["Fitted", "Result", "Error", "Certainty", "Next"]);
      for (const line of lines) expect(line.words).toMatch(/\S.*\.$/);
      expect(lines.some((line) => /tissue\.|undefined|NaN/.test(line.words))).toBe(false);
    }
  });

  it("says what came out, with units and intervals, and what it is not sure of", () => {
    const short = words(fitFixture());
    expect(short["Result"]).toMatch(/^μ₁ = 1\.19\d\u00a0kPa \(95 %: /);
    expect(short["Fitted"]).toMatch(/to 3 curves; 2 curves held out to test it\.$/);
    const unknown = fitFixture().parameters.find((parameter) => parameter.verdict === "not identifiable")!;
    expect(short["Certainty"]).toContain(`do not determine ${plainName(shortName(unknown.name))}`);
    expect(words(bareFit())["Next"]).toMatch(/^Let the fit run to its end/);
  });

  it("writes parameters of all its sentences as people do", () => {
    const fit = { ...fitFixture(), conclusions: ["tissue.hyperelastic.mu_Pa[0] is 1."] };
    expect(readable(fit.conclusions, fit)).toEqual(["μ₁ is 1."]);
  });
});

describe("numbers in words", () => {
  it("count what was fitted and held out", () => {
    expect(fittedText(fitFixture())).toBe("3 parameters fitted to 3 curves, 2 curves held out.");
    expect(fittedText(bareFit())).toBe("1 parameter fitted to 1 curve, none held out.");
  });

  it("give key figures in the unit of the charts, and say what there is none of", () => {
    const value = (fit: Parameters<typeof keyFigureTexts>[0]) =>
      Object.fromEntries(keyFigureTexts(fit).map((figure) => [figure.name, figure.value]));
    expect(value({ ...fitFixture(), rms_fit: 0.5 })["Error of fitted curves, rms"]).toBe("0.255\u00a0kPa"); // 0.5 N on 19.63 cm²
    expect(value(fitFixture())["Best optimum found by"]).toBe("16 of 20 starts");
    expect(value(bareFit())).toMatchObject({
      "Error of held-out curves, rms": "none held out",
      "Best optimum found by": "1 of 1 start",
    });
  });

  it("write times, velocities and forces as people do", () => {
    expect([41.3, 200, 7384, NaN].map(wallText)).toEqual([
      "41.3\u00a0s",
      "3\u00a0min 20\u00a0s",
      "2\u00a0h 3\u00a0min",
      "–",
    ]);
    expect(velocityText([2e-3, 1e-2, NaN])).toBe("2 – 10\u00a0mm/s");
    expect(velocityText([10e-3 / 60])).toBe("0.167\u00a0mm/s");
    expect(velocityText([0.1])).toBe("100\u00a0mm/s");
    expect(velocityText([NaN, 0])).toBe("");
    expect(forceText(null, { label: "force [mN]", scale: 1000 })).toBe("–");
    expect(forceText(0.012, { label: "force [mN]", scale: -1000 })).toBe("12.0\u00a0mN");
  });

  it("compare errors with spreads, criteria with the least of them, widths with widths", () => {
    expect(spreadRatio({ name: "", held_out: true, rms_N: 1, spread_N: 2 })).toBe(0.5);
    expect(spreadRatio({ name: "", held_out: true, rms_N: 1, spread_N: null })).toBeNull();
    expect(spreadRatio({ name: "", held_out: true, rms_N: 1, spread_N: 0 })).toBeNull();
    expect(aboveLeast([5241.3, 812.3, NaN])).toEqual(["4429", "0", "–"]);
    expect(shrinkText({ width_now: 2, width_after: 1 })).toBe("×\u202f2.00");
    expect(shrinkText({ width_now: 2, width_after: 2 })).toBe("not at all");
    expect(shrinkText({ width_now: NaN, width_after: 2 })).toBe("–");
  });

  it("order all starts by cost, told from the optima where they are not known", () => {
    const known = startEnds(fitFixture());
    const told = startEnds({ ...fitFixture(), start_costs: [] });
    expect(known).toEqual(told);
    expect(known.map((end) => end.best).lastIndexOf(true)).toBe(15);
  });
});

describe("files", () => {
  it("quote texts that hold commas, quotes or line breaks, and leave gaps empty", () => {
    expect(
      rowsToCsv(
        ["a", "b,c"],
        [
          ['say "x"', NaN],
          [null, -1.5],
        ],
      ),
    ).toBe('a,"b,c"\n"say ""x""",\n,-1.5\n');
  });

  it("hold every sample of every curve in SI", () => {
    const fit = fitFixture();
    const lines = curvesCsv(fit).trimEnd().split("\n");
    expect(lines).toHaveLength(1 + 5 * 260);
    const last = lines[260]!;
    expect(last).toMatch(/^A1,"EF10_100T, 10 mm\/min",0,/);
    expect(Number(last.split(",").at(-5))).toBe(fit.curves[0]!.fitted[259]);
  });

  it("keep open ends of intervals empty", () => {
    const row = parametersCsv(fitFixture()).trimEnd().split("\n")[3]!.split(",");
    expect(row.slice(9, 11)).toEqual(["", ""]);
    expect(row.at(-1)).toBe("not identifiable");
  });

  it("are offered only where there is something in them", () => {
    expect(csvFiles(bareFit()).map((file) => file.name)).toEqual(["curves", "parameters", "starts"]);
    expect(csvFiles(fitFixture())).toHaveLength(6);
  });
});
