// driven_set.cpp — see driven_set.h.
#include "glisson/instruments/driven_set.h"

#include <algorithm>
#include <array>
#include <numbers>

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

double angle_deg(const Instrument& x) { return static_cast<const DrivenSet&>(x).angle() * (180.0 / std::numbers::pi); }
double torque_about_axis(const Instrument& x) { return static_cast<const DrivenSet&>(x).axial_torque(); }

constexpr std::array<InstrumentColumn, 8> kTurningColumns{{kPartColumns[0],
                                                           kPartColumns[1],
                                                           kPartColumns[2],
                                                           kPartColumns[3],
                                                           kPartColumns[4],
                                                           kPartColumns[5],
                                                           {"angle_deg", angle_deg},
                                                           {"torque_N_m", torque_about_axis}}};

/// The mean place at rest of those vertices that belong to a tet.
Vec3d middle_of(const Simulation& simulation, std::span<const std::uint32_t> vertices) {
  const auto moves = [&](std::uint32_t v) { return simulation.masses()[v] > 0.0; };
  const double share = 1.0 / static_cast<double>(std::count_if(vertices.begin(), vertices.end(), moves));
  Vec3d middle{};
  for (const std::uint32_t v : vertices) {
    if (moves(v)) middle += simulation.mesh().vertices[v] * share;
  }
  return middle;
}

}  // namespace

DrivenSet::DrivenSet(DrivenSetOptions options, RigidPath path, std::optional<RotationMotion> rotation)
    : Instrument(options.name, std::make_shared<RigidDriver>(Pose{}, path), options.direction),
      options_(std::move(options)), rigid_(std::move(path.pose)), rotation_(std::move(rotation)) {}

DrivenSet::DrivenSet(DrivenSetOptions options, ToolPath path)
    : Instrument(options.name, std::make_shared<PathDriver>(Pose{}, path), options.direction),
      options_(std::move(options)), displacement_(std::move(path.displacement)) {}

void DrivenSet::between_steps(Simulation& simulation) {
  constraint_ = rigid_ ? simulation.drive_rigidly(options_.vertices, rigid_, options_.axes, options_.from)
                       : simulation.drive(options_.vertices, displacement_, options_.axes, options_.from);
  middle_ = middle_of(simulation, options_.vertices);
  scheme_ = SimulationParts::weak_scheme(simulation);
}

std::span<const InstrumentColumn> DrivenSet::part_columns() { return kPartColumns; }

std::span<const InstrumentColumn> DrivenSet::own_columns() const {
  return rotation_ ? std::span<const InstrumentColumn>(kTurningColumns) : part_columns();
}

Vec3d DrivenSet::torque(const Vec3d& about) const {
  const auto scheme = scheme_.lock();
  return scheme && scheme->state().steps > 0 ? scheme->torque(constraint_, about) : Vec3d{};
}

double DrivenSet::axial_torque() const {
  return rotation_ ? dot(torque(rotation_->center), unit(rotation_->axis)) : 0.0;
}

double DrivenSet::angle() const {
  const auto scheme = scheme_.lock();
  return scheme && rotation_ ? rotation_angle(*rotation_, scheme->force_time()) : 0.0;
}

/// Displacement at time t of the set, or of its middle.
Vec3d DrivenSet::displacement_at(double time) const {
  return rigid_ ? rigid_(time).to_space(middle_) - middle_ : displacement_(time);
}

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
  return scheme ? dot(displacement_at(scheme->force_time()), direction()) : 0.0;
}

Pose DrivenSet::pose() const {
  Pose pose;
  const auto scheme = scheme_.lock();
  if (!scheme) return pose;
  pose.position = displacement_at(scheme->state().time);
  if (rigid_) pose.axes = rigid_(scheme->state().time).axes;
  return pose;
}

}  // namespace glisson
