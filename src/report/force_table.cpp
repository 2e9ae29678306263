// force_table.cpp — see force_table.h.
#include "report/force_table.h"

#include <map>

namespace glisson {
namespace {

const std::vector<std::string> kToolColumns{"time_s",    "depth_m",   "force_x_N", "force_y_N",  "force_z_N", "force_N",
                                            "elastic_N", "viscous_N", "damping_N", "inertial_N", "gravity_N", "load_N"};
const std::vector<std::string> kInstrumentColumns{"time_s",  "depth_m",  "force_x_N",  "force_y_N", "force_z_N",
                                                  "force_N", "normal_N", "friction_N", "cutting_N"};
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

}  // namespace

ForceTable::ForceTable(const Variant& variant) : contained_(variant.container.has_value()) {
  for (const ToolSpec& tool : variant.tools) tools_.push_back(unit(tool.motion.direction));
  for (const InstrumentSpec& x : variant.instruments) instruments_.push_back(unit(x.direction));
  const bool led_by_instrument = tools_.empty() && !instruments_.empty();
  for (std::size_t i = 1; i < tools_.size(); ++i) further_.push_back({variant.tools[i].name, false, i});
  for (std::size_t i = led_by_instrument ? 1 : 0; i < instruments_.size(); ++i) {
    further_.push_back({variant.instruments[i].name, true, i});
  }
  columns_ = led_by_instrument ? kInstrumentColumns : kToolColumns;
  if (contained_ && !led_by_instrument) columns_.insert(columns_.end(), {"friction_N", "cutting_N"});
  if (contained_) columns_.insert(columns_.end(), {"bottom_z_N", "side_z_N", "side_radial_N"});
  const std::vector<std::string> supports = support_columns(variant);
  columns_.insert(columns_.end(), kEnergyColumns.begin(), kEnergyColumns.end());
  columns_.insert(columns_.end(), supports.begin(), supports.end());
}

const std::vector<std::string>& ForceTable::columns_of(const Further& file) {
  return file.instrument ? kInstrumentColumns : kToolColumns;
}

std::vector<double> ForceTable::row_of(const Further& file, const Sample& sample) const {
  return file.instrument ? instrument_row(sample, file.index) : tool_row(sample, file.index);
}

std::vector<double> ForceTable::tool_row(const Sample& sample, std::size_t tool) const {
  if (tool >= sample.tools.size()) return {sample.time, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const Vec3d d = tools_[tool];
  const ForceParts& f = sample.tools[tool];
  const Vec3d total = f.total();
  return {sample.time,       sample.depths[tool], total.x,           total.y,
          total.z,           dot(total, d),       dot(f.elastic, d), dot(f.viscous, d),
          dot(f.damping, d), dot(f.inertial, d),  dot(f.gravity, d), dot(f.load, d)};
}

std::vector<double> ForceTable::instrument_row(const Sample& sample, std::size_t instrument) const {
  const Vec3d d = instruments_[instrument];
  const auto& [depth, f] = sample.instruments[instrument];
  const Vec3d total = f.total();
  return {sample.time,      depth, total.x, total.y, total.z, dot(total, d), dot(f.normal, d), dot(f.friction, d),
          dot(f.cutting, d)};
}

std::vector<double> ForceTable::row(const Sample& sample) const {
  const bool led_by_instrument = tools_.empty() && !instruments_.empty();
  std::vector<double> row = led_by_instrument ? instrument_row(sample, 0) : tool_row(sample, 0);
  if (contained_ && !led_by_instrument) row.insert(row.end(), {0.0, 0.0});
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
