// summary_fields.ts — what the keys of summary.json mean to a reader: name, unit, group, order.

export interface SummaryField {
  key: string;
  label: string;
  unit: string; // SI unit of the value; "" for counts and words
  group: string;
}

const GROUPS: readonly [string, readonly [string, string, string][]][] = [
  [
    "Result",
    [
      ["peak_force_N", "Peak force", "N"],
      ["end", "End of the run", ""],
      ["inverted_tets_most", "Most tets inverted in a step", ""],
      ["first_inversion_s", "First inversion at", "s"],
    ],
  ],
  [
    "Energies at the end",
    [
      ["energy_elastic_J", "Elastic, by work", "J"],
      ["energy_stored_J", "Elastic, stored W(u)", "J"],
      ["energy_drift_most_J", "Largest difference of the two", "J"],
      ["energy_kinetic_J", "Kinetic", "J"],
      ["energy_dissipated_J", "Dissipated in the tissue", "J"],
      ["dissipated_viscous_J", "Of it by viscosity", "J"],
      ["dissipated_maxwell_J", "Of it by Maxwell branches", "J"],
      ["dissipated_damping_J", "Of it by damping", "J"],
      ["dissipated_friction_J", "Friction", "J"],
      ["dissipated_contact_J", "Contact", "J"],
      ["dissipated_fracture_J", "Cutting and tearing", "J"],
      ["energy_instruments_J", "Stored in instruments", "J"],
      ["energy_numerical_J", "Numerical dissipation", "J"],
      ["work_tools_J", "Work of tools", "J"],
      ["work_loads_J", "Work of loads", "J"],
      ["energy_imbalance_J", "Imbalance", "J"],
      ["energy_paid_J", "Paid by tools, loads and changes", "J"],
      ["energy_gain_most", "Most in the body, over paid", ""],
      ["energy_gain_from_s", "More than was paid from", "s"],
    ],
  ],
  [
    "Mesh and time",
    [
      ["vertices", "Vertices", ""],
      ["tets", "Tetrahedra", ""],
      ["time_s", "Simulated time", "s"],
      ["steps", "Steps", ""],
      ["step_s", "Step h", "s"],
      ["stable_step_s", "Stable step h*", "s"],
      ["mass_added_kg", "Mass added by scaling", "kg"],
      ["rejected_poses", "Poses of tools rejected", ""],
    ],
  ],
  [
    "Cost",
    [
      ["wall_s", "Wall time", "s"],
      ["ns_per_tet_step", "Per tet and step", "ns"],
      ["threads", "Threads", ""],
      ["precision", "Precision", ""],
    ],
  ],
  [
    "Identity",
    [
      ["scene", "Scene", ""],
      ["variant", "Variant", ""],
      ["tissue", "Tissue", ""],
      ["state_hash", "State hash", ""],
      ["instruction_set", "Instruction set", ""],
      ["version", "Version", ""],
    ],
  ],
];

/** A sentence, which stands above the figures and not among the numbers. */
export const WARNING = "energy_warning";

const SUFFIXES: readonly [RegExp, string][] = [
  [/_per_s$/, "1/s"],
  [/_Pa$/, "Pa"],
  [/_N$/, "N"],
  [/_J$/, "J"],
  [/_kg$/, "kg"],
  [/_s$/, "s"],
  [/_m$/, "m"],
];

/** Field of a key the page does not know: name and unit read off the key itself. */
function unknownField(key: string): SummaryField {
  for (const [pattern, unit] of SUFFIXES) {
    if (pattern.test(key)) return { key, label: sentence(key.replace(pattern, "")), unit, group: "More" };
  }
  return { key, label: sentence(key), unit: "", group: "More" };
}

function sentence(key: string): string {
  const words = key.replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** Fields for the keys that occur, known ones in reading order, then the rest. */
export function summaryFields(keys: ReadonlySet<string>): SummaryField[] {
  const fields: SummaryField[] = [];
  for (const [group, entries] of GROUPS) {
    for (const [key, label, unit] of entries) fields.push({ key, label, unit, group });
  }
  const known = new Set(fields.map((field) => field.key));
  const rest = [...keys].filter((key) => !known.has(key) && key !== WARNING).map(unknownField);
  return [...fields.filter((field) => keys.has(field.key)), ...rest];
}
