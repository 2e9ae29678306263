// law_charts.ts — the tissue's law: modulus against the measure of deformation, stress against stretch and shear.
import { axisLabel, displayUnit, largestMagnitude } from "../format/units.ts";
import type { LawData } from "../report_data.ts";
import { lineStyle } from "./line_style.ts";
import { type ChartModel, type Line, scaled } from "./model.ts";

/** Whose law is drawn: a variant of a scene, or a fit. */
export interface Lawful {
  name: string;
  label: string;
  law_curves: LawData[];
}

interface Named {
  owner: Lawful;
  law: LawData;
}

/** Parts of the largest change that a line's curvature must reach to be worth a chart. */
const STRAIGHT = 1e-6;

/** One chart for each measure in use; none where every law of it is a straight line. */
export function lawCharts(owners: readonly Lawful[]): ChartModel[] {
  const all = owners.flatMap((owner) => owner.law_curves.map((law): Named => ({ owner, law })));
  const measures = [...new Set(all.map(({ law }) => law.measure))];
  return measures
    .map((measure) => all.filter(({ law }) => law.measure === measure))
    .filter((named) => !named.every(({ law }) => isStraight(law)))
    .map((named) => chartOf(named, owners));
}

function isStraight(law: LawData): boolean {
  return law.curves.every(({ y }) => {
    const bends = y.map((value, at) => Math.abs((y[at + 1] ?? NaN) - 2 * value + (y[at - 1] ?? NaN)));
    return (
      Math.max(0, ...bends.filter(Number.isFinite)) <= STRAIGHT * Math.max(...y.filter(Number.isFinite).map(Math.abs))
    );
  });
}

const TITLES: Record<LawData["quantity"], string> = {
  modulus: "Law of stiffness",
  "nominal stress": "Stress against stretch",
  "shear stress": "Stress against shear",
};

function chartOf(named: readonly Named[], owners: readonly Lawful[]): ChartModel {
  const { quantity, measure } = named[0]!.law;
  const curves = named.flatMap(({ law }) => law.curves.map((curve) => curve.y));
  const unit = displayUnit("Pa", largestMagnitude(...curves));
  const labels = new Set(named.flatMap(({ law }) => law.curves.map((curve) => curve.label)));
  const only = labels.size === 1 ? [...labels][0]! : null;
  const lines: Line[] = sameLaws(named).flatMap((same) => {
    const { owner, law } = same[0]!;
    const who = same.map((one) => one.owner.label).join(" / ");
    return law.curves.map((curve, index) => ({
      id: `${owner.name} ${index}`,
      variant: owner.name,
      label: only === null && curve.label ? `${who}, ${curve.label}` : who,
      style: lineStyle(owners.indexOf(owner) + index * owners.length),
      x: scaled(law.x, 1),
      y: scaled(curve.y, unit.factor),
      times: null,
    }));
  });
  const modulus = only ? `Modulus ${only}` : "Modulus";
  const name = quantity === "modulus" ? modulus : quantity === "shear stress" ? "Shear stress" : "Nominal stress";
  return {
    title: TITLES[quantity],
    xLabel: axisLabel(measure),
    yLabel: `${name} [${unit.unit}]`,
    lines,
    events: [],
    note: "",
  };
}

/** Owners in groups of equal laws, so that a law is drawn once. */
function sameLaws(named: readonly Named[]): Named[][] {
  const groups = new Map<string, Named[]>();
  for (const one of named) {
    const key = JSON.stringify(one.law);
    groups.set(key, [...(groups.get(key) ?? []), one]);
  }
  return [...groups.values()];
}
