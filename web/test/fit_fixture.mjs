// fit_fixture.mjs — fits made without the engine: a cylinder compressed, as one-term Ogden tissue would answer.
//
//   nominal stress P(λ) = 2 μ / α · (λ^(α−1) − λ^(−α/2−1)),   force = P · area,   + noise of a fixed seed
//
// The "measured" curves scatter about the truth by repetition (a factor) and by noise; intervals, profiles and
// replicates are those of a quadratic likelihood with the standard deviations and the correlation given here.

const HEIGHT = 0.03; // m
const AREA = Math.PI * 0.025 ** 2; // m²
const GROUP = "EF10_100T, 10 mm/min";
const TRUTH = { mu: 1180, alpha: 6.4 };

/** Numbers of a fixed sequence: uniform in (0, 1), and normal. */
function randomNumbers(seed) {
  let state = seed >>> 0;
  const uniform = () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return (((mixed ^ (mixed >>> 14)) >>> 0) + 0.5) / 4294967296;
  };
  const normal = () => Math.sqrt(-2 * Math.log(uniform())) * Math.cos(2 * Math.PI * uniform());
  return { uniform, normal };
}

const X = { label: "compressive strain [%]", scale: 100 / HEIGHT };
const Y = { label: "nominal stress [kPa]", scale: 1e-3 / AREA };

/** Force on the cylinder [N] at a displacement [m]; compression counts positive. */
export function cylinderForce(displacement, { mu, alpha }) {
  const stretch = 1 - displacement / HEIGHT;
  return -((2 * mu) / alpha) * (stretch ** (alpha - 1) - stretch ** (-alpha / 2 - 1)) * AREA;
}

function curve(name, group, heldOut, velocity, random, factor, points = 260) {
  const noise = 0.012;
  const drive = Array.from({ length: points }, (_, at) => (0.6 * HEIGHT * at) / (points - 1));
  const overhead = 1 + 0.12 * Math.log10(velocity / 1e-4);
  const measured = drive.map(
    (d) => overhead * factor * cylinderForce(d, TRUTH) * (1 + 0.02 * Math.sin(260 * d)) + noise * random.normal(),
  );
  const fitted = drive.map((d) => overhead * cylinderForce(d, { mu: 1192, alpha: 6.38 }));
  return {
    name,
    group,
    velocity_m_s: velocity,
    held_out: heldOut,
    time_s: drive.map((d) => d / velocity),
    drive,
    measured,
    fitted,
    further_low: fitted.map((force) => 0.9 * force),
    further_high: fitted.map((force) => 1.1 * force),
    noise,
    rms: rms(measured.map((value, at) => value - fitted[at])),
    x: { ...X, of: "drive", log: false },
    y: Y,
    unit: "N",
    drive_unit: "m",
  };
}

const rms = (values) => Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length);

function groupOf(name, heldOut, curves) {
  const own = curves.filter((c) => c.group === name && c.held_out === heldOut);
  const all = curves.filter((c) => c.group === name);
  const mean = all[0].measured.map((_, at) => all.reduce((sum, c) => sum + c.measured[at], 0) / all.length);
  const spread = rms(all.flatMap((c) => c.measured.map((value, at) => value - mean[at])));
  return {
    name,
    held_out: heldOut,
    rms_N: rms(own.map((c) => c.rms)),
    spread_N: all.length > 1 ? spread * Math.sqrt(all.length / (all.length - 1)) : null,
  };
}

const groupsOf = (curves) =>
  [...new Map(curves.map((c) => [`${c.group}|${c.held_out}`, c])).values()].map((c) =>
    groupOf(c.group, c.held_out, curves),
  );

function parameter(name, unit, scale, [low, high], value, sd, verdict, words) {
  const interval = [value - 1.96 * sd, value + 1.96 * sd];
  const within = interval.map((end) => Math.min(high, Math.max(low, end)));
  return {
    name,
    unit,
    scale,
    low,
    high,
    value,
    sd,
    ci95_curvature: within,
    further95: [value - 6 * sd, value + 6 * sd],
    ci95_profile: verdict === "not identifiable" ? [null, null] : [value - 1.87 * sd, value + 2.1 * sd],
    ci95_bootstrap: [Math.max(low, value - 1.7 * sd), Math.min(high, value + 2.2 * sd)],
    verdict,
    words,
  };
}

function profile(given, flat) {
  const reach = flat ? 0.42 * (given.high - given.low) : 3.2 * given.sd;
  const values = Array.from({ length: 21 }, (_, at) => given.value + ((at - 10) / 10) * reach).filter(
    (value) => value >= given.low && value <= given.high,
  );
  const width = flat ? 3 * reach : given.sd;
  return {
    parameter: given.name,
    values,
    rise: values.map((value) => ((value - given.value) / width) ** 2 * (1 + 0.08 * ((value - given.value) / width))),
    threshold: 3.841,
    words: flat ? "Flat: any value within the bounds fits the curves as well." : "",
  };
}

