// vertex_records.h — the state of the vertices in double, a record each (layout.h), with the mass and damping that the
// coefficients of its step are made of:
//
//   v₊ = v₋ + c f − d v₋ + …     c = h/(m + γh)     d = γh/(m + γh)        [Schwartz2002, eq. 4]
//
// A vertex without mass, or at rest, has c = 0 and d = 1: it does not move.
#pragma once

#include "engine/kernels/kernels.h"
#include "engine/layout/submesh.h"
#include "glisson/math.h"

namespace glisson::engine {

inline Vec3d vector_of(const float* f) {
  return {static_cast<double>(f[0]), static_cast<double>(f[1]), static_cast<double>(f[2])};
}
inline Vec3d vector_of(const double* f) { return {f[0], f[1], f[2]}; }
inline void put(const Vec3d& v, double* out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

class VertexRecords {
 public:
  /// Undeformed, without mass or damping; none is at rest.
  void reset(std::size_t count);
  /// Appends a record with the state of another one, without mass or damping.
  void add_copy(std::size_t origin);
  std::size_t size() const { return masses_.size(); }

  double* at(std::size_t record) { return state_.data() + record * kStateDoubles; }
  const double* at(std::size_t record) const { return state_.data() + record * kStateDoubles; }
  Vec3d displacement(std::size_t record) const { return vector_of(at(record)); }
  /// Of the records with these numbers.
  std::vector<Vec3d> displacements(std::span<const std::uint32_t> records) const;
  Vec3d velocity(std::size_t record) const { return vector_of(at(record) + 4); }
  void set_state(std::size_t record, const Vec3d& displacement, const Vec3d& velocity) {
    put(displacement, at(record));
    set_velocity(record, velocity);
  }
  void set_velocity(std::size_t record, const Vec3d& velocity) { put(velocity, at(record) + 4); }

  /// @param mass  m [kg] @param heavy  the part of it that has weight [kg]
  void set_mass(std::size_t record, double mass, double heavy);
  /// @param damping  γ [kg/s]
  void set_damping(std::size_t record, double damping);
  /// Brings records to rest where they are, and lets all others go.
  void rest(std::span<const std::uint32_t> records);
  /// Makes the coefficients those of a step of h [s]. Cost: a pass over the records where h has changed.
  void set_step(double h);
  /// The kick of the records from one on.
  Kick kick_from(const Kick& kick, std::size_t record) const {
    return {kick.step, kick.gravity, weighs_.empty() ? nullptr : weighs_.data() + record, masses_.data() + record,
            damping_.data() + record};
  }

 private:
  void set_coefficients(std::size_t record);

  LaneVector<double> state_;              ///< u, c, v, d of each
  std::vector<double> masses_, damping_;  ///< [kg], [kg/s]
  std::vector<double> weighs_;            ///< share of the mass that has weight; empty: all of all
  std::vector<char> rests_;
  double step_ = 0.0;  ///< for which the coefficients hold [s]
};

}  // namespace glisson::engine
