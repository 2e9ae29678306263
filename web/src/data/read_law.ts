// read_law.ts — curves of a law from JSON; those without a point are left out.
import type { LawData } from "../report_data.ts";
import { type Raw, list, numberOrNaN, record, text } from "./raw.ts";

const QUANTITIES = ["modulus", "nominal stress", "shear stress"] as const;

export function readLaws(raw: unknown): LawData[] {
  return list(raw)
    .map((law) => readLaw(record(law)))
    .filter((law) => law !== null);
}

function readLaw(raw: Raw): LawData | null {
  const x = list(raw["x"]).map(numberOrNaN);
  const curves = list(raw["curves"])
    .map(record)
    .map((curve) => ({ label: text(curve["label"]), y: list(curve["y"]).map(numberOrNaN) }))
    .filter((curve) => curve.y.length > 0);
  if (x.length === 0 || curves.length === 0) return null;
  const quantity = QUANTITIES.find((known) => known === raw["quantity"]) ?? "modulus";
  return { measure: text(raw["measure"]) || "measure [-]", quantity, x, curves };
}
