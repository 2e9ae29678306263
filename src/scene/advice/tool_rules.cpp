// tool_rules.cpp — meshes too coarse for what presses or pierces them, and instruments that never meet the body.
#include <algorithm>
#include <cmath>

#include "glisson/scene/body_places.h"
#include "scene/advice/edge_cells.h"
#include "scene/advice/needle_zone.h"
#include "scene/advice/pressed_faces.h"
#include "scene/advice/rules.h"

namespace glisson::advice {
namespace {

constexpr double kCoarseEdge = 0.08, kFineEdge = 0.04;  // cells across a sharp edge, of its size (docs/contact.md)

/// The keys that make a generated mesh so many times as fine.
std::string finer_mesh(const MeshSource& mesh, double factor) {
  const auto times = [&](int cells) { return whole(std::ceil(factor * cells - 1e-9)); };
  const auto shorter = [&](double edge) {
    return fill("mesh.edge_mm = {}, or that edge there alone by [[mesh.size]]", {digits(2, 1e3 * edge / factor)});
  };
  if (const auto* box = std::get_if<BoxOptions>(&mesh))
    return fill("mesh.cells = [{}, {}, {}]", {times(box->cells[0]), times(box->cells[1]), times(box->cells[2])});
  if (const auto* cylinder = std::get_if<CylinderOptions>(&mesh)) {
    return fill("mesh.radial_cells = {} and mesh.axial_cells = {}",
                {times(cylinder->radial_cells), times(cylinder->axial_cells)});
  }
  if (const auto* body = std::get_if<ImplicitBody>(&mesh)) return shorter(body->edge);
  if (const auto* liver = std::get_if<LiverOptions>(&mesh)) return shorter(liver->edge);
  if (const auto* body = std::get_if<ImageBody>(&mesh)) return shorter(body->edge);
  return fill("a mesh {} times as fine there", {digits(2, factor)});
}

/// That what presses these faces needs more or smaller ones.
Texts coarse_faces(const Variant& v, const std::string& name, const PressedFaces& faces) {
  if (!faces.coarse()) return {};
  const std::string few = faces.count < PressedFaces::kFew ? std::to_string(faces.count) + " " : "";
  const std::string large =
      faces.count > 0
          ? fill(" with edges of {} mm, {} of its {} mm",
                 {digits(3, 1e3 * faces.edge), digits(2, faces.edge / faces.size), digits(3, 1e3 * faces.size)})
          : "";
  return {fill(
      "\"{}\" acts on {}faces{}: its force may be far off; {} or more with edges\nof a third of that or less take {}",
      {name, few, large, std::to_string(PressedFaces::kFew), finer_mesh(v.mesh, faces.finer())})};
}

/// What the shorter half of a sharp edge's extent is called.
const char* half_extent(const InstrumentSpec& instrument) {
  const auto* contact = std::get_if<ContactOptions>(&instrument.what);
  return contact && std::holds_alternative<Block>(contact->shape) ? "half width" : "radius";
}

/// The keys that grade a cylinder so many times as finely; empty for other meshes.
std::string finer_cylinder(const MeshSource& mesh, double finer) {
  const auto* cylinder = std::get_if<CylinderOptions>(&mesh);
  if (!cylinder) return {};
  const double radial = std::ceil(finer * cylinder->radial_cells), axial = std::ceil(finer * cylinder->axial_cells);
  return fill("radial_cells = {} and axial_cells = {} here ({} million tets), ",
              {whole(radial), whole(axial), digits(2, 18e-6 * radial * radial * axial)});
}

}  // namespace

Texts coarse_pad(const Variant& v, const ToolSpec& tool, const TetMesh& mesh) {
  return coarse_faces(v, tool.name, faces_of_pad(mesh, tool.set));
}

Texts coarse(const Variant& v, const InstrumentSpec& instrument, const TetMesh& mesh) {
  const std::optional<PressedFaces> faces = faces_under(mesh, instrument);
  return faces ? coarse_faces(v, instrument.name, *faces) : Texts{};
}

Texts misses(const Variant& v, const InstrumentSpec& instrument, const TetMesh& mesh) {
  const std::optional<PathMeeting> meeting = meets_body(instrument, mesh, run_duration(v));
  if (!meeting || meeting->meets) return {};
  return {
      fill("\"{}\" never meets the body at rest: its tip passes {} mm from it; move `tip_m`, turn `direction`, move\n"
           "deeper, or give `aim` in place of `tip_m`, which finds the body",
           {instrument.name, digits(3, 1e3 * meeting->beside)})};
}

Texts edge(const Variant& v, const InstrumentSpec& instrument, const TetMesh& mesh) {
  const std::optional<EdgeCells> cells = cells_under_edge(mesh, instrument);
  if (!cells || cells->share() <= kCoarseEdge) return {};
  return {
      fill("\"{}\": cells of {} mm across its sharp edge are {} of its {} of {} mm, and its force may be wrong by\n"
           "about that share; cells of {} mm there, {} of it, keep it within 2 %: use a mesh graded at the edge,\n"
           "{}or round the edge by a cell: edge_radius_mm = {}",
           {instrument.name, digits(3, 1e3 * cells->across), digits(2, cells->share()), half_extent(instrument),
            digits(4, 1e3 * cells->size), digits(2, 1e3 * kFineEdge * cells->size), digits(6, kFineEdge),
            finer_cylinder(v.mesh, cells->share() / kFineEdge), digits(2, 1e3 * cells->across)})};
}

Texts zone(const Variant& v, const InstrumentSpec& instrument, const TetMesh& mesh) {
  const std::optional<ZoneEdges> edges = edges_in_zone(mesh, instrument);
  if (!edges || edges->share() <= ZoneEdges::kResolved) return {};
  return {
      fill("\"{}\": edges of {} mm around it are {} of its zone of {} mm: its force and depth belong to this mesh;\n"
           "half a zone resolves it: zone_mm = {}, or {}",
           {instrument.name, digits(3, 1e3 * edges->edge), digits(2, edges->share()), digits(3, 1e3 * edges->zone),
            digits(2, 2e3 * edges->edge), finer_mesh(v.mesh, 2.0 * edges->share())})};
}

}  // namespace glisson::advice
