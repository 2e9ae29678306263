// force_table.cpp — see force_table.h.
#include "report/force_table.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "glisson/instruments/driven_set.h"

namespace glisson {
namespace {

/// An energy by its column.
struct EnergyColumn {
  const char* name;
  double Energies::*value;
};
constexpr std::array<EnergyColumn, 5> kEnergyColumns{{
    {"energy_elastic_J", &Energies::elastic},
    {"energy_kinetic_J", &Energies::kinetic},
    {"energy_dissipated_J", &Energies::dissipated},
    {"work_tools_J", &Energies::work_tools},
    {"work_loads_J", &Energies::work_loads},
}};
constexpr std::array<EnergyColumn, 8> kFurtherEnergyColumns{{
    {"dissipated_viscous_J", &Energies::viscous},
    {"dissipated_maxwell_J", &Energies::maxwell},
    {"dissipated_damping_J", &Energies::damping},
    {"dissipated_friction_J", &Energies::friction},
    {"dissipated_contact_J", &Energies::contact},
    {"dissipated_fracture_J", &Energies::fracture},
    {"energy_instruments_J", &Energies::instruments},
    {"energy_numerical_J", &Energies::numerical},
}};

/// A set held by two entries (x by one, z by the other) has two sets of columns: the second is named <set>_2.
std::vector<std::string> support_columns(const Variant& variant) {
  std::vector<std::string> columns;
  std::map<std::string, int> seen;
  for (const FixedSpec& fixed : variant.fixed) {
    const int number = ++seen[fixed.set];
    const std::string name = "support_" + fixed.set + (number > 1 ? "_" + std::to_string(number) : "");
    for (const char* axis : {"_x_N", "_y_N", "_z_N"}) columns.push_back(name + axis);
  }
  return columns;
}

std::vector<std::string> timed_columns(std::span<const InstrumentColumn> own) {
  std::vector<std::string> names{"time_s"};
  for (const InstrumentColumn& x : own) names.emplace_back(x.name);
  return names;
}

}  // namespace

ForceTable::ForceTable(const Variant& variant, const BuiltVariant& built)
    : contained_(variant.container.has_value()), stores_(variant.output.stored_energy) {
  const auto& all = built.instruments;
  for (std::size_t i = 1; i < all.size(); ++i)
    further_.push_back({all[i]->name(), timed_columns(all[i]->columns()), i});
  columns_ = timed_columns(all.empty() ? Instrument::common_columns() : all.front()->columns());
  const std::size_t records = all.empty() ? 0 : all.front()->record_columns().size();
  const std::vector<std::string> record(columns_.end() - static_cast<std::ptrdiff_t>(records), columns_.end());
  columns_.resize(columns_.size() - records);
  own_ = columns_.size();
  if (all.empty()) {
    for (const InstrumentColumn& x : DrivenSet::part_columns()) columns_.emplace_back(x.name);
  }
  if (contained_ && (all.empty() || !variant.tools.empty()))
    columns_.insert(columns_.end(), {"friction_N", "cutting_N"});
  lead_ = columns_.size();
  if (contained_) columns_.insert(columns_.end(), {"bottom_z_N", "side_z_N", "side_radial_N"});
  const std::vector<std::string> supports = support_columns(variant);
  for (const EnergyColumn& column : kEnergyColumns) columns_.emplace_back(column.name);
  columns_.insert(columns_.end(), supports.begin(), supports.end());
  for (const EnergyColumn& column : kFurtherEnergyColumns) columns_.emplace_back(column.name);
  if (stores_) columns_.insert(columns_.end(), {"energy_stored_J", "energy_drift_J"});
  columns_.insert(columns_.end(), record.begin(), record.end());
}

std::vector<double> ForceTable::row_of(const Further& file, const Sample& sample) {
  std::vector<double> row{sample.time};
  const std::vector<double>& values = sample.instruments[file.instrument].values;
  row.insert(row.end(), values.begin(), values.end());
  return row;
}

std::vector<double> ForceTable::row(const Sample& sample) const {
  std::vector<double> row{sample.time};
  if (!sample.instruments.empty()) row = row_of({}, sample);
  const std::vector<double> record(row.begin() + static_cast<std::ptrdiff_t>(std::min(own_, row.size())), row.end());
  row.resize(std::min(own_, row.size()));
  row.resize(lead_, 0.0);
  if (contained_) {
    const ContainerLoads loads = sample.container.value_or(ContainerLoads{});
    row.insert(row.end(), {loads.bottom.z, loads.side.z, loads.side_radial});
  }
  for (const EnergyColumn& column : kEnergyColumns) row.push_back(sample.energies.*column.value);
  for (const ForceParts& support : sample.supports) {
    const Vec3d total = support.total();
    row.insert(row.end(), {total.x, total.y, total.z});
  }
  for (const EnergyColumn& column : kFurtherEnergyColumns) row.push_back(sample.energies.*column.value);
  if (stores_) {
    const double stored = sample.stored_energy.value_or(std::numeric_limits<double>::quiet_NaN());
    row.insert(row.end(), {stored, sample.energies.elastic - stored});
  }
  row.insert(row.end(), record.begin(), record.end());
  return row;
}

}  // namespace glisson
