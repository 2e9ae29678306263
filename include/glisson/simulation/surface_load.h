// surface_load.h — what acts from outside on the faces or vertices of a set.
//
//   force, traction, pressure, moment   times a course in time         dead, or following the surface
//   springs, dashpots to the ground     at all times
//
// The faces of a set are those of the body's surface, when the load is added, with all corners in the set. Loads on faces are
// distributed by the shape functions (consistent): a uniform traction on flat faces strains a bar uniformly on any mesh.
#pragma once

#include "glisson/field.h"
#include "glisson/math.h"

namespace glisson {

/// Everything that loads a set; the given parts act together. A vertex that is named twice counts once, one in no tet not at all.
///
/// Dead (`follows` false): per area at rest, of a direction fixed in space. Following: per present area; pressure stays normal to
/// the surface, and a traction turns with its face: its part along the normal stays along it, that along the face stays along
/// the same line of the material.
struct SurfaceLoad {
  /// Sum over the set, divided equally among the vertices [N]. Never follows. A uniform load on faces is a traction.
  Vec3d force{};
  Vec3d traction{};       ///< force per area [Pa]
  double pressure = 0.0;  ///< against the outward normal: positive pushes inwards [Pa]
  /// Of the traction α × (x − c) on the faces, c their centroid and α such that its moment is this [N m]. It has no resulting force
  /// and leaves the surface free to deform; a rigid patch is Simulation::drive_rigidly. Following: c and α from present positions.
  Vec3d moment{};
  bool follows = false;
  /// Stiffness to the ground along x, y, z, of the whole set, divided equally among the vertices [N/m]: −k u on a vertex
  /// at its displacement u.
  Vec3d spring{};
  Vec3d spring_per_area{};  ///< the same per area at rest [N/m³ = Pa/m]
  Vec3d dashpot{};  ///< the same against velocity: −c v [N s/m]; in quasi_static with StaticBranches::follow alone
  Vec3d dashpot_per_area{};  ///< the same per area at rest [Pa s/m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("force", &SurfaceLoad::force, "N", "total force, divided equally among the vertices"),
        field("traction", &SurfaceLoad::traction, "Pa", "force per area on the faces of the set"),
        field("pressure", &SurfaceLoad::pressure, "Pa", "pressure on the faces of the set; positive pushes inwards"),
        field("moment", &SurfaceLoad::moment, "N m",
              "moment on the faces of the set, as a traction that grows linearly from their centroid"),
        field("follows", &SurfaceLoad::follows,
              "traction, pressure and moment act on the present surface and turn with it; otherwise on that at rest"),
        field("spring", &SurfaceLoad::spring, "N/m", at_least(0),
              "springs to the ground along x, y and z: sum over the set, divided equally among the vertices"),
        field("spring_per_area", &SurfaceLoad::spring_per_area, "Pa/m", at_least(0),
              "the same per area of the faces: an elastic foundation")
            .keyed("spring_Pa_m"),
        field("dashpot", &SurfaceLoad::dashpot, "N s/m", at_least(0),
              "dashpots to the ground along x, y and z, likewise"),
        field("dashpot_per_area", &SurfaceLoad::dashpot_per_area, "Pa s/m", at_least(0),
              "the same per area of the faces")
            .keyed("dashpot_Pa_s_m"));
  }
  bool has_traction() const { return traction != Vec3d{} || pressure != 0.0 || moment != Vec3d{}; }
  /// Whether a part of it acts on faces.
  bool needs_faces() const { return has_traction() || spring_per_area != Vec3d{} || dashpot_per_area != Vec3d{}; }
  Fault check() const;
};

}  // namespace glisson
