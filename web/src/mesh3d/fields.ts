// fields.ts — what a body can be coloured by, in reports and in the live view: names, units, the value at rest.

export type ColourName =
  "intensity" | "shape" | "pressure" | "von_mises" | "contact_pressure" | "displacement" | "temperature" | "none";

export interface Colouring {
  name: ColourName;
  label: string;
  symbol: string;
  units: readonly { unit: string; perUnit: number; upTo: number }[]; // the first that the range lies within
  rest: number; // value of a body at rest: colours begin there
  least: number; // span that the range has at least: noise at rest stays one colour; displacement: of the body's size
}

const plain = [{ unit: "–", perUnit: 1, upTo: Infinity }];

const pascals = [
  { unit: "Pa", perUnit: 1, upTo: 2000 },
  { unit: "kPa", perUnit: 1e-3, upTo: Infinity },
];

export const COLOURINGS: readonly Colouring[] = [
  {
    name: "intensity",
    label: "Equivalent shear strain s",
    symbol: "Equivalent shear strain s",
    units: plain,
    rest: 0,
    least: 0.02,
  },
  { name: "shape", label: "Shape measure q", symbol: "Shape q", units: plain, rest: 1, least: 0.002 },
  { name: "pressure", label: "Pressure p", symbol: "Pressure p", units: pascals, rest: 0, least: 2 },
  { name: "von_mises", label: "Von Mises stress", symbol: "Von Mises", units: pascals, rest: 0, least: 2 },
  {
    name: "contact_pressure",
    label: "Contact pressure",
    symbol: "Contact",
    units: pascals,
    rest: 0,
    least: 2,
  },
  {
    name: "displacement",
    label: "Displacement |u|",
    symbol: "|u|",
    units: [{ unit: "mm", perUnit: 1e3, upTo: Infinity }],
    rest: 0,
    least: 2e-3,
  },
  {
    name: "temperature",
    label: "Temperature T",
    symbol: "Temperature",
    units: [{ unit: "°C", perUnit: 1, upTo: Infinity }],
    rest: 37,
    least: 1,
  },
];
/** Of the live view, which does not know heat. */
export const LIVE_COLOURINGS = COLOURINGS.filter(({ name }) => name !== "temperature");
/** No field: the body looks as tissue. */
export const AS_TISSUE: Colouring = {
  name: "none",
  label: "Tissue",
  symbol: "",
  units: plain,
  rest: 0,
  least: 1,
};

export const colouringOf = (name: string): Colouring => COLOURINGS.find((each) => each.name === name) ?? AS_TISSUE;

/** Unit for a range: that of the largest number in it. */
export function unitOf(colouring: Colouring, low: number, high: number): { unit: string; perUnit: number } {
  const most = Math.max(Math.abs(low), Math.abs(high));
  return colouring.units.find(({ upTo }) => most <= upTo) ?? colouring.units[colouring.units.length - 1]!;
}

/** "equivalent shear strain": its label within a sentence, without the symbol. */
export const spoken = ({ label }: Colouring): string =>
  label.replace(/ (s|q|p|T|\|u\|)$/, "").replace(/^[A-Z]/, (letter) => letter.toLowerCase());
