// fixture.mjs — a report made without the engine: realistic data for the tests of the page.
//
// A 4 × 4 × 8 cm box of cubes cut in six tets, its bottom held, three top vertices pressed down. The motion is
// a formula (a dent that fades with depth and distance, with sideways bulging); the intensity of a vertex is
// s = √(3 (1 − q) / 2) of the formula's gradient, q = 3 J^⅔ / tr(FᵀF), so that colours follow the shape.
const NX = 4;
const NZ = 8;
const CELL = 0.01; // m
const CENTRE = [0.0183, 0.0183];
const HEIGHT = NZ * CELL;

const vertexId = (i, j, k) => i + (NX + 1) * (j + (NX + 1) * k);

/** Rest positions of the box, xyz per vertex [m]. */
function boxVertices() {
  const points = [];
  for (let k = 0; k <= NZ; k++)
    for (let j = 0; j <= NX; j++) for (let i = 0; i <= NX; i++) points.push([i * CELL, j * CELL, k * CELL]);
  return points;
}

/** Boundary triangles of the Kuhn split, outward: faces that only one tet has. */
function boundaryTriangles(points) {
  const orders = [
    [0, 1, 2],
    [0, 2, 1],
    [1, 0, 2],
    [1, 2, 0],
    [2, 0, 1],
    [2, 1, 0],
  ];
  const faces = new Map();
  for (let k = 0; k < NZ; k++)
    for (let j = 0; j < NX; j++)
      for (let i = 0; i < NX; i++) {
        for (const order of orders) {
          const at = [i, j, k];
          const tet = [vertexId(...at)];
          for (const axis of order) tet.push((at[axis]++, vertexId(...at)));
          for (let skip = 0; skip < 4; skip++) {
            const face = tet.filter((_, corner) => corner !== skip);
            const key = [...face].sort((a, b) => a - b).join();
            if (faces.has(key)) faces.delete(key);
            else faces.set(key, outward(face, tet[skip], points));
          }
        }
      }
  return [...faces.values()].flat();
}

function outward([a, b, c], inside, points) {
  const d = (p, q) => points[p].map((v, n) => v - points[q][n]);
  const [u, v, w] = [d(b, a), d(c, a), d(inside, a)];
  const volume =
    w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) + w[2] * (u[0] * v[1] - u[1] * v[0]);
  return volume > 0 ? [a, c, b] : [a, b, c];
}

/** Displacement of a point when the tool stands `depth` deep [m]. */
function displacement([x, y, z], depth) {
  const rx = x - CENTRE[0];
  const ry = y - CENTRE[1];
  const up = Math.max(0, z) / HEIGHT;
  const width = 0.008 + 0.02 * (1 - up);
  const dent = depth * up ** 2.2 * Math.exp(-(rx * rx + ry * ry) / (2 * width * width));
  const bulge = 5 * depth * up * (1 - up) * Math.exp(-((up - 0.75) ** 2) / 0.06);
  return [bulge * rx * 3, bulge * ry * 3, -dent];
}

/** s of the formula's deformation gradient at a point, by central differences. */
function intensity(point, depth) {
  const e = 1e-5;
  const F = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  for (let n = 0; n < 3; n++) {
    const plus = point.map((v, i) => v + (i === n ? e : 0));
    const minus = point.map((v, i) => v - (i === n ? e : 0));
    const [a, b] = [displacement(plus, depth), displacement(minus, depth)];
    for (let m = 0; m < 3; m++) F[m][n] += (a[m] - b[m]) / (2 * e);
  }
  const J =
    F[0][0] * (F[1][1] * F[2][2] - F[1][2] * F[2][1]) -
    F[0][1] * (F[1][0] * F[2][2] - F[1][2] * F[2][0]) +
    F[0][2] * (F[1][0] * F[2][1] - F[1][1] * F[2][0]);
  const q = J > 0 ? (3 * J ** (2 / 3)) / F.flat().reduce((sum, v) => sum + v * v, 0) : 0;
  return Math.sqrt(Math.max(0, 1.5 * (1 - q)));
}

