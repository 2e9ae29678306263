// loads.h — forces from outside, per vertex: of sets and their faces (surface_load.h), each with its own course in time.
#pragma once

#include <span>
#include <vector>

#include "dynamics/state/loaded_faces.h"
#include "glisson/archive.h"
#include "glisson/simulation/surface_load.h"
#include "glisson/time_function.h"

namespace glisson {

/// ∂force/∂u of what follows a face: the same for its three corners [N/m].
struct FaceStiffness {
  std::array<std::uint32_t, 3> corners{};
  std::array<Mat3d, 3> slope;
};

/// All loads of a body.
class Loads {
 public:
  explicit Loads(std::size_t vertex_count) : force_(vertex_count) {}
  bool empty() const { return loads_.empty(); }
  std::size_t count() const { return loads_.size(); }

  /// @return vertices that it acts on, ascending
  /// @throws std::invalid_argument for an empty set, a vertex out of range, a load that is none or not finite, or one that needs
  ///         faces on a set that spans none
  std::vector<std::uint32_t> add(const Body& body, std::span<const std::uint32_t> vertices, const SurfaceLoad& load,
                                 TimeFunction<double> scale);
  void take_back_last(const Body& body);

  /// New vertices, numbered on from the last, share the loads of those they are copies of by equal parts.
  void add_copies(std::span<const std::uint32_t> origins);
  /// Faces have gone or moved at rest, or have other corners.
  void body_changed(const Body& body);

  /// What came with splits. @throws std::runtime_error where what is read loaded other vertices before
  void archive(Archive& ar, const Body& body);

  /// Forces at time t [N], one per vertex. @param u  displacements; only read where depends_on_state()
  std::span<const Vec3d> at(double time, const Body& body, std::span<const Vec3d> u);
  /// The first corner of a course after a time [s]; infinite: none.
  double next_corner(double after) const;
  bool depends_on_state() const { return follows_ || !spring_.empty(); }
  /// Stiffness of what follows at the last at(), without that of moments.
  std::span<const FaceStiffness> stiffness(double time, const Body& body, std::span<const Vec3d> u);
  bool follows() const { return follows_; }

  /// Springs and dashpots of a vertex along x, y, z [N/m, N s/m].
  Vec3d spring(std::size_t vertex) const { return spring_.empty() ? Vec3d{} : spring_[vertex]; }
  Vec3d dashpot(std::size_t vertex) const { return dashpot_.empty() ? Vec3d{} : dashpot_[vertex]; }
  std::span<const Vec3d> dashpots() const { return dashpot_; }  ///< empty: none
  /// ω² of springs and of what followed at the last at(), from above, on the body's masses [1/s²].
  double squared_frequency(const Body& body) const;

 private:
  struct Load {
    SurfaceLoad what;
    TimeFunction<double> scale;
    std::vector<std::uint32_t> vertices;
    std::vector<double> share;  ///< of what is given for the whole set, per vertex
    std::vector<LoadedFace> faces;
    std::vector<std::uint32_t> corners;  ///< vertices of the faces that are there, ascending
    std::vector<double> area;            ///< of the faces, per corner [m²]
    std::vector<Vec3d> dead;             ///< what does not follow besides `force`, per corner [N]
    bool follows() const { return what.follows && !faces.empty(); }
  };
  void measure(Load& load, const Body& body) const;
  void take_dead(Load& load, const Body& body) const;
  void prepare(Load& load, const Body& body);
  void size_rows(const Body& body);
  void follow(const Load& load, double scale, const Body& body, std::span<const Vec3d> u);

  std::vector<Load> loads_;
  std::vector<Vec3d> force_, spring_, dashpot_;
  std::vector<double> row_;  ///< per vertex, of what follows: a bound of its row of stiffness [N/m]
  std::vector<FaceStiffness> stiffness_;
  bool follows_ = false;
};

}  // namespace glisson
