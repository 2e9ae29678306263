// section_heat.cpp — [heat]: tissues, boundaries, probes and powers over time, sensors, fronts and isotherms.
#include <array>
#include <set>

#include "base/nearest.h"
#include "base/text.h"
#include "glisson/scene/scene.h"
#include "scene/parse/presets.h"
#include "scene/parse/result_names.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

/// Complains about times that run backwards, and lists that are not as long as they are.
void check_table(const Node& table, const std::vector<double>& times, std::initializer_list<const char*> lists,
                 const Place& place) {
  const Node* given = table.find("times_s");
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] >= times[i - 1]) continue;
    place.complain(*given, "times_s",
                   "runs backwards: " + show(times[i]) + " s comes after " + show(times[i - 1]) +
                       " s; put the entries in the order of time (two of one time are a jump)");
    return;
  }
  bool any = false;
  for (const char* list : lists) {
    const Node* values = table.find(list);
    if (values == nullptr) continue;
    any = true;
    if (values->array()->size() == times.size() && !times.empty()) continue;
    place.complain(*values, list,
                   "has " + std::to_string(values->array()->size()) + " values for " + std::to_string(times.size()) +
                       " times; give as many as `times_s` has");
  }
  if (given && !any)
    place.complain(*given, "times_s",
                   "has no values; give a list of as many, such as `" + std::string(*lists.begin()) + "`");
  const Node* cycles = table.find("cycles");
  if (!cycles) return;
  if (times.empty())
    place.complain(*cycles, "cycles", "belongs to a table over time; give `times_s` and values, or leave it out");
  if (!times.empty() && !(times.back() > 0.0))
    place.complain(*cycles, "cycles", "repeats a table that ends at 0 s; let its last time be the length of a cycle");
}

/// Complains where what needs another key does not have it.
void check_pair(const Node& table, std::initializer_list<const char*> given, std::initializer_list<const char*> needed,
                const std::string& why, const Place& place) {
  const auto find = [&](std::initializer_list<const char*> keys) -> const char* {
    for (const char* key : keys) {
      if (table.find(key)) return key;
    }
    return nullptr;
  };
  const char* key = find(given);
  if (key == nullptr || find(needed) != nullptr) return;
  place.complain(*table.find(key), key, why);
}

void check_name(const Node& table, const std::string& value, const Place& place) {
  const std::string unfit = unfit_as_table(value);
  if (const Node* name = table.find("name"); name && !unfit.empty()) place.complain(*name, "name", unfit);
}

/// Without a preset every property has to be there: a figure that nobody chose looks like one that somebody measured.
void check_complete(const Node& table, const Place& place) {
  if (table.find("preset")) return;
  std::string missing;
  for (const char* key : {"density_kg_m3", "conductivity_W_m_K", "frozen_conductivity_W_m_K", "specific_heat_J_kg_K",
                          "frozen_specific_heat_J_kg_K", "latent_heat_J_kg", "freezing_begins_C", "freezing_ends_C"}) {
    if (!table.find(key)) missing += (missing.empty() ? "" : ", ") + std::string("`") + key + "`";
  }
  if (missing.empty()) return;
  std::vector<std::string> presets;
  for (const AllowedWord& word : thermal_preset_words()) presets.push_back("\"" + word.word + "\"");
  place.complain("the tissue lacks " + missing + "; give them, or start from `preset` = " + listed(presets));
}

template <class List>
void check_twice(const List& list, const char* key, const Node& table, const Place& place) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (seen.insert(folded(list[i].name)).second) continue;
    const Node& element = (*table.find(key)->array())[i];
    place.complain(element, std::string(key) + "." + std::to_string(i) + ".name",
                   "\"" + list[i].name + "\" is taken (upper and lower case count as the same); names must differ");
  }
}

void check_heat(HeatSpec& heat, const Node& table, const Place& place) {
  heat.origin = place.text();
  check_twice(heat.probes, "probe", table, place);
  check_twice(heat.sensors, "sensor", table, place);
  check_twice(heat.fronts, "front", table, place);
  check_twice(heat.isotherms, "isotherm", table, place);
  std::set<std::string> regions;
  for (std::size_t i = 0; i < heat.tissues.size(); ++i) {
    if (regions.insert(heat.tissues[i].region).second) continue;
    const std::string whose =
        heat.tissues[i].region.empty() ? "of the whole body" : "of \"" + heat.tissues[i].region + "\"";
    place.complain((*table.find("tissue")->array())[i], "tissue." + std::to_string(i),
                   "is a second tissue " + whose + "; name another `region`, or leave it out");
  }
}

}  // namespace

