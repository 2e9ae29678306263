// driven_set.cpp — see driven_set.h.
#include "glisson/instruments/driven_set.h"

#include <array>

#include "dynamics/simulation_parts.h"

namespace glisson {
namespace {

/// A component of the force along the direction.
template <Vec3d ForceParts::*part>
double along(const Instrument& x) {
  return dot(static_cast<const DrivenSet&>(x).parts().*part, x.direction());
}

constexpr std::array<InstrumentColumn, 6> kPartColumns{{
    {"elastic_N", along<&ForceParts::elastic>},
    {"viscous_N", along<&ForceParts::viscous>},
    {"damping_N", along<&ForceParts::damping>},
    {"inertial_N", along<&ForceParts::inertial>},
    {"gravity_N", along<&ForceParts::gravity>},
    {"load_N", along<&ForceParts::load>},
}};

}  // namespace

DrivenSet::DrivenSet(DrivenSetOptions options, ToolPath path)
    : Instrument(options.name, std::make_shared<PathDriver>(Pose{}, path), options.direction),
      options_(std::move(options)), way_(std::move(path.displacement)) {}

void DrivenSet::between_steps(Simulation& simulation) {
  constraint_ = simulation.drive(options_.vertices, way_, options_.axes, options_.from);
  scheme_ = SimulationParts::weak_scheme(simulation);
}

std::span<const InstrumentColumn> DrivenSet::part_columns() { return kPartColumns; }

ForceParts DrivenSet::parts() const {
  const auto scheme = scheme_.lock();
  return scheme && scheme->state().steps > 0 ? scheme->force(constraint_) : ForceParts{};
}

Vec3d DrivenSet::sensor_force() const {
  const ForceParts f = parts();
  return -(f.total() - f.inertial - f.gravity);
}

double DrivenSet::force_depth() const {
  const auto scheme = scheme_.lock();
  return scheme ? dot(way_(scheme->force_time()), direction()) : 0.0;
}

Pose DrivenSet::pose() const {
  Pose pose;
  if (const auto scheme = scheme_.lock()) pose.position = way_(scheme->state().time);
  return pose;
}

}  // namespace glisson
