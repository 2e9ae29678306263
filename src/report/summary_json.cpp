// summary_json.cpp — see summary_json.h.
#include "report/summary_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "glisson/version.h"

namespace glisson {

std::string trouble_text(const RunSummary& s) {
  if (!s.trouble.empty()) return fmt::format("stopped at {:.6g} s: {}", s.time_s, s.trouble);
  if (s.end != RunSummary::End::stopped_inverted) return {};
  return fmt::format(
      "stopped at {:.6g} s: {} tets are inverted (J <= 0); press less deep, refine the mesh under "
      "the tool, or continue with on_inversion = \"go_on\"",
      s.time_s, s.inverted_tets_most);
}

std::string energy_warning(const RunSummary& s) {
  if (!s.energy_gain || !s.energy_gain->any()) return {};
  const EnergyGain& gain = *s.energy_gain;
  return fmt::format(
      "from {:.4g} s on {}: up to {:.3g} times what tools, loads and changes paid, {:.3g} J by {:.4g} s. What is "
      "computed from there on cannot be believed. A stiffness law in secant form gives work over closed cycles, where "
      "law_form = \"energy\" does not; else take a smaller step_s, or integrator = \"implicit\"",
      gain.began, meaning_of(gain.of), gain.most, gain.paid, s.time_s);
}

std::string meeting_warning(const RunSummary& s) {
  if (s.never_met.empty()) return {};
  return fmt::format(
      "\"{}\" never met the body: no force and no event in {:.4g} s. `glisson check` says by how much; `aim` in place "
      "of "
      "`tip_m` finds the body",
      fmt::join(s.never_met, "\", \""), s.time_s);
}

std::uint64_t rejected_poses(std::span<const std::shared_ptr<Instrument>> instruments) {
  std::uint64_t all = 0;
  for (const std::shared_ptr<Instrument>& instrument : instruments) all += instrument->rejected();
  return all;
}

nlohmann::ordered_json advice_json(const Advice& advice) {
  std::string text = advice.text;
  std::replace(text.begin(), text.end(), '\n', ' ');
  return {{"rule", advice.rule},
          {"kind", word_of(advice.kind)},
          {"about", word_of(advice.about)},
          {"name", advice.name},
          {"text", std::move(text)}};
}

nlohmann::ordered_json summary_json(const RunSummary& s, const Variant& variant, const std::string& scene, int threads,
                                    std::uint64_t rejected, std::span<const Advice> advice) {
  nlohmann::ordered_json json;
  json["scene"] = scene;
  json["variant"] = variant.name;
  json["tissue"] = variant.tissue.name;
  json["end"] = word_of(s.end);
  json["vertices"] = s.vertices;
  json["tets"] = s.tets;
  json["steps"] = s.steps;
  json["time_s"] = s.time_s;
  json["step_s"] = s.step_s;
  json["stable_step_s"] = s.stable_step_s;
  if (s.unloaded) {
    json["unloaded"] = {{"bodies", s.unloaded->iterations},
                        {"off_m", s.unloaded->off},
                        {"largest_shift_m", s.unloaded->largest_shift},
                        {"volume_m3", s.unloaded->volume},
                        {"unloaded_volume_m3", s.unloaded->unloaded_volume}};
  }
  if (s.mass_added_kg > 0.0) json["mass_added_kg"] = s.mass_added_kg;
  json["wall_s"] = s.wall_s;
  json["ns_per_tet_step"] = s.ns_per_tet_step;
  json["peak_force_N"] = s.peak_force_N;
  json["energy_elastic_J"] = s.energies.elastic;
  if (s.stored_energy_J) {
    json["energy_stored_J"] = *s.stored_energy_J;
    json["energy_drift_most_J"] = s.energy_drift_most_J;
  }
  json["energy_kinetic_J"] = s.energies.kinetic;
  json["energy_dissipated_J"] = s.energies.dissipated;
  json["dissipated_viscous_J"] = s.energies.viscous;
  json["dissipated_maxwell_J"] = s.energies.maxwell;
  json["dissipated_damping_J"] = s.energies.damping;
  json["dissipated_friction_J"] = s.energies.friction;
  json["dissipated_contact_J"] = s.energies.contact;
  json["dissipated_fracture_J"] = s.energies.fracture;
  json["energy_instruments_J"] = s.energies.instruments;
  json["energy_numerical_J"] = s.energies.numerical;
  json["work_tools_J"] = s.energies.work_tools;
  json["work_loads_J"] = s.energies.work_loads;
  json["energy_imbalance_J"] = s.energies.imbalance();
  if (s.energy_gain) {
    json["energy_paid_J"] = s.energy_gain->paid;
    json["energy_gain_most"] = s.energy_gain->most;
    json["energy_gain_from_s"] = nullptr;
    if (s.energy_gain->any()) {
      json["energy_gain_from_s"] = s.energy_gain->began;
      json["energy_warning"] = energy_warning(s);
    }
  }
  if (s.linear_share_mean) json["linear_share_mean"] = *s.linear_share_mean;
  if (rejected > 0) json["rejected_poses"] = rejected;
  json["inverted_tets_most"] = s.inverted_tets_most;
  if (s.inverted_tets_most > 0)
    json["first_inversion_s"] = s.first_inversion_s;
  else
    json["first_inversion_s"] = nullptr;
  if (s.unmet_contact_steps > 0) {
    json["unmet_contact_steps"] = s.unmet_contact_steps;
    json["first_unmet_contact_s"] = s.first_unmet_contact_s;
  }
  if (!s.never_met.empty()) json["never_met"] = s.never_met;
  for (const Advice& one : advice) json["advice"].push_back(advice_json(one));
  json["integrator"] = word_of(variant.simulation.integrator);
  json["precision"] = word_of(variant.simulation.precision);
  json["threads"] = threads;
  json["state_hash"] = fmt::format("{:016x}", s.state_hash);
  json["instruction_set"] = s.instruction_set;
  json["version"] = GLISSON_VERSION;
  return json;
}

}  // namespace glisson