const SectionSpec& tissue_death_section() {
  static const SectionSpec section = described<TissueDeath>(
      "heat.tissue.death",
      "When tissue dies of cold or heat. Dead tissue has no blood and no metabolism any more, thawed or not.");
  return section;
}

const SectionSpec& heat_tissue_section() {
  static const SectionSpec section = [] {
    Section<HeatTissueSpec> s(
        "heat.tissue",
        "What a tissue is to heat (docs/heat.md). Without `preset` all properties of tissue and ice "
        "are needed; those of blood and metabolism are 0 unless given.");
    s.key("region", &HeatTissueSpec::region, "name or number of a region that is of this tissue")
        .otherwise("all that no other has");
    s.bare({.name = "preset",
            .help = "a preset to start from; other keys of the table override it",
            .type = ValueType::text,
            .words = thermal_preset_words(),
            .default_text = "none"});
    s.spec().starts = {"preset"};
    s.fields(&HeatTissueSpec::tissue);
    s.finish([](HeatTissueSpec& x, const Node& table, const Place& place) {
      x.origin = place.text();
      check_complete(table, place);
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& heat_boundary_section() {
  static const SectionSpec section = [] {
    Section<HeatBoundarySpec> s(
        "heat.boundary",
        "A part of the surface, or a region, that is held at a temperature; a surface that heat "
        "goes through. Where there is none, the surface is insulated.");
    s.fields();
    s.spec().exclusions = {{{{"set"}, {"region"}}, true},
                           {{{"temperature_C"}, {"temperatures_C"}, {"flux_W_m2"}, {"fluxes_W_m2"}}, true},
                           {{{"coefficient_W_m2_K"}, {"flux_W_m2"}, {"fluxes_W_m2"}, {"region"}}, false}};
    s.finish([](HeatBoundarySpec& x, const Node& table, const Place& place) {
      x.origin = place.text();
      check_table(table, x.times, {"temperatures_C", "fluxes_W_m2"}, place);
      if (const Node* region = table.find("region");
          region && !table.find("temperature_C") && !table.find("temperatures_C"))
        place.complain(*region, "region", "can only be held; give `temperature_C`, or a `[[heat.power]]` for its heat");
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& heat_probe_section() {
  static const SectionSpec section = [] {
    Section<HeatProbeSpec> s(
        "heat.probe",
        "A cryoprobe or another line that gives heat along its active length: a power, or its surface at "
        "a temperature, through a coefficient. The rest of its shaft is insulated.");
    s.fields();
    s.spec().exclusions = {{{{"power_W_m"}, {"powers_W_m"}, {"temperature_C"}, {"temperatures_C"}}, true},
                           {{{"coefficient_W_m_K"}, {"coefficients_W_m_K"}, {"power_W_m"}, {"powers_W_m"}}, false}};
    s.finish([](HeatProbeSpec& x, const Node& table, const Place& place) {
      x.origin = place.text();
      check_name(table, x.name, place);
      check_table(table, x.times, {"powers_W_m", "temperatures_C", "coefficients_W_m_K"}, place);
      check_pair(table, {"temperature_C", "temperatures_C"}, {"coefficient_W_m_K", "coefficients_W_m_K"},
                 "needs `coefficient_W_m_K` with it: the power is coefficient × (temperature − that of the tissue)",
                 place);
      check_pair(table, {"coefficient_W_m_K", "coefficients_W_m_K"}, {"temperature_C", "temperatures_C"},
                 "needs `temperature_C` with it", place);
      const double length = norm(x.to - x.from);
      if (!(length > 0.0)) place.complain(*table.find("to_m"), "to_m", "is the tip itself; give a point up the shaft");
      if (const Node* active = table.find("active_length_mm"); active && *x.active_length > length * (1.0 + 1e-9)) {
        place.complain(*active, "active_length_mm",
                       show(1e3 * *x.active_length) + " mm is longer than the probe, " +
                           detail::number_text(1e3 * length) + " mm from `from_m` to `to_m`; move `to_m` up the shaft");
      }
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& heat_power_section() {
  static const SectionSpec section = [] {
    Section<HeatPowerSpec> s("heat.power", "Heat per volume of a region or of the whole body.");
    s.fields();
    s.spec().exclusions = {{{{"power_W_m3"}, {"powers_W_m3"}}, true}};
    s.finish([](HeatPowerSpec& x, const Node& table, const Place& place) {
      x.origin = place.text();
      check_table(table, x.times, {"powers_W_m3"}, place);
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& heat_sensor_section() {
  static const SectionSpec section = [] {
    Section<HeatSensorSpec> s("heat.sensor",
                              "A temperature that is read into temperature.csv: at a point, at several along a line, "
                              "or the mean of a region.");
    s.fields();
    s.spec().exclusions = {{{{"point_m"}, {"from_m", "to_m", "count"}, {"region"}}, true}};
    s.finish([](HeatSensorSpec& x, const Node& table, const Place& place) {
      x.origin = place.text();
      check_name(table, x.name, place);
      check_pair(table, {"from_m", "count"}, {"to_m"}, "needs `to_m` with it, the other end of the line", place);
      check_pair(table, {"to_m"}, {"from_m"}, "needs `from_m` with it, the other end of the line", place);
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& heat_front_section() {
  static const SectionSpec section = [] {
    Section<HeatFrontSpec> s("heat.front",
                             "How much of a line is frozen, or below an isotherm: the position of a front that grows "
                             "from one of its ends, the width of an ice ball.");
    s.fields();
    s.finish([](HeatFrontSpec& x, const Node& table, const Place& place) {
      x.origin = place.text();
      check_name(table, x.name, place);
      const Node* above = table.find("above_C");
      if (above && !x.temperature)
        place.complain(*above, "above_C", "needs `temperature_C` with it, the warmer isotherm");
      else if (above && *x.above >= *x.temperature)
        place.complain(*above, "above_C", "is not below `temperature_C`; nothing lies between them");
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& heat_plane_section() {
  static const SectionSpec section = described<HeatPlaneSpec>("plane_m", "A section through the whole body at rest.");
  return section;
}

const SectionSpec& heat_isotherm_section() {
  static const SectionSpec section = [] {
    Section<HeatIsothermSpec> s("heat.isotherm",
                                "What is colder than an isotherm: its volume and its extents along x, y and z.");
    s.fields();
    s.finish([](HeatIsothermSpec& x, const Node& table, const Place& place) {
      x.origin = place.text();
      check_name(table, x.name, place);
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& heat_ice_section() {
  static const SectionSpec section = [] {
    Section<HeatIceSpec> s("heat.ice",
                           "Mechanics beside heat: the scene has both, tissue freezes in the shape that it has, and is "
                           "stiffer from then on "
                           "(docs/heat.md). An empty table is enough.");
    s.fields(&HeatIceSpec::options);
    s.key("every_s", &HeatIceSpec::every,
          "time after which heat knows of the body's shape and mechanics of its ice; long "
          "steps end there")
        .in("s")
        .within(above(0));
    return s.spec();
  }();
  return section;
}

const SectionSpec& heat_section() {
  static const SectionSpec section = [] {
    Section<HeatSpec> s(
        "heat",
        "The temperature of the body: conduction, blood, freezing and thawing (docs/heat.md). A scene with it "
        "is one of heat alone, without mechanics, unless it has `[heat.ice]`. It writes temperature.csv and heat.csv.");
    s.key("duration_s", &HeatSpec::duration, "simulated time").in("s").within(above(0)).must();
    s.key("sample_every_s", &HeatSpec::sample_every, "time between lines of the tables; steps end there")
        .in("s")
        .within(above(0));
    s.fields(&HeatSpec::options);
    s.tables("tissue", heat_tissue_section(), &HeatSpec::tissues, "tissues, by region").must();
    s.tables("boundary", heat_boundary_section(), &HeatSpec::boundaries, "what the surface, or a region, is held at");
    s.tables("probe", heat_probe_section(), &HeatSpec::probes, "lines that give heat");
    s.tables("power", heat_power_section(), &HeatSpec::powers, "heat of regions");
    s.tables("sensor", heat_sensor_section(), &HeatSpec::sensors, "temperatures that are read");
    s.tables("front", heat_front_section(), &HeatSpec::fronts, "fronts along lines");
    s.tables("isotherm", heat_isotherm_section(), &HeatSpec::isotherms, "volumes below isotherms");
    s.table(
        "ice", heat_ice_section(), [](HeatSpec & h) -> auto& { return h.ice.emplace(); },
        "mechanics beside heat, with ice that is stiffer");
    s.finish(check_heat);
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
