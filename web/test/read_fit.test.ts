// A fit that was interrupted, or written by another version, becomes one without holes.
import { describe, expect, it } from "vitest";
import { parseReport } from "../src/data/read_report.ts";

function read(fit: unknown) {
  const result = parseReport(JSON.stringify({ format: 1, scenes: [], fits: [fit] }));
  if (!result.ok) throw new Error(result.reason);
  return result.report.fits![0]!;
}

describe("reading a fit", () => {
  it("fills in everything that is missing", () => {
    expect(read({})).toMatchObject({
      name: "fit-1",
      title: "fit-1",
      complete: true,
      parameters: [],
      correlation: [],
      bootstrap: null,
      rms_heldout: null,
      x: { scale: 1 },
    });
  });

  it("makes the lists of a curve equally long, gaps where the simulation ended before", () => {
    const curve = { displacement_m: [0, 1, 2], measured_N: [0, 5, 9], fitted_N: [0, null], group: "A" };
    const fit = read({ curves: [curve] });
    expect(fit.curves[0]!.fitted).toEqual([0, NaN, NaN]);
    expect(fit.groups).toMatchObject([{ name: "A", held_out: false, spread_N: null }]);
  });

  it("gives each curve of another test its own axes", () => {
    const x = { label: "frequency [Hz]", scale: 1, of: "drive", log: true };
    const curve = {
      drive: [1, 10],
      measured: [2, 3],
      fitted: [2, 4],
      rms: 0.7,
      x,
      y: { label: "G [kPa]", scale: 1e-3 },
    };
    const [own] = read({ curves: [curve], tests: [{ name: "A", r2: 0.9, r2_of_alone: { A: 0.99 } }] }).curves;
    expect(own).toMatchObject({ drive: [1, 10], fitted: [2, 4], rms: 0.7, x, y: { scale: 1e-3 }, time_s: [] });
  });

  it("keeps one group for the fitted and one for the held-out curves of a test", () => {
    const curves = [
      { group: "A", held_out: false },
      { group: "A", held_out: true },
      { group: "A", held_out: true },
    ];
    expect(read({ curves }).groups.map((group) => group.held_out)).toEqual([false, true]);
  });

  it("takes a correlation that is not square for none, and null in it for unknown", () => {
    const parameters = [{ name: "a" }, { name: "b" }];
    expect(read({ parameters, correlation: [[1, 0.5]] }).correlation).toEqual([]);
    const square = [
      [1, null],
      [null, 1],
    ];
    expect(read({ parameters, correlation: square }).correlation).toEqual(square);
  });

  it("puts an interval's ends in order, keeps open ends of a profile, and no half of the others", () => {
    const parameter = {
      ci95_curvature: [3, 2],
      ci95_profile: [null, 4],
      ci95_bootstrap: [1, null],
      verdict: "certain",
    };
    expect(read({ parameters: [parameter] }).parameters[0]).toMatchObject({
      ci95_curvature: [2, 3],
      ci95_profile: [null, 4],
      ci95_bootstrap: null,
      verdict: "weak",
    });
  });

  it("drops replicates of another number of parameters", () => {
    const fit = read({ parameters: [{}], bootstrap: { replicates: 2, values: [[1], [1, 2]] } });
    expect(fit.bootstrap).toEqual({ replicates: 2, values: [[1]] });
  });
});
