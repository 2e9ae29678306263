#include "element/body.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>

#include "material/viscosity.h"

namespace glisson {
namespace {

std::array<Vec3d, 4> corners_of(const TetMesh& mesh, const Tet& t) {
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], mesh.vertices[t[3]]};
}

const Tissue& tissue_of_region(const TetMesh& mesh, const std::map<int, Tissue>& tissues, int region) {
  if (const auto it = tissues.find(region); it != tissues.end()) return it->second;
  const auto name = mesh.region_names.find(region);
  const std::string label = name == mesh.region_names.end() ? "" : " (\"" + name->second + "\")";
  throw std::invalid_argument("region " + std::to_string(region) + label +
                              " of the mesh has no tissue; give one for each region number that occurs");
}

/// Elements in order of region, in mesh order within a region.
std::vector<std::uint32_t> elements_by_region(const TetMesh& mesh) {
  std::vector<std::uint32_t> order(mesh.tets.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return mesh.region_of(a) < mesh.region_of(b); });
  return order;
}

}  // namespace

const TissueBlock& Body::block_of(std::size_t element) const {
  return *std::find_if(blocks.begin(), blocks.end(), [&](const TissueBlock& b) { return element < b.end; });
}

double Body::quarter_mass(const TissueBlock& block, std::size_t e) const {
  return 0.25 * block.tissue.density * rest[e].volume * (mass_factor.empty() ? 1.0 : mass_factor[e]);
}

TissueBlock make_block(const Tissue& tissue, std::size_t begin, std::size_t end) {
  require_valid(tissue);
  return {tissue, tissue.lame(), viscous_coefficients(tissue), begin, end};
}

void require_fibres(const Body& body, const TissueBlock& block, const Tissue& tissue) {
  if (!tissue.fibres || body.fibres.empty()) return;
  for (std::size_t e = block.begin; e < block.end; ++e) {
    if (norm(body.fibres[body.mesh_tet[e]]) > 0.0) continue;
    throw std::invalid_argument("tet " + std::to_string(body.mesh_tet[e]) + " of tissue \"" + tissue.name +
                                "\" has fibres, but the mesh gives it a direction without length; give it one, or " +
                                "another tissue, or leave the directions out of the mesh");
  }
}

/// m_i = Σ ρV/4 over the tets around vertex i, the lumped mass of [Schwartz2002, eq. 3].
bool only_relaxes(const Body& body) {
  bool any = false;
  for (const TissueBlock& block : body.blocks) {
    if (block.tissue.viscosity > 0.0) return false;
    any = any || !block.tissue.maxwell.empty();
  }
  return any;
}

void lump_masses(Body& body) {
  body.masses.assign(body.vertex_count, 0.0);
  for (const TissueBlock& block : body.blocks) {
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const double quarter = body.quarter_mass(block, e);
      for (const std::uint32_t v : body.elements[e]) body.masses[v] += quarter;
    }
  }
}

ElementRest element_rest(const std::array<Vec3d, 4>& x) {
  const Vec3d a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
  const double six_volume = dot(a, cross(b, c));
  const double scale = 1.0 / six_volume;
  return {six_volume / 6.0, {cross(b, c) * scale, cross(c, a) * scale, cross(a, b) * scale}};
}

Body build_body(const TetMesh& mesh, const std::map<int, Tissue>& tissues) {
  require_valid(mesh);
  Body body;
  body.vertex_count = mesh.vertices.size();
  body.rest_positions = mesh.vertices;
  body.fibres = mesh.fibres;
  body.mesh_tet = elements_by_region(mesh);
  for (const std::uint32_t t : body.mesh_tet) {
    const std::size_t e = body.elements.size();
    const bool new_region = e == 0 || mesh.region_of(t) != mesh.region_of(body.mesh_tet[e - 1]);
    if (new_region) body.blocks.push_back(make_block(tissue_of_region(mesh, tissues, mesh.region_of(t)), e, e));
    body.elements.push_back(mesh.tets[t]);
    body.rest.push_back(element_rest(corners_of(mesh, mesh.tets[t])));
    body.blocks.back().end = e + 1;
  }
  for (const TissueBlock& block : body.blocks) require_fibres(body, block, block.tissue);
  lump_masses(body);
  return body;
}

Mat3d element_gradient(const Body& body, std::size_t e, std::span<const Vec3d> u) {
  const Tet& t = body.elements[e];
  return displacement_gradient(body.rest[e].s, {u[t[1]] - u[t[0]], u[t[2]] - u[t[0]], u[t[3]] - u[t[0]]});
}

}  // namespace glisson
