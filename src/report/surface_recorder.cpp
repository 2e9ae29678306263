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
constexpr double kDrawnRadius = 0.75e-3;          // of a probe that gives heat on its axis [m]
constexpr double kBase64BytesAtRest = 4.0 / 3.0;  // of a body that has a temperature alone

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

std::vector<float> floats_of(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

SurfaceState surface_state(const Simulation& simulation, const TetFields& fields) {
  const TetMesh& mesh = simulation.mesh();
  const auto is_removed = [&simulation](std::uint32_t tet) { return simulation.is_removed(tet); };
  const auto means = [&](const std::vector<double>& of_tets) { return vertex_means(mesh, of_tets, is_removed); };
  SurfaceState state{
      .time = simulation.time(), .mesh = mesh, .displacement = simulation.displacement(), .is_removed = is_removed};
  state.intensity = means(fields.s);
  state.fields["pressure"] = means(pressure_of(fields.stress));
  state.fields["von_mises"] = means(von_mises_of(fields.stress));
  if (ContactFields contact = simulation.contact_fields(); !contact.pressure.empty())
    state.fields["contact_pressure"] = std::move(contact.pressure);
  return state;
}

SurfaceRecorder::SurfaceRecorder(const Variant& variant, const SurfaceState& first, std::size_t max_bytes)
    : variant_(variant), skin_(first.mesh) {
  const TetMesh& mesh = first.mesh;
  const double a_vertex =
      (first.displacement.empty() ? kBase64BytesAtRest : kBase64BytesPerVertex) * variant.output.frames;
  whole_ = a_vertex * static_cast<double>(mesh.vertices.size()) +
               kBase64BytesPerTet * static_cast<double>(mesh.tets.size()) <=
           static_cast<double>(max_bytes);
  find_surface(first);
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
void SurfaceRecorder::find_surface(const SurfaceState& state) {
  const TetMesh& mesh = state.mesh;
  const std::vector<std::uint8_t> marks = constraint_marks(variant_, mesh);
  BodySurface surface = skin_.surface(mesh, state.is_removed);
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
    return find_inside(state);
  }
  for (Region& region : regions_) {
    std::vector<std::uint32_t> triangles = region_triangles(surface, region.name, mesh);
    regions_changed_ = regions_changed_ || triangles != region.triangles;
    region.triangles = std::move(triangles);
  }
  find_inside(state);
}

/// All tets that are there, with the vertices that no surface has.
void SurfaceRecorder::find_inside(const SurfaceState& state) {
  if (!whole_) return;
  const TetMesh& mesh = state.mesh;
  tets_.clear();
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    if (state.is_removed && state.is_removed(t)) continue;
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

void SurfaceRecorder::find_new_surface(const SurfaceState& state) {
  std::size_t removed = 0;
  const auto tets = static_cast<std::uint32_t>(state.mesh.tets.size());
  for (std::uint32_t t = 0; state.is_removed && t < tets; ++t) removed += state.is_removed(t) ? 1 : 0;
  const bool changed = removed != removed_ || state.mesh.vertices.size() != mesh_vertices_;
  if (!changed && torn_triangles(capsules_).size() == torn_) return;
  removed_ = removed;
  changed_ = changed_ || changed;
  kinds_changed_ = true;
  find_surface(state);
}

/// Of the recorder's vertices in their order.
std::vector<double> SurfaceRecorder::own(const std::vector<double>& at_vertices) const {
  std::vector<double> values;
  values.reserve(vertices_.size());
  for (const std::uint32_t v : vertices_) values.push_back(at_vertices[v]);
  return values;
}

/// Displacements from where a vertex was first: a cut moves vertices at rest. Of a body at rest there are none.
void SurfaceRecorder::add_motion(nlohmann::json& json, const SurfaceState& state) const {
  std::vector<Vec3d> displacement;
  double reach = 0.0;
  for (std::size_t i = 0; i < vertices_.size() && !state.displacement.empty(); ++i) {
    const std::uint32_t v = vertices_[i];
    displacement.push_back(state.mesh.vertices[v] + state.displacement[v] - rest_[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      const double u = std::abs(displacement[i][k]);
      if (std::isfinite(u)) reach = std::max(reach, u);
    }
  }
  std::vector<std::int16_t> moved;
  for (const Vec3d& u : displacement)
    for (std::size_t k = 0; k < 3; ++k) moved.push_back(fraction16(u[k], reach));
  json["displacement_scale_m"] = reach;
  json["displacement"] = base64_of(std::span<const std::int16_t>(moved));
}

void SurfaceRecorder::add_intensity(nlohmann::json& json, const SurfaceState& state) {
  const std::vector<double> intensity = state.intensity.empty() ? std::vector<double>() : own(state.intensity);
  double strongest = 0.0;
  for (const double s : intensity)
    if (std::isfinite(s)) strongest = std::max(strongest, s);
  intensity_max_ = std::max(intensity_max_, strongest);
  std::vector<std::uint8_t> colour;
  for (const double s : intensity) colour.push_back(fraction8(s, strongest));
  json["intensity_max"] = strongest;
  json["intensity"] = base64_of(std::span<const std::uint8_t>(colour));
}

nlohmann::json SurfaceRecorder::frame(const SurfaceState& state) {
  nlohmann::json json{{"time_s", state.time}, {"fields", nlohmann::json::object()}};
  add_motion(json, state);
  add_intensity(json, state);
  for (const auto& [name, values] : state.fields) json["fields"][name] = field_json(own(values));
  json["instruments"] = instrument_places_json(instruments_);
  for (const nlohmann::json& place : probes_) json["instruments"].push_back(place);
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

void SurfaceRecorder::set_heat(const HeatSpec& heat) {
  head_["isotherms"] = nlohmann::json::array();
  for (const HeatIsothermSpec& x : heat.isotherms)
    head_["isotherms"].push_back({{"name", x.name}, {"temperature_C", x.temperature}});
  for (std::size_t k = 0; heat.isotherms.empty() && k < heat.options.isotherms.size(); ++k)
    head_["isotherms"].push_back({{"name", ""}, {"temperature_C", heat.options.isotherms[k]}});
  const auto add = [&](const std::string& name, const Vec3d& tip, const Vec3d& shaft, double radius) {
    nlohmann::json points = floats_of(shaft);
    for (const float x : floats_of(tip)) points.push_back(x);
    head_["instruments"].push_back({{"name", name},
                                    {"kind", "needle"},
                                    {"radius_m", radius > 0.0 ? radius : kDrawnRadius},
                                    {"length_m", norm(shaft - tip)}});
    probes_.push_back({{"points", std::move(points)}, {"axes", {1, 0, 0, 0, 1, 0, 0, 0, 1}}});
  };
  for (const HeatProbeSpec& x : heat.probes) add(x.name, x.from, x.to, x.radius);
  for (const HeatRadioSpec& x : heat.radios)
    if (x.from && x.to) add(x.name, *x.from, *x.to, x.radius);
}

void SurfaceRecorder::add(const SurfaceState& state) {
  find_new_surface(state);
  last_ = frame(state);
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
