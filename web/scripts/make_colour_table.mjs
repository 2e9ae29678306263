// make_colour_table.mjs — prints the table of src/mesh3d/colour_table.ts.
//
// A path through OKLab from a dark violet over blue, teal and green to a light yellow. Lightness rises all
// the way, so that order survives colour blindness and grey print; the path is cut into pieces of equal
// OKLab distance, so that equal steps of the value look like equal steps of colour.
//
//   node scripts/make_colour_table.mjs > src/mesh3d/colour_table.ts
const COUNT = 33;
const FINE = 20000;

function oklabToLinear([L, a, b]) {
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
}

const inGamut = (lab) => oklabToLinear(lab).every((v) => v >= 0 && v <= 1);
const encode = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);

/** Most chroma that sRGB can show at this lightness and hue. */
function mostChroma(L, hue) {
  let low = 0;
  let high = 0.4;
  for (let i = 0; i < 40; i++) {
    const middle = (low + high) / 2;
    if (inGamut([L, middle * Math.cos(hue), middle * Math.sin(hue)])) low = middle;
    else high = middle;
  }
  return low;
}

function pathAt(t) {
  const L = 0.37 + (0.93 - 0.37) * t;
  const hue = ((302 - (302 - 104) * t) * Math.PI) / 180;
  const chroma = Math.min(0.9 * mostChroma(L, hue), 0.16);
  return [L, chroma * Math.cos(hue), chroma * Math.sin(hue)];
}

const points = Array.from({ length: FINE + 1 }, (_, i) => pathAt(i / FINE));
const distance = (p, q) => Math.hypot(...p.map((v, k) => v - q[k]));

/** Walks the path in straight steps of one length; returns the indices reached. */
function walk(step) {
  const reached = [0];
  for (let i = 1; i <= FINE; i++) if (distance(points[i], points[reached.at(-1)]) >= step) reached.push(i);
  return reached;
}

/** The step that takes COUNT − 1 walks from end to end: too many steps, it is too short. */
let low = 0;
let high = 1;
for (let i = 0; i < 50; i++) {
  const middle = (low + high) / 2;
  if (walk(middle).length >= COUNT) low = middle;
  else high = middle;
}
const reached = walk(low).slice(0, COUNT);
reached[COUNT - 1] = FINE;

const hexes = reached.map((i) => {
  const rgb = oklabToLinear(points[i]).map((v) => Math.round(255 * encode(Math.min(1, Math.max(0, v)))));
  return "#" + rgb.map((v) => v.toString(16).padStart(2, "0")).join("");
});

console.log(
  "// colour_table.ts — colours of equal OKLab distance, low to high; made by scripts/make_colour_table.mjs.",
);
console.log("export const COLOUR_TABLE: readonly string[] = [");
for (let i = 0; i < hexes.length; i += 8)
  console.log(
    "  " +
      hexes
        .slice(i, i + 8)
        .map((hex) => `"${hex}",`)
        .join(" "),
  );
console.log("];");