/** Replicates of parameters with these standard deviations; the first two move together by `r`. */
function replicates(parameters, r, count, random) {
  return Array.from({ length: count }, () => {
    const first = random.normal();
    return parameters.map(({ value, sd, low, high }, at) => {
      const own = random.normal();
      const step = at === 0 ? first : at === 1 ? r * first + Math.sqrt(1 - r * r) * own : own;
      return Math.min(high, Math.max(low, value + sd * step));
    });
  });
}

/** A fit of three parameters to three repetitions, two held out; one parameter cannot be told from these curves. */
export function fitFixture() {
  const random = randomNumbers(7);
  const slow = 10e-3 / 60;
  const curves = [
    ...["A1", "A2", "A3"].map((name, at) => curve(name, GROUP, false, slow, random, [0.968, 1.012, 1.034][at])),
    ...["A4", "A5"].map((name, at) => curve(name, GROUP, true, slow, random, [0.979, 1.041][at])),
  ];
  const parameters = [
    parameter(
      "tissue.hyperelastic.mu_Pa[0]",
      "Pa",
      "log",
      [100, 1e5],
      1192,
      31,
      "identified",
      "The curves fix it to 5 %.",
    ),
    parameter(
      "tissue.hyperelastic.alpha[0]",
      "",
      "linear",
      [-20, 20],
      6.38,
      0.21,
      "weak",
      "It is bounded, but moves with μ: the two are fixed together better than each alone.",
    ),
    parameter(
      "tissue.poisson_ratio",
      "-",
      "linear",
      [0.3, 0.499],
      0.452,
      0.06,
      "not identifiable",
      "Every value within the bounds fits the curves as well: uniaxial force alone does not see it.",
    ),
  ];
  return {
    name: "phantom",
    title: "Phantom EF10_100T",
    description:
      "Silicone cylinders of 50 mm diameter and 30 mm height, compressed at 10 mm/min to 60 % strain. " +
      "Test data made by a formula, in the shape of the measured ones.",
    notes: [
      "Contact is taken where the force leaves the band of its noise; the offset was 0.21 mm.",
      "Curves are resampled at 260 displacements of equal distance.",
    ],
    source:
      'title = "Phantom EF10_100T"\nscene = "phantom_scene.toml" # beside this file\n\n[[parameter]]\nkey = "tissue.hyperelastic.mu_Pa[0]"\nlow = 100\nhigh = 1e5\nscale = "log"\n',
    tissue: "[tissue.hyperelastic]\nmu_Pa = [1192]\nalpha = [6.38]\n",
    law: "Ogden, 1 term",
    parameters,
    correlation: [
      [1, -0.94, 0.08],
      [-0.94, 1, -0.12],
      [0.08, -0.12, 1],
    ],
    x: X,
    y: Y,
    curves,
    groups: groupsOf(curves),
    tests: [],
    discovered: [],
    law_curves: [],
    rms_fit: rms(curves.filter((c) => !c.held_out).map((c) => c.rms)),
    rms_heldout: rms(curves.filter((c) => c.held_out).map((c) => c.rms)),
    spread_N: rms(groupsOf(curves).map((group) => group.spread_N)),
    profiles: parameters.map((given) => profile(given, given.verdict === "not identifiable")),
    basins: [
      { cost: 388.2, found: 16, values: [1192, 6.38, 0.452], best: true },
      { cost: 1204.7, found: 3, values: [412, -9.1, 0.31], best: false },
      { cost: 5230.1, found: 1, values: [100, 20, 0.499], best: false },
    ],
    start_costs: [0, 0, 1, 0, 0, 0, 0, 2, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0].map((basin) => ({
      cost: [388.2, 1204.7, 5230.1][basin],
      basin,
    })),
    starts: 20,
    starts_planned: 20,
    forward_runs: 1874,
    forward: "The quasi-static integrator with 40 steps is the cheapest whose error stays below the noise.",
    forward_error_N: 0.0031,
    wall_s: 41.3,
    complete: true,
    bootstrap: { replicates: 200, values: replicates(parameters, -0.94, 200, random) },
    laws: [
      law("Linear", 1, 2.61, 2.58, 5241, 5246, false, "Misses the upward bend: twenty times the spread."),
      law("Ogden, 1 term", 2, 0.148, 0.152, 812, 821, true, "No further term lowers the held-out error."),
      law("Ogden, 3 terms", 6, 0.141, 0.161, 818, 846, false, "Two terms more than the curves support."),
    ],
    designs: [
      {
        what: "Confined compression to 20 % at 10 mm/min",
        parameter: "tissue.poisson_ratio",
        width_now: 0.199,
        width_after: 0.021,
      },
      {
        what: "The same test at 100 mm/min",
        parameter: "tissue.hyperelastic.alpha[0]",
        width_now: 0.82,
        width_after: 0.61,
      },
    ],
    conclusions: [
      "The held-out repetitions are predicted to within their own spread.",
      "μ and α are fixed by the curves, but only together; Poisson's ratio is not seen by this test.",
      "16 of 20 starts ended in the same optimum.",
    ],
  };
}

