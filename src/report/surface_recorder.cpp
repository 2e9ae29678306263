// surface_recorder.cpp — see surface_recorder.h.
#include "report/surface_recorder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/base64.h"
#include "report/field_values.h"
#include "report/fractions.h"
#include "report/instrument_json.h"

namespace glisson {
namespace {

constexpr std::uint32_t kInside = std::numeric_limits<std::uint32_t>::max();
// Of a vertex in a frame: displacement, s, pressure, von Mises' stress, and where something touches the contact pressure.
constexpr double kBase64BytesPerVertex = 10.0 * 4.0 / 3.0, kBase64BytesPerTet = 16.0 * 4.0 / 3.0;

/// 2 where a tool drives the vertex, 1 where a support holds it, 0 where it is free; per mesh vertex.
std::vector<std::uint8_t> constraint_marks(const Variant& variant, const TetMesh& mesh) {
  std::vector<std::uint8_t> marks(mesh.vertices.size(), 0);
  const auto mark = [&](const std::string& set, std::uint8_t value) {
    const auto found = mesh.vertex_sets.find(set);
    if (found == mesh.vertex_sets.end()) return;
    for (const std::uint32_t v : found->second) marks[v] = value;
  };
  for (const FixedSpec& fixed : variant.fixed) mark(fixed.set, 1);
  for (const ToolSpec& tool : variant.tools) mark(tool.set, 2);
  return marks;
}

}  // namespace

SurfaceRecorder::SurfaceRecorder(const Variant& variant, const Simulation& simulation, std::size_t max_bytes)
    : variant_(variant), skin_(simulation.mesh()) {
  const TetMesh& mesh = simulation.mesh();
  const double a_vertex = kBase64BytesPerVertex * variant.output.frames;
  whole_ = a_vertex * static_cast<double>(mesh.vertices.size()) +
               kBase64BytesPerTet * static_cast<double>(mesh.tets.size()) <=
           static_cast<double>(max_bytes);
  find_surface(simulation);
  head_["triangles"] = base64_of(std::span<const std::uint32_t>(triangles_));
  if (whole_) head_["tets"] = base64_of(std::span<const std::uint32_t>(tets_));
  head_["instruments"] = nlohmann::json::array();
  const double wanted = a_vertex * static_cast<double>(vertices_.size());
  stride_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(wanted / static_cast<double>(max_bytes))));
}

/// A vertex's own number; a new vertex gets the next one.
std::uint32_t SurfaceRecorder::number_of(std::uint32_t vertex, const TetMesh& mesh) {
  if (number_[vertex] == kInside) {
    number_[vertex] = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back(vertex);
    rest_.push_back(mesh.vertices[vertex]);
    fixed_.push_back(0);
  }
  return number_[vertex];
}

/// The boundary as it is now. Vertices that were at it before keep their number.
void SurfaceRecorder::find_surface(const Simulation& simulation) {
  const TetMesh& mesh = simulation.mesh();
  const std::vector<std::uint8_t> marks = constraint_marks(variant_, mesh);
  BodySurface surface = skin_.surface(mesh, [&](std::uint32_t tet) { return simulation.is_removed(tet); });
  const std::vector<Triangle> torn = torn_triangles(capsules_);
  mark_torn(surface, torn);
  torn_ = torn.size();
  const bool first = vertices_.empty();
  number_.resize(mesh.vertices.size(), kInside);
  mesh_vertices_ = mesh.vertices.size();
  triangles_.clear();
  for (const Triangle& triangle : surface.outer) {
    for (const std::uint32_t v : triangle) {
      triangles_.push_back(number_of(v, mesh));
      fixed_[triangles_.back()] = marks[v];
    }
  }
  kinds_.clear();
  for (const SurfaceKind kind : surface.kinds) kinds_.push_back(static_cast<std::uint8_t>(kind));
  if (first) {
    find_regions(surface, mesh);
    return find_inside(simulation);
  }
  for (Region& region : regions_) {
    std::vector<std::uint32_t> triangles = region_triangles(surface, region.name, mesh);
    regions_changed_ = regions_changed_ || triangles != region.triangles;
    region.triangles = std::move(triangles);
  }
  find_inside(simulation);
}

/// All tets that are there, with the vertices that no surface has.
void SurfaceRecorder::find_inside(const Simulation& simulation) {
  if (!whole_) return;
  const TetMesh& mesh = simulation.mesh();
  tets_.clear();
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    if (simulation.is_removed(t)) continue;
    for (const std::uint32_t v : mesh.tets[t]) tets_.push_back(number_of(v, mesh));
  }
}

/// Surfaces of inner regions as they are at first: their vertices come after those of the boundary.
void SurfaceRecorder::find_regions(const BodySurface& surface, const TetMesh& mesh) {
  head_["tissue"] = surface.tissue;
  head_["regions"] = nlohmann::json::array();
  for (const RegionSurface& region : surface.regions) {
    regions_.push_back({region.name, region_triangles(surface, region.name, mesh)});
    head_["regions"].push_back(
        {{"name", region.name}, {"triangles", base64_of(std::span<const std::uint32_t>(regions_.back().triangles))}});
  }
}

