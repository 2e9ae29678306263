// probes.cpp — several probes of a body, whose fields are computed in one go.
#include <limits>
#include <stdexcept>

#include "base/require_fields.h"
#include "dynamics/probe/probe_reader.h"
#include "glisson/simulation/probe.h"

namespace glisson {

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
  for (const auto& reader : readers_) {
    std::vector<double> values(reader->columns().size(), std::numeric_limits<double>::quiet_NaN());
    if (!reader->tets().empty()) values = reader->read(simulation, fields, first);
    row.insert(row.end(), values.begin(), values.end());
    first += reader->tets().size();
  }
  return row;
}

bool Probes::lost(std::size_t probe) const { return readers_[probe]->tets().empty(); }

}  // namespace glisson
