// region_probe.cpp — a region: means over its volume.
#include <map>
#include <stdexcept>

#include "dynamics/probe/probe_reader.h"

namespace glisson {
namespace {

class RegionReader : public ProbeReader {
 public:
  explicit RegionReader(std::vector<std::uint32_t> tets) : all_(std::move(tets)) {}

  std::vector<std::string> columns() const override {
    std::vector<std::string> names = material_columns();
    names.emplace_back("volume_m3");
    return names;
  }

  void follow(const Simulation& simulation) override {
    tets_.clear(), volumes_.clear();
    for (const std::uint32_t t : all_) {
      if (simulation.is_removed(t)) continue;
      tets_.push_back(t);
      volumes_.push_back(rest_of(simulation.mesh(), t).volume);
    }
  }

  std::vector<double> read(const Simulation& simulation, const TetFields& fields, std::size_t first) const override {
    const std::span<const Vec3d> displacement = simulation.displacement(), velocity = simulation.velocity();
    Vec3d u{}, v{};
    double whole = 0.0, present = 0.0;
    for (std::size_t k = 0; k < tets_.size(); ++k) {
      for (const std::uint32_t i : simulation.mesh().tets[tets_[k]]) {
        u += displacement[i] * (0.25 * volumes_[k]);
        v += velocity[i] * (0.25 * volumes_[k]);
      }
      whole += volumes_[k];
      present += volumes_[k] * fields.jacobian[first + k];
    }
    std::vector<double> row;
    add_vector(row, u * (1.0 / whole));
    add_vector(row, v * (1.0 / whole));
    const std::vector<double> state = mean_state(simulation, fields, first, tets_, volumes_);
    row.insert(row.end(), state.begin(), state.end());
    row.push_back(present);
    return row;
  }

  std::optional<Vec3d> place(const Simulation& simulation) const override {
    Vec3d x{};
    double whole = 0.0;
    for (std::size_t k = 0; k < tets_.size(); ++k) {
      for (const std::uint32_t i : simulation.mesh().tets[tets_[k]])
        x += present_position(simulation, i) * (0.25 * volumes_[k]);
      whole += volumes_[k];
    }
    return x * (1.0 / whole);
  }

 private:
  std::vector<std::uint32_t> all_;  ///< tets at the start
  std::vector<double> volumes_;     ///< at rest, of those that are there [m³]
};

/// `0, 2 ("vessel")`: the regions there are.
std::string regions_text(const TetMesh& mesh, const std::map<int, std::vector<std::uint32_t>>& tets) {
  std::string text;
  for (const auto& [number, list] : tets) {
    text += (text.empty() ? "" : ", ") + std::to_string(number);
    const auto name = mesh.region_names.find(number);
    if (name != mesh.region_names.end() && !name->second.empty()) text += " (\"" + name->second + "\")";
  }
  return text;
}

}  // namespace

std::unique_ptr<ProbeReader> make_reader(const Simulation& simulation, const ProbeRegion& region) {
  const TetMesh& mesh = simulation.mesh();
  std::map<int, std::vector<std::uint32_t>> tets;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) tets[mesh.region_of(t)].push_back(t);
  const auto is_it = [&](int number) {
    const auto name = mesh.region_names.find(number);
    return (name != mesh.region_names.end() && name->second == region.region) ||
           std::to_string(number) == region.region;
  };
  for (auto& [number, list] : tets) {
    if (!is_it(number)) continue;
    auto reader = std::make_unique<RegionReader>(std::move(list));
    reader->follow(simulation);
    return reader;
  }
  throw std::invalid_argument("the body has no region \"" + region.region + "\"; it has " + regions_text(mesh, tets) +
                              (tets.size() == 1 ? ", which is the whole body" : ""));
}

}  // namespace glisson