function law(name, parameters, rmsFit, rmsHeldOut, aic, bic, best, words) {
  const force = 1e3 * AREA;
  return { name, parameters, rms_fit: rmsFit * force, rms_heldout: rmsHeldOut * force, aic, bic, best, words };
}

/** A fit of one curve of which little is known: interrupted, nothing held out, no profiles, no intervals. */
export function bareFit() {
  const whole = fitFixture();
  const curves = [{ ...whole.curves[0], fitted: whole.curves[0].fitted.map((f, at) => (at > 200 ? null : f)) }];
  return {
    ...whole,
    name: "bare",
    title: "One curve, interrupted",
    description: "",
    notes: [],
    source: "",
    tissue: "",
    law: "",
    curves,
    groups: groupsOf(curves),
    tests: [],
    discovered: [],
    law_curves: [],
    parameters: whole.parameters.slice(0, 1).map((given) => ({
      ...given,
      sd: null,
      ci95_curvature: null,
      further95: null,
      ci95_profile: null,
      ci95_bootstrap: null,
      verdict: "weak",
      words: "",
    })),
    correlation: [],
    profiles: [],
    basins: [{ cost: 412.9, found: 1, values: [1192], best: true }],
    start_costs: [],
    starts: 1,
    rms_heldout: null,
    spread_N: null,
    forward_error_N: null,
    bootstrap: null,
    laws: [],
    designs: [],
    conclusions: [],
    complete: false,
  };
}

/** Twelve parameters with long names, forty curves of ten velocities, open intervals, values at their bounds. */
export function largeFit() {
  const random = randomNumbers(11);
  const velocities = Array.from({ length: 10 }, (_, at) => 2e-4 * 1.6 ** at);
  const curves = velocities.flatMap((velocity, v) =>
    ["a", "b", "c", "d"].map((name) =>
      curve(
        `specimen_2026_liver_lobe_left_${v + 1}${name}`,
        `Left lobe, slab ${v + 1}, lubricated plates, ${(velocity * 1e3).toFixed(2)} mm/s`,
        v > 5,
        velocity,
        random,
        1 + 0.03 * random.normal(),
        120,
      ),
    ),
  );
  const verdicts = ["identified", "weak", "not identifiable", "at bound"];
  const names = ["shear_modulus_long_term_Pa", "relative_modulus", "relaxation_time_s"];
  const parameters = Array.from({ length: 12 }, (_, at) => {
    const value = 10 ** (1 + 0.4 * at);
    const verdict = verdicts[at % 4];
    const name = `tissue.viscoelastic.generalised_maxwell.branches.${names[at % 3]}[${Math.floor(at / 3)}]`;
    const unit = ["Pa", "", "s"][at % 3];
    const words = "A sentence that is as long as the ones about parameters tend to be, with a reason in its end.";
    const given = parameter(
      name,
      unit,
      at % 2 ? "log" : "linear",
      [value / 100, value * 3],
      value,
      0.1 * value,
      verdict,
      words,
    );
    if (verdict === "weak") given.ci95_profile = [given.value * 0.8, null];
    if (verdict === "at bound") given.value = given.high;
    return given;
  });
  const r = (a, b) => (a === b ? 1 : (a + b) % 5 === 0 ? null : Math.cos(1.7 * (a + b)) * 0.999);
  const base = fitFixture();
  return {
    ...base,
    name: "large",
    title: "Twelve parameters of a viscoelastic liver from forty curves at ten velocities",
    parameters,
    correlation: parameters.map((_, a) => parameters.map((__, b) => r(a, b))),
    curves,
    groups: groupsOf(curves),
    tests: [],
    discovered: [],
    law_curves: [],
    profiles: parameters.map((given, at) => profile({ ...given, value: 10 ** (1 + 0.4 * at) }, at % 4 === 2)),
    basins: Array.from({ length: 14 }, (_, at) => ({
      cost: 1e-3 * 3 ** at,
      found: 1 + (at % 3),
      values: parameters.map((given) => given.value * (1 + 0.1 * at)),
      best: at === 0,
    })),
    start_costs: [],
    starts: 27,
    starts_planned: 40,
    forward_runs: 1234567,
    wall_s: 7384,
    bootstrap: { replicates: 60, values: replicates(parameters, 0.8, 60, random) },
    designs: parameters.map((given) => ({
      what: "A relaxation test of ten minutes at 30 % strain after a ramp of one second",
      parameter: given.name,
      width_now: 0.4 * given.value,
      width_after: 0.4 * given.value,
    })),
  };
}

/** A report of fits alone. */
export function fitReport(...fits) {
  return {
    format: 1,
    title: fits.length === 1 ? fits[0].title : "Fits",
    subtitle: "Fitted to curves made by a formula",
    version: "0.1.0",
    created: "2026-02-03T14:05:09Z",
    machine: "2 × Example CPU 2.4 GHz, Linux 6.1, g++ 12.2",
    scenes: [],
    fits,
  };
}
