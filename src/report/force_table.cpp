// force_table.cpp — see force_table.h.
#include "report/force_table.h"

#include <map>

#include "glisson/instruments/driven_set.h"

namespace glisson {
namespace {

const std::vector<std::string> kEnergyColumns{"energy_elastic_J", "energy_kinetic_J", "energy_dissipated_J",
                                              "work_tools_J", "work_loads_J"};

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

ForceTable::ForceTable(const Variant& variant, const BuiltVariant& built) : contained_(variant.container.has_value()) {
  const auto& all = built.instruments;
  for (std::size_t i = 1; i < all.size(); ++i)
    further_.push_back({all[i]->name(), timed_columns(all[i]->columns()), i});
  columns_ = timed_columns(all.empty() ? Instrument::common_columns() : all.front()->columns());
  if (all.empty()) {
    for (const InstrumentColumn& x : DrivenSet::part_columns()) columns_.emplace_back(x.name);
  }
  if (contained_ && (all.empty() || !variant.tools.empty()))
    columns_.insert(columns_.end(), {"friction_N", "cutting_N"});
  lead_ = columns_.size();
  if (contained_) columns_.insert(columns_.end(), {"bottom_z_N", "side_z_N", "side_radial_N"});
  const std::vector<std::string> supports = support_columns(variant);
  columns_.insert(columns_.end(), kEnergyColumns.begin(), kEnergyColumns.end());
  columns_.insert(columns_.end(), supports.begin(), supports.end());
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
  row.resize(lead_, 0.0);
  if (contained_) {
    const ContainerLoads loads = sample.container.value_or(ContainerLoads{});
    row.insert(row.end(), {loads.bottom.z, loads.side.z, loads.side_radial});
  }
  const Energies& e = sample.energies;
  row.insert(row.end(), {e.elastic, e.kinetic, e.dissipated, e.work_tools, e.work_loads});
  for (const ForceParts& support : sample.supports) {
    const Vec3d total = support.total();
    row.insert(row.end(), {total.x, total.y, total.z});
  }
  return row;
}

}  // namespace glisson