const base64 = (typed) => Buffer.from(typed.buffer).toString("base64");

function frame(points, time, depth) {
  const u = points.flatMap((point) => displacement(point, depth));
  const s = points.map((point) => intensity(point, depth));
  const scale = Math.max(...u.map(Math.abs)) || 0;
  const most = Math.max(...s);
  return {
    time_s: time,
    displacement_scale_m: scale,
    displacement: base64(Int16Array.from(u, (v) => (scale > 0 ? Math.round((v / scale) * 32767) : 0))),
    intensity_max: most,
    intensity: base64(Uint8Array.from(s, (v) => (most > 0 ? Math.round((v / most) * 255) : 0))),
  };
}

/** Surface with `count` frames of a press to `depth` in `duration`. */
export function surface(count, depth, duration) {
  const points = boxVertices();
  const driven = [vertexId(2, 2, NZ), vertexId(1, 2, NZ), vertexId(2, 1, NZ)];
  const fixed = Uint8Array.from(points, (point, id) => (point[2] === 0 ? 1 : driven.includes(id) ? 2 : 0));
  return {
    vertices: points.length,
    triangles: base64(Uint32Array.from(boundaryTriangles(points))),
    rest: base64(Float32Array.from(points.flat())),
    fixed: base64(fixed),
    frames: Array.from({ length: count }, (_, n) =>
      frame(points, (duration * n) / (count - 1), (depth * n) / (count - 1)),
    ),
  };
}

const COLUMNS = [
  "time_s",
  "depth_m",
  "force_x_N",
  "force_y_N",
  "force_z_N",
  "force_N",
  "elastic_N",
  "viscous_N",
  "damping_N",
  "inertial_N",
  "gravity_N",
  "load_N",
  "energy_elastic_J",
  "energy_kinetic_J",
  "energy_dissipated_J",
  "work_tools_J",
  "work_loads_J",
];

/** Columns of forces.csv for a press at `speed` [m/s] to 10 mm, held for a tenth of the time. */
export function forces(law, speed, viscosity) {
  const samples = 500;
  const press = 0.01 / speed;
  const data = COLUMNS.map(() => []);
  let work = 0;
  let last = { depth: 0, force: 0 };
  let dissipated = 0;
  for (let n = 0; n <= samples; n++) {
    const time = (1.1 * press * n) / samples;
    const moving = time < press;
    const depth = Math.min(time, press) * speed;
    const ring = 0.004 * Math.exp(-time / (0.04 * press)) * Math.sin((60 * time) / press);
    const elastic = law(depth) + ring;
    const viscous = moving ? viscosity * speed : 0;
    const inertial = moving ? 0.0006 * Math.exp(-time / (0.01 * press)) : 0;
    const force = elastic + viscous + inertial;
    work += 0.5 * (force + last.force) * (depth - last.depth);
    dissipated += viscous * (depth - last.depth);
    last = { depth, force };
    const kinetic = moving ? 2e-7 * (speed / 0.01) ** 2 : 2e-8;
    [
      time,
      depth,
      0.02 * force,
      -0.01 * force,
      -force,
      force,
      elastic,
      viscous,
      0,
      inertial,
      0,
      0,
      work - dissipated - kinetic,
      kinetic,
      dissipated,
      work,
      0,
    ].forEach((value, at) => data[at].push(value));
  }
  return { columns: COLUMNS, data };
}

export function summary(columns, wall) {
  const at = (name) => columns.data[columns.columns.indexOf(name)];
  const last = (name) => at(name)[at(name).length - 1];
  return {
    vertices: 225,
    tets: 768,
    steps: 51800,
    time_s: last("time_s"),
    step_s: 2.125e-5,
    stable_step_s: 2.361e-5,
    wall_s: wall,
    ns_per_tet_step: (wall * 1e9) / (51800 * 768),
    peak_force_N: Math.max(...at("force_N")),
    energy_elastic_J: last("energy_elastic_J"),
    energy_kinetic_J: last("energy_kinetic_J"),
    energy_dissipated_J: last("energy_dissipated_J"),
    work_tools_J: last("work_tools_J"),
    work_loads_J: 0,
    inverted_tets_most: 0,
    first_inversion_s: -1,
    state_hash: "8f3c0a77d15be942",
    end: "finished",
    version: "0.1.0",
  };
}

