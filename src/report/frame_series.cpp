// frame_series.cpp — see frame_series.h.
#include "report/frame_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <optional>
#include <span>

#include "glisson/io.h"
#include "material/strain.h"
#include "report/field_values.h"
#include "report/heat_recorder.h"
#include "report/output_file.h"
#include "report/tool_surface.h"

namespace glisson {
namespace {

Field vector_field(std::string name, std::span<const Vec3d> vectors) {
  Field field{.name = std::move(name), .components = 3, .values = {}};
  field.values.reserve(3 * vectors.size());
  for (const Vec3d& v : vectors) field.values.insert(field.values.end(), {v.x, v.y, v.z});
  return field;
}

/// @param stress  xx, yy, zz, xy, yz, zx of each tet
std::vector<Field> stress_fields(const std::vector<double>& stress) {
  Field tensor{.name = "stress_Pa", .components = 9, .values = {}};
  for (std::size_t i = 0; i + 6 <= stress.size(); i += 6) {
    const std::span<const double, 6> s(stress.data() + i, 6);
    tensor.values.insert(tensor.values.end(), {s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]});
  }
  return {std::move(tensor),
          {.name = "pressure_Pa", .components = 1, .values = pressure_of(stress)},
          {.name = "von_mises_Pa", .components = 1, .values = von_mises_of(stress)}};
}

/// Green's strain ½ (FᵀF − I) = sym H + ½ HᵀH of each tet, with H = Du Dm⁻¹ of its edges.
Field strain_field(const TetMesh& mesh, std::span<const Vec3d> u) {
  Field strain{.name = "strain", .components = 9, .values = {}};
  strain.values.reserve(9 * mesh.tets.size());
  for (const Tet& t : mesh.tets) {
    Mat3d rest, moved;  // edges as columns
    for (std::size_t a = 0; a < 3; ++a) {
      const Vec3d edge = mesh.vertices[t[a + 1]] - mesh.vertices[t[0]], way = u[t[a + 1]] - u[t[0]];
      for (std::size_t i = 0; i < 3; ++i) rest(i, a) = edge[i], moved(i, a) = way[i];
    }
    const Sym3<double> e = green_strain(product(moved, inverse(rest)));
    strain.values.insert(strain.values.end(), {e.xx, e.xy, e.zx, e.xy, e.yy, e.yz, e.zx, e.yz, e.zz});
  }
  return strain;
}

/// 1 at tets that were removed, 0 at others; nothing where all are there.
std::optional<Field> removed_field(const Simulation& simulation) {
  Field field{.name = "removed", .components = 1, .values = {}};
  bool any = false;
  for (std::uint32_t t = 0; t < simulation.mesh().tets.size(); ++t) {
    const bool removed = simulation.is_removed(t);
    any = any || removed;
    field.values.push_back(removed ? 1.0 : 0.0);
  }
  return any ? std::optional(std::move(field)) : std::nullopt;
}

/// The longest edge of the body's box at rest [m].
double extent_of(const TetMesh& mesh) {
  const auto [low, high] = box_of(mesh);
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

}  // namespace

/// The tools where they are at this frame; one without a surface has no file.
std::vector<FrameSeries::Tool> FrameSeries::tools_of(const Simulation& simulation) const {
  const double extent = instruments_.empty() ? 0.0 : extent_of(simulation.mesh());
  std::vector<Tool> tools;
  for (const auto& tool : instruments_) {
    SurfaceMesh surface = tool_surface(*tool, extent);
    if (!surface.triangles.empty()) tools.push_back({tool->name(), std::move(surface)});
  }
  return tools;
}

FrameSeries::FrameSeries(std::filesystem::path folder, bool linear) : folder_(std::move(folder)), linear_(linear) {
  make_folder(folder_ / "frames");
}

FrameSeries::~FrameSeries() {
  if (writing_.valid()) writing_.wait();
}

void FrameSeries::finish() {
  if (writing_.valid()) writing_.get();
}

void FrameSeries::add(const Simulation& simulation, const TetFields& fields) {
  Frame frame{.time = simulation.time(),
              .mesh = simulation.mesh(),
              .at_vertices = {vector_field("displacement_m", simulation.displacement()),
                              vector_field("velocity_m_s", simulation.velocity())},
              .at_tets = stress_fields(fields.stress),
              .tools = tools_of(simulation)};
  frame.mesh.regions.resize(frame.mesh.tets.size(), 0);
  ContactFields contact = simulation.contact_fields();
  if (!contact.pressure.empty()) {
    frame.at_vertices.push_back(
        {.name = "contact_pressure_Pa", .components = 1, .values = std::move(contact.pressure)});
    frame.at_vertices.push_back(vector_field("contact_traction_Pa", contact.traction));
  }
  if (heat_) {
    for (Field& field : heat_fields(heat_->heat().simulation, isotherms_))
      frame.at_vertices.push_back(std::move(field));
    Field ice{.name = "ice", .components = 1, .values = {}};
    for (std::uint32_t t = 0; t < frame.mesh.tets.size(); ++t) ice.values.push_back(heat_->ice()->share(t));
    frame.at_tets.push_back(std::move(ice));
  }
  frame.at_tets.push_back(strain_field(simulation.mesh(), simulation.displacement()));
  frame.at_tets.push_back({.name = "q", .components = 1, .values = fields.q});
  frame.at_tets.push_back({.name = "s", .components = 1, .values = fields.s});
  frame.at_tets.push_back({.name = "jacobian", .components = 1, .values = fields.jacobian});
  if (std::optional<Field> removed = removed_field(simulation)) frame.at_tets.push_back(std::move(*removed));
  if (linear_) frame.at_tets.push_back({.name = "linear", .components = 1, .values = fields.linear});
  for (Field& field : frame.at_tets) field.single = true;  // they follow from positions, which are kept in double
  finish();
  writing_ = std::async(std::launch::async, [this, frame = std::move(frame)] { write(frame); });
}

void FrameSeries::write(const Frame& frame) {
  const std::filesystem::path folder = "frames", file = folder / fmt::format("frame_{:04}.vtu", frames_.size());
  try {
    write_vtu(folder_ / file, frame.mesh, {}, frame.at_vertices, frame.at_tets);
    for (const Tool& tool : frame.tools) {
      const std::filesystem::path surface = folder / fmt::format("tool_{}_{:04}.vtp", tool.name, frames_.size());
      write_vtp(folder_ / surface, tool.surface.points, tool.surface.triangles);
      Files& files = tools_[tool.name];
      files.emplace_back(frame.time, surface);
      write_pvd(folder_ / fmt::format("tool_{}.pvd", tool.name), files);
    }
    frames_.emplace_back(frame.time, file);
    write_pvd(folder_ / "frames.pvd", frames_);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw OutputError(error.what());
  }
}

}  // namespace glisson
