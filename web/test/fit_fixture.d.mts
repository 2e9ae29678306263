// fit_fixture.d.mts — types of fit_fixture.mjs, which node's own test runner reads as well.
import type { FitData, ReportData } from "../src/report_data.ts";

export function cylinderForce(displacement: number, law: { mu: number; alpha: number }): number;
export function fitFixture(): FitData;
export function bareFit(): FitData;
export function largeFit(): FitData;
export function fitReport(...fits: FitData[]): ReportData;