const x = Array.from({ length: 101 }, (_, n) => (0.4 * n) / 100);
const laws = {
  linear: x.map(() => 3600),
  step: x.map((s) => 3600 * (1 + 0.9 / (1 + Math.exp(-(s - 0.12) / 0.004)))),
  rising: x.map((s) => 3600 * (1 + 6 * s)),
};
const lawOf = (y) => ({ measure: "equivalent shear strain s [-]", x, curves: [{ label: "E", y }] });
const stepForce = (d) => 51.2 * d * (1 + 0.35 * Math.floor(d / 0.0021) * 0.28);

export const SOURCE = `# Figure 2: three tissues under the same press.
title = "Figure 2"
description = "Three tissues, one press."

[mesh]
kind = "box"
cells = [4, 4, 8]      # cubes, six tetrahedra each
size_mm = [40, 40, 80]

[tissue]
youngs_modulus = 3600.0  # Pa
poissons_ratio = 0.4
density = 1000.0         # kg/m3

[[variants]]
name = "tissue1"
label = "Tissue 1 # step"
tissue.law = { kind = "step", threshold = 0.12, factor = 1.9 }
`;

function figure2() {
  const make = (name, label, law, y, depth, wall) => {
    const columns = forces(law, 0.01, 0.02);
    return {
      name,
      label,
      summary: summary(columns, wall),
      forces: columns,
      law_curves: [lawOf(y)],
      surface: surface(24, depth, 1.1),
    };
  };
  return {
    name: "figure2",
    title: "Figure 2: three tissues",
    description:
      "A triangle of the top face is pressed down by 10 mm at 10 mm/s, the bottom is held. The linear tissue answers in proportion; " +
      "tissue 1 stiffens by a step when an element passes a threshold, so its force rises in steps; tissue 2 stiffens in proportion to its deformation, " +
      "so its force is close to second order.",
    notes: [
      "Density 1000 kg/m³, no mass scaling: the paper gives no masses. The step is chosen by the program, below the stable step.",
      "Poisson's ratio 0.4 and E = 3600 Pa at rest follow the paper; the threshold s = 0.12 and the factor 1.9 of tissue 1 are ours.",
      "The pressed triangle has the top vertices (2,2), (1,2), (2,1); another triangle or another split changes the stiffness by up to 4 %.",
    ],
    advice: [
      {
        rule: "coarse",
        kind: "warning",
        text: '"tool" acts on 2 faces with edges of 11.4 mm: its force may be far off; mesh.cells = [16, 16, 16] takes more.',
        variants: ["Linear", "Tissue 1: step", "Tissue 2: rising with s"],
      },
      { rule: "slow", kind: "remark", text: "tools move by 0.1 µm a step at most.", variants: ["Linear"] },
    ],
    source: SOURCE,
    variants: [
      make("linear", "Linear", (d) => 51.2 * d, laws.linear, 0.01, 2.31),
      make("tissue1", "Tissue 1: step", stepForce, laws.step, 0.01, 2.84),
      make("tissue2", "Tissue 2: rising with s", (d) => 51.2 * d * (1 + 95 * d), laws.rising, 0.01, 2.79),
    ],
    charts: [
      {
        title: "Force against depth",
        x: { column: "depth_m", label: "Depth [mm]", scale: 1000 },
        y: { column: "force_N", label: "Force [N]", scale: 1 },
        variants: null,
        fits: [
          {
            label: "quadratic fit, tissue 2",
            x: [0, 2, 4, 6, 8, 10],
            y: [0, 2, 4, 6, 8, 10].map((d) => 51.2 * d * 1e-3 * (1 + 0.095 * d)),
          },
        ],
      },
      {
        title: "Force against time",
        x: { column: "time_s", label: "Time [s]", scale: 1 },
        y: { column: "force_N", label: "Force [N]", scale: 1 },
        variants: null,
      },
    ],
    tables: [
      {
        title: "Fits",
        columns: ["Tissue", "Line, R²", "Quadratic, R²", "Slope at rest [N/m]"],
        rows: [
          ["Linear", 0.99999, 0.99999, 51.21],
          ["Tissue 1", 0.9871, 0.9902, 51.18],
          ["Tissue 2", 0.9688, 0.99996, 51.24],
        ],
        note: "Least squares over the press, 1 to 10 mm.",
      },
    ],
    checks: [
      {
        what: "Tissue 2 follows a quadratic",
        measured: "R² = 0.99996",
        expected: "R² ≥ 0.999 (Schwartz 2002, fig. 2)",
        pass: true,
      },
      { what: "A line does not fit tissue 2", measured: "R² = 0.9688", expected: "R² < 0.99", pass: true },
      {
        what: "Quasi-static stiffness of the linear tissue",
        measured: "51.21 N/m",
        expected: "51.19 N/m ± 0.5 % (independent static solve)",
        pass: true,
      },
      {
        what: "Every force step of tissue 1 coincides with elements passing the threshold",
        measured: "3 of 4 steps",
        expected: "all steps",
        pass: false,
      },
    ],
  };
}

