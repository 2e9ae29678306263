// driven_set.h — a set of vertices that follows a path: an instrument that is fixed to the tissue.
//
// It is a constraint of the simulation (Simulation::drive) with the name, the depth, the force and the columns of an
// instrument. Every integrator supports it.
#pragma once

#include "glisson/instruments/rigid_motion.h"
#include "glisson/instruments/tool_motion.h"

namespace glisson {

class Scheme;

struct DrivenSetOptions {
  std::string name = "tool";
  std::vector<std::uint32_t> vertices;  ///< one or more
  Vec3d direction{0, 0, -1};            ///< of the depth; any length
  Axes axes{};                          ///< the driven components; the others are free
  double from = 0.0;                    ///< start [s]: until then the vertices are free, and the force is 0
};

class DrivenSet final : public Instrument {
 public:
  /// @param path  of the vertices, 0 at the start
  DrivenSet(DrivenSetOptions options, ToolPath path);
  /// @param path  of the set as a rigid body, from where it is at the start
  /// @param rotation  the rotation that the path describes, if any: adds the columns angle_deg and torque_N_m
  DrivenSet(DrivenSetOptions options, RigidPath path, std::optional<RotationMotion> rotation = {});

  ConstraintId constraint() const { return constraint_; }
  /// The force on the tissue by component; 0 after the simulation was destroyed.
  ForceParts parts() const;
  /// Columns of its kind: elastic_N, viscous_N, damping_N, inertial_N, gravity_N, load_N, along the direction.
  static std::span<const InstrumentColumn> part_columns();

  /// Torque on the tissue at force_time() about a point [N m]; 0 after the simulation was destroyed.
  Vec3d torque(const Vec3d& about) const;
  /// Of a set that turns about an axis: the same along that axis [N m], and the angle at force_time() [rad].
  double axial_torque() const;
  double angle() const;

  /// Its position is the displacement; of a set that moves as a rigid body, that of the mean of its vertices.
  Pose pose() const override;
  double force_depth() const override;
  /// None: it has no solid; where its vertices are follows from the depth.
  std::span<const InstrumentColumn> record_columns() const override { return {}; }
  Vec3d force() const override { return parts().total(); }
  Vec3d sensor_force() const override;
  InstrumentForm form() const override { return {.kind = InstrumentForm::Kind::none}; }
  std::vector<Vec3d> centre_line() const override { return {}; }

  bool acts_in_steps() const override { return false; }
  void between_steps(Simulation& simulation) override;
  void attached(const BodyView&, double) override {}
  void body_changed(const BodyView&, std::span<const std::uint32_t>) override {}
  std::span<const std::uint32_t> reach(double, double) override { return {}; }

 private:
  std::span<const InstrumentColumn> own_columns() const override;
  Vec3d displacement_at(double time) const;

  DrivenSetOptions options_;
  Motion displacement_;
  PoseMotion rigid_;                        ///< replaces displacement_
  std::optional<RotationMotion> rotation_;  ///< the rotation of `rigid_`
  Vec3d middle_{};                          ///< mean of the vertices at rest [m]
  std::weak_ptr<const Scheme> scheme_;      ///< of the simulation it is attached to
  ConstraintId constraint_;
};

}  // namespace glisson