/// Of the region of this name, in surface vertices; none where nothing is left of it.
std::vector<std::uint32_t> SurfaceRecorder::region_triangles(const BodySurface& surface, const std::string& name,
                                                             const TetMesh& mesh) {
  std::vector<std::uint32_t> triangles;
  for (const RegionSurface& region : surface.regions) {
    if (region.name != name) continue;
    for (const Triangle& triangle : region.triangles) {
      for (const std::uint32_t v : triangle) triangles.push_back(number_of(v, mesh));
    }
  }
  return triangles;
}

void SurfaceRecorder::find_new_surface(const Simulation& simulation) {
  std::size_t removed = 0;
  const auto tets = static_cast<std::uint32_t>(simulation.mesh().tets.size());
  for (std::uint32_t t = 0; t < tets; ++t) removed += simulation.is_removed(t) ? 1 : 0;
  const bool changed = removed != removed_ || simulation.mesh().vertices.size() != mesh_vertices_;
  if (!changed && torn_triangles(capsules_).size() == torn_) return;
  removed_ = removed;
  changed_ = changed_ || changed;
  kinds_changed_ = true;
  find_surface(simulation);
}

std::vector<double> SurfaceRecorder::at_vertices(const Simulation& simulation, std::span<const double> of_tets) const {
  const std::vector<double> mean =
      vertex_means(simulation.mesh(), of_tets, [&](std::uint32_t tet) { return simulation.is_removed(tet); });
  std::vector<double> own;
  own.reserve(vertices_.size());
  for (const std::uint32_t v : vertices_) own.push_back(mean[v]);
  return own;
}

/// Fields besides s and the displacement, by their names on the page.
nlohmann::json SurfaceRecorder::other_fields(const Simulation& simulation, const TetFields& fields) const {
  nlohmann::json list{{"pressure", field_json(at_vertices(simulation, pressure_of(fields.stress)))},
                      {"von_mises", field_json(at_vertices(simulation, von_mises_of(fields.stress)))}};
  const ContactFields contact = simulation.contact_fields();
  if (contact.pressure.empty()) return list;
  std::vector<double> own;
  for (const std::uint32_t v : vertices_) own.push_back(contact.pressure[v]);
  list["contact_pressure"] = field_json(own);
  return list;
}

nlohmann::json SurfaceRecorder::frame(const Simulation& simulation, const TetFields& fields) {
  const TetMesh& mesh = simulation.mesh();
  std::vector<Vec3d> displacement;  // from where the vertex was first: a cut moves vertices at rest
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const std::uint32_t v = vertices_[i];
    displacement.push_back(mesh.vertices[v] + simulation.displacement()[v] - rest_[i]);
  }
  const std::vector<double> intensity = at_vertices(simulation, fields.s);
  double reach = 0.0, strongest = 0.0;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double u = std::abs(displacement[i][k]);
      if (std::isfinite(u)) reach = std::max(reach, u);
    }
    if (std::isfinite(intensity[i])) strongest = std::max(strongest, intensity[i]);
  }
  intensity_max_ = std::max(intensity_max_, strongest);
  std::vector<std::int16_t> moved;
  std::vector<std::uint8_t> colour;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) moved.push_back(fraction16(displacement[i][k], reach));
    colour.push_back(fraction8(intensity[i], strongest));
  }
  nlohmann::json json{{"time_s", simulation.time()},
                      {"displacement_scale_m", reach},
                      {"displacement", base64_of(std::span<const std::int16_t>(moved))},
                      {"intensity_max", strongest},
                      {"intensity", base64_of(std::span<const std::uint8_t>(colour))},
                      {"fields", other_fields(simulation, fields)},
                      {"instruments", instrument_places_json(instruments_)}};
  if (changed_) json["triangles"] = base64_of(std::span<const std::uint32_t>(triangles_));
  if (changed_ && whole_) json["tets"] = base64_of(std::span<const std::uint32_t>(tets_));
  if (kinds_changed_) json["kinds"] = base64_of(std::span<const std::uint8_t>(kinds_));
  for (std::size_t i = 0; regions_changed_ && i < regions_.size(); ++i)
    json["regions"].push_back(base64_of(std::span<const std::uint32_t>(regions_[i].triangles)));
  return json;
}

void SurfaceRecorder::set_instruments(std::vector<std::shared_ptr<Instrument>> instruments) {
  instruments_ = std::move(instruments);
  head_["instruments"] = instrument_forms_json(instruments_);
}

void SurfaceRecorder::set_container(const Container& container, const TetMesh& mesh) {
  head_["container"] = vessel_json(container.options(), mesh.vertices);
}

void SurfaceRecorder::add(const Simulation& simulation, const TetFields& fields) {
  find_new_surface(simulation);
  last_ = frame(simulation, fields);
  if (seen_++ % stride_ != 0) return;
  frames_.push_back(std::move(*last_));
  last_.reset();
  changed_ = kinds_changed_ = regions_changed_ = false;
}

nlohmann::json SurfaceRecorder::json() const {
  std::vector<float> rest;
  for (const Vec3d& x : rest_) {
    for (std::size_t k = 0; k < 3; ++k) rest.push_back(static_cast<float>(x[k]));
  }
  nlohmann::json surface = head_;
  surface["vertices"] = vertices_.size();
  surface["rest"] = base64_of(std::span<const float>(rest));
  surface["fixed"] = base64_of(std::span<const std::uint8_t>(fixed_));
  surface["frames"] = frames_;
  if (last_) surface["frames"].push_back(*last_);
  return surface;
}

}  // namespace glisson
