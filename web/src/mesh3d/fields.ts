// fields.ts — what a body can be coloured by, in reports and in the live view: names, units, the value at rest.

export type ColourName =
  "intensity" | "shape" | "pressure" | "von_mises" | "contact_pressure" | "displacement" | "none";

export interface Colouring {
  name: ColourName;
  label: string;
  symbol: string;
  field: number; // that the program of a live view is asked for; 0: none, the page has what it needs
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
    field: 1,
    units: plain,
    rest: 0,
    least: 0.02,
  },
  { name: "shape", label: "Shape measure q", symbol: "Shape q", field: 2, units: plain, rest: 1, least: 0.002 },
  { name: "pressure", label: "Pressure p", symbol: "Pressure p", field: 3, units: pascals, rest: 0, least: 2 },
  { name: "von_mises", label: "Von Mises stress", symbol: "Von Mises", field: 4, units: pascals, rest: 0, least: 2 },
  {
    name: "contact_pressure",
    label: "Contact pressure",
    symbol: "Contact",
    field: 5,
    units: pascals,
    rest: 0,
    least: 2,
  },
  {
    name: "displacement",
    label: "Displacement |u|",
    symbol: "|u|",
    field: 0,
    units: [{ unit: "mm", perUnit: 1e3, upTo: Infinity }],
    rest: 0,
    least: 2e-3,
  },
];
/** No field: the body looks as tissue. */
export const AS_TISSUE: Colouring = {
  name: "none",
  label: "Tissue",
  symbol: "",
  field: 0,
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
  label.replace(/ (s|q|p|\|u\|)$/, "").replace(/^[A-Z]/, (letter) => letter.toLowerCase());