function figure3() {
  const speeds = [0.002, 0.005, 0.01, 0.02, 0.05];
  return {
    name: "figure3a",
    title: "Figure 3a: speed of the press",
    description:
      "A viscous tissue, η = 1000 Pa·s, pressed at five speeds. The viscous part appears at the first instant and is proportional to the speed.",
    notes: ["The viscous tensor is the shear form, σ = 2 η ε̇; the paper leaves the choice open."],
    source: SOURCE,
    variants: speeds.map((speed, n) => {
      const columns = forces((d) => 51.2 * d, speed, 14);
      return {
        name: `v${n}`,
        label: `${speed * 1000} mm/s`,
        summary: summary(columns, 1.1 + n),
        forces: columns,
        law_curves: [lawOf(laws.linear)],
        surface: n < 2 ? surface(10, 0.01, (1.1 * 0.01) / speed) : null,
      };
    }),
    charts: [],
    tables: [],
    checks: [
      {
        what: "Overhead at the start is proportional to the speed",
        measured: "0.3 % from a line through 0",
        expected: "within 2 %",
        pass: true,
      },
    ],
  };
}

/** A scene with almost nothing in it, and what there is broken: the page must cope. */
function bare() {
  return {
    name: "bare",
    title: "A run that was interrupted",
    description: "",
    notes: [],
    source: "",
    charts: [],
    tables: [],
    checks: [],
    variants: [
      {
        name: "empty",
        label: "Nothing recorded",
        summary: {},
        forces: { columns: [], data: [] },
        law_curves: [],
        surface: null,
      },
      {
        name: "gaps",
        label: "With gaps",
        summary: { steps: 3, peak_force_N: null, odd_new_key_Pa: 12.5 },
        forces: {
          columns: ["time_s", "depth_m", "force_N"],
          data: [
            [0, 0.1, 0.2, 0.3],
            [0, 0.001, null, 0.003],
            [0, 0.05, null, 0.17],
          ],
        },
        law_curves: [{ measure: "", x: [], curves: [] }],
        surface: { ...surface(2, 0.004, 1), frames: [] },
      },
      {
        name: "short",
        label: "Zero-length columns",
        summary: { end: "interrupted" },
        forces: { columns: ["time_s", "force_N"], data: [[], []] },
        law_curves: [],
        surface: null,
      },
    ],
  };
}

/** The whole report. */
export function fixtureReport() {
  return {
    format: 1,
    title: "Soft tissue under a press",
    subtitle: "Test data made by a formula, in the shape of the figures of Schwartz et al. 2002",
    version: "0.1.0",
    created: "2026-02-03T14:05:09Z",
    machine: "2 × Example CPU 2.4 GHz, Linux 6.1, g++ 12.2",
    scenes: [figure2(), figure3(), bare()],
  };
}
