// pace.ts — how fast the simulated clock goes, as people say it.
import { formatSignificant } from "../format/number.ts";

/** "0.30 × real time". */
export const paceText = (factor: number): string => `${formatSignificant(factor, 2)} × real time`;
