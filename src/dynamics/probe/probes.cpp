// probes.cpp — several probes of a body, whose fields are computed in one go.
#include <array>
#include <limits>
#include <stdexcept>

#include "base/require_fields.h"
#include "dynamics/probe/probe_reader.h"
#include "glisson/simulation/probe.h"

namespace glisson {
namespace {

constexpr std::array<const char*, 3> kTipColumns{"tip_distance_m", "tip_along_m", "tip_across_m"};

/// From a tip to a place: the distance, its part along the tip's direction and that across it [m].
std::array<double, 3> distances(const Vec3d& place, const ProbeTip& tip) {
  const Vec3d way = place - tip.position;
  const double along = dot(way, tip.direction);
  return {norm(way), along, norm(way - tip.direction * along)};
}

std::array<double, 3> lost_distances() {
  std::array<double, 3> values;
  values.fill(std::numeric_limits<double>::quiet_NaN());
  return values;
}

}  // namespace

Probes::Probes() = default;
Probes::~Probes() = default;
Probes::Probes(Probes&&) noexcept = default;
Probes& Probes::operator=(Probes&&) noexcept = default;

Probes::Probes(const Simulation& simulation, std::vector<ProbeOptions> options)
    : options_(std::move(options)), changes_(changes_of(simulation)) {
  for (const ProbeOptions& o : options_) {
    const std::string label = "probe \"" + o.name + "\"";
    std::visit([&](const auto& where) { detail::require_fields(label, where); }, o.where);
    try {
      readers_.push_back(std::visit([&](const auto& where) { return make_reader(simulation, where); }, o.where));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(label + ": " + error.what());
    }
    readers_.back()->scheme = scheme_of(simulation);
    for (const std::string& column : readers_.back()->columns()) columns_.push_back(o.name + "_" + column);
    if (!o.tip) continue;
    if (!readers_.back()->place(simulation))
      throw std::invalid_argument(label +
                                  ": a plane is no place that a tip can be at a distance from; give a point, a "
                                  "set or a region");
    for (const char* column : kTipColumns) columns_.push_back(o.name + "_" + column);
  }
}

std::vector<double> Probes::read(const Simulation& simulation) {
  if (!readers_.empty() && readers_.front()->scheme.lock() != scheme_of(simulation).lock()) {
    throw std::invalid_argument("probes: \"" + options_.front().name +
                                "\" was made for another simulation; make Probes for this one");
  }
  if (changes_ != changes_of(simulation)) {
    for (const auto& reader : readers_) reader->follow(simulation);
    changes_ = changes_of(simulation);
  }
  std::vector<std::uint32_t> tets;
  for (const auto& reader : readers_) tets.insert(tets.end(), reader->tets().begin(), reader->tets().end());
  const TetFields fields = fields_of(simulation, tets);
  std::vector<double> row;
  std::size_t first = 0;
  for (std::size_t i = 0; i < readers_.size(); ++i) {
    const ProbeReader& reader = *readers_[i];
    const bool lost = reader.tets().empty();
    std::vector<double> values(reader.columns().size(), std::numeric_limits<double>::quiet_NaN());
    if (!lost) values = reader.read(simulation, fields, first);
    row.insert(row.end(), values.begin(), values.end());
    if (options_[i].tip) {
      const auto of_tip = lost ? lost_distances() : distances(*reader.place(simulation), options_[i].tip());
      row.insert(row.end(), of_tip.begin(), of_tip.end());
    }
    first += reader.tets().size();
  }
  return row;
}

bool Probes::lost(std::size_t probe) const { return readers_[probe]->tets().empty(); }

}  // namespace glisson
