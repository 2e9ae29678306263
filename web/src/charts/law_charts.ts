// law_charts.ts — the tissue's law: modulus against the measure of deformation, or stress against stretch.
import { axisLabel, displayUnit, largestMagnitude } from "../format/units.ts";
import type { LawData, VariantData } from "../report_data.ts";
import { lineStyle } from "./line_style.ts";
import { type ChartModel, type Line, scaled } from "./model.ts";

type Lawful = VariantData & { law: LawData };

/** One chart for each measure in use; empty where every law is constant. */
export function lawCharts(variants: readonly VariantData[]): ChartModel[] {
  const lawful = variants.filter((variant): variant is Lawful => variant.law !== null);
  if (lawful.every((variant) => isConstant(variant.law))) return [];
  const measures = [...new Set(lawful.map((variant) => variant.law.measure))];
  return measures.map((measure) =>
    chartOf(
      measure,
      lawful.filter((variant) => variant.law.measure === measure),
      variants,
    ),
  );
}

function isConstant(law: LawData): boolean {
  return law.curves.every((curve) => curve.y.every((value) => value === curve.y[0]));
}

function chartOf(measure: string, lawful: readonly Lawful[], all: readonly VariantData[]): ChartModel {
  const curves = lawful.flatMap((variant) => variant.law.curves.map((curve) => curve.y));
  const unit = displayUnit("Pa", largestMagnitude(...curves));
  const labels = new Set(lawful.flatMap((variant) => variant.law.curves.map((curve) => curve.label)));
  const only = labels.size === 1 ? [...labels][0]! : null;
  const lines: Line[] = sameLaws(lawful).flatMap((same) =>
    same[0]!.law.curves.map((curve, index) => ({
      id: `${same[0]!.name} ${index}`,
      variant: same[0]!.name,
      label: same.map((variant) => variant.label).join(" / ") + (only === null ? `, ${curve.label}` : ""),
      style: lineStyle(all.indexOf(same[0]!) + index * all.length),
      x: scaled(same[0]!.law.x, 1),
      y: scaled(curve.y, unit.factor),
      times: null,
    })),
  );
  const stress = lawful[0]!.law.quantity === "nominal stress";
  return {
    title: stress ? "Stress against stretch" : "Law of stiffness",
    xLabel: axisLabel(measure),
    yLabel: stress ? `Nominal stress [${unit.unit}]` : `${only ? `Modulus ${only}` : "Modulus"} [${unit.unit}]`,
    lines,
    events: [],
    note: "",
  };
}

/** Variants in groups of equal laws, so that a law is drawn once. */
function sameLaws(lawful: readonly Lawful[]): Lawful[][] {
  const groups = new Map<string, Lawful[]>();
  for (const variant of lawful) {
    const key = JSON.stringify(variant.law);
    groups.set(key, [...(groups.get(key) ?? []), variant]);
  }
  return [...groups.values()];
}
