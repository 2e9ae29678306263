// surface_recorder.h — the moving body with its fields, small enough to travel inside the report page.
//
// Vertices of the boundary come first, then those of the surfaces of inner regions, then all others with the tets, which show a
// field on a face that the reader cuts; where a page has no room for the whole body, its surfaces alone. A body that is cut, or
// loses tets, gets new ones of all with its next frame. A frame holds displacements as 16-bit fractions of the largest one and
// fields as 8-bit fractions of their range: some 10 bytes a vertex, an error of 3e-5 of the largest displacement, well below a
// pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glisson/scene/heat_spec.h"
#include "glisson/scene/scene.h"
#include "report/body_surface.h"

namespace glisson {

/// A body at a time: of the mechanics, or of heat alone. What a span or a mesh is of has to outlive it.
struct SurfaceState {
  double time = 0.0;  ///< [s]
  const TetMesh& mesh;
  std::span<const Vec3d> displacement{};                ///< of every vertex [m]; empty: the body rests
  std::function<bool(std::uint32_t)> is_removed{};      ///< whether a tet is gone; none: all are there
  std::vector<double> intensity{};                      ///< equivalent shear strain at every vertex; empty: none
  std::map<std::string, std::vector<double>> fields{};  ///< others at every vertex, by their names on the page
};
/// @param fields  of the same state
SurfaceState surface_state(const Simulation& simulation, const TetFields& fields);

/// Records frames of the surface as SurfaceData of web/src/report_data.ts.
class SurfaceRecorder {
 public:
  /// @param max_bytes  what the frames may take in the page; beyond it every 2nd, 3rd, … frame is kept
  SurfaceRecorder(const Variant& variant, const SurfaceState& first, std::size_t max_bytes);

  /// Instruments that frames show, too.
  void set_instruments(std::vector<std::shared_ptr<Instrument>> instruments);
  /// The vessel about the body.
  void set_container(const Container& container, const TetMesh& mesh);
  /// Capsules whose tears frames show.
  void set_capsules(std::vector<std::shared_ptr<Capsule>> capsules) { capsules_ = std::move(capsules); }
  /// Probes of heat, at rest, drawn as needles, and the isotherms that are drawn within the body.
  void set_heat(const HeatSpec& heat);
  /// Takes a frame.
  void add(const SurfaceState& state);
  /// Largest equivalent shear strain s of the surface so far [-].
  double intensity_max() const { return intensity_max_; }
  /// The SurfaceData, the last frame always with it.
  nlohmann::json json() const;

 private:
  void find_surface(const SurfaceState& state);
  void find_regions(const BodySurface& surface, const TetMesh& mesh);
  std::vector<std::uint32_t> region_triangles(const BodySurface& surface, const std::string& name, const TetMesh& mesh);
  std::uint32_t number_of(std::uint32_t vertex, const TetMesh& mesh);
  void find_new_surface(const SurfaceState& state);
  void find_inside(const SurfaceState& state);
  nlohmann::json frame(const SurfaceState& state);
  void add_motion(nlohmann::json& json, const SurfaceState& state) const;
  void add_intensity(nlohmann::json& json, const SurfaceState& state);
  std::vector<double> own(const std::vector<double>& at_vertices) const;

  Variant variant_;
  std::vector<std::uint32_t> vertices_;   // mesh vertex of each surface vertex
  std::vector<std::uint32_t> number_;     // surface vertex of each mesh vertex, or kInside
  std::vector<std::uint32_t> triangles_;  // in surface vertices
  std::vector<std::uint32_t> tets_;       // likewise; empty where the page has no room for the whole body
  std::vector<Vec3d> rest_;               // of each surface vertex, when it was first at the surface [m]
  std::vector<std::uint8_t> fixed_;       // constraint mark of each surface vertex
  std::vector<std::uint8_t> kinds_;       // SurfaceKind of each triangle
  struct Region {
    std::string name;
    std::vector<std::uint32_t> triangles;  // in surface vertices
  };
  std::vector<Region> regions_;  // inner ones, as they were named at first
  SkinFaces skin_;
  std::size_t mesh_vertices_ = 0, removed_ = 0, torn_ = 0;
  bool whole_ = false;          // with what is inside
  bool changed_ = false;        // the surface, since the last frame that was kept
  bool kinds_changed_ = false;  // what its triangles are
  bool regions_changed_ = false;
  std::vector<std::shared_ptr<Capsule>> capsules_;
  std::vector<std::shared_ptr<Instrument>> instruments_;
  nlohmann::json head_;
  nlohmann::json probes_ = nlohmann::json::array();  // places of those of heat
  nlohmann::json frames_ = nlohmann::json::array();
  std::optional<nlohmann::json> last_;  // the newest frame, where the stride passed over it
  std::size_t stride_ = 1, seen_ = 0;
  double intensity_max_ = 0.0;
};

}  // namespace glisson
