#include "glisson/scene/convergence_variant.h"

#include <algorithm>
#include <cmath>

#include "glisson/mesh_refinement.h"

namespace glisson {
namespace {

constexpr double kImplicitStep = 0.01;  // the largest automatic one of `implicit` [s]

bool is_by_number(const std::pair<const std::string, Selection>& named) {
  const auto& where = named.second.where;
  return std::holds_alternative<Selection::Nearest>(where) || std::holds_alternative<Selection::Ids>(where) ||
         std::holds_alternative<Selection::Facing>(where);
}

}  // namespace

RefinedVariant on_split_mesh(const Variant& variant, TetMesh mesh) {
  RefinedVariant result{variant, {}, true};
  result.variant.mesh = MeshFile{};
  std::erase_if(result.variant.sets, is_by_number);
  for (RegionSpec& region : result.variant.regions) region.where = std::monostate{};
  result.load = [mesh = std::make_shared<const TetMesh>(std::move(mesh))](const MeshFile&) { return *mesh; };
  return result;
}

bool multiply_cells(MeshSource& mesh, double factor) {
  const auto multiply = [factor](int& n) { n = std::max(1, static_cast<int>(std::lround(n * factor))); };
  if (auto* box = std::get_if<BoxOptions>(&mesh)) {
    for (int& n : box->cells) multiply(n);
    return true;
  }
  if (auto* body = std::get_if<ImplicitBody>(&mesh)) {
    body->edge /= factor;
    for (MeshSize& size : body->sizes) size.edge /= factor;
    return true;
  }
  if (auto* liver = std::get_if<LiverOptions>(&mesh)) {
    liver->edge /= factor;
    for (MeshSize& size : liver->sizes) size.edge /= factor;
    return true;
  }
  if (auto* body = std::get_if<ImageBody>(&mesh)) {
    body->edge /= factor;
    for (MeshSize& size : body->sizes) size.edge /= factor;
    return true;
  }
  auto* cylinder = std::get_if<CylinderOptions>(&mesh);
  if (cylinder == nullptr) return false;
  multiply(cylinder->radial_cells), multiply(cylinder->axial_cells);
  return true;
}

RefinedVariant refined_variant(const Variant& variant, int times, const MeshLoader& load) {
  Variant own = variant;
  const bool any_step = capabilities(own.simulation.integrator).any_step_is_stable;
  if (times > 0 && !any_step) own.simulation.step.reset();
  if (times == 0) return {own, load, false};
  if (!std::holds_alternative<MeshFile>(own.mesh) && std::none_of(own.sets.begin(), own.sets.end(), is_by_number)) {
    multiply_cells(own.mesh, 1 << times);
    return {own, load, false};
  }
  TetMesh mesh = build_mesh(own, load);
  for (int i = 0; i < times; ++i) mesh = refined(mesh);
  return on_split_mesh(own, std::move(mesh));
}

std::optional<Variant> lighter_variant(const Variant& variant) {
  if (variant.simulation.integrator == Integrator::quasi_static) return std::nullopt;
  Variant lighter = variant;
  lighter.tissue.density *= 0.25;
  for (RegionSpec& region : lighter.regions) region.tissue.density *= 0.25;
  SimulationOptions& simulation = lighter.simulation;
  simulation.gravity = simulation.gravity * 4.0;
  if (simulation.step) *simulation.step *= 0.5;
  if (simulation.mass_scaling_step) *simulation.mass_scaling_step *= 0.5;
  if (simulation.integrator == Integrator::implicit) {
    simulation.implicit.largest_step = 0.5 * simulation.implicit.largest_step.value_or(kImplicitStep);
  }
  if (lighter.max_steps) *lighter.max_steps *= 4;
  return lighter;
}

double tool_area(const Variant& variant, const TetMesh& mesh) {
  std::vector<char> in(mesh.vertices.size(), 0);
  for (const ToolSpec& tool : variant.tools) {
    for (const std::uint32_t v : mesh.vertex_set(tool.set)) in[v] = 1;
  }
  double area = 0.0;
  for (const Triangle& t : boundary_triangles(mesh)) {
    if (in[t[0]] + in[t[1]] + in[t[2]] < 3) continue;
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    area += 0.5 * norm(cross(b - a, c - a));
  }
  return area;
}

double cell_size(const TetMesh& mesh) { return std::cbrt(6.0 * volume(mesh) / static_cast<double>(mesh.tets.size())); }

}  // namespace glisson
