#include "mechanics/body_change.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace glisson {

BodyChanger::BodyChanger(Body& body)
    : body_(body), stars_(body.elements, body.vertex_count), element_of_(body.elements.size()) {
  for (std::uint32_t e = 0; e < element_of_.size(); ++e) element_of_[body.mesh_tet[e]] = e;
  quarter_masses_.reserve(body.elements.size());
  for (const TissueBlock& block : body.blocks) {
    for (std::size_t e = block.begin; e < block.end; ++e) {
      quarter_masses_.push_back(body.quarter_mass(block, e));
    }
  }
}

/// Sums the masses of these vertices anew, in the order of build_body, and sorts them.
void BodyChanger::weigh(std::vector<std::uint32_t>& vertices) {
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (const std::uint32_t v : vertices) {
    double mass = 0.0;
    for (const std::uint32_t e : stars_.tets_at(v)) mass += quarter_masses_[e];
    body_.masses[v] = mass;
  }
}

std::vector<std::uint32_t> BodyChanger::living_elements(std::span<const std::uint32_t> mesh_tets) const {
  std::vector<std::uint32_t> elements;
  for (const std::uint32_t t : mesh_tets) {
    if (t >= element_of_.size()) {
      throw std::invalid_argument("remove_tets: tet " + std::to_string(t) + " is outside the mesh, 0 to " +
                                  std::to_string(element_of_.size() - 1));
    }
    if (!is_removed(t)) elements.push_back(element_of_[t]);
  }
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  return elements;
}

BodyChange BodyChanger::remove(std::span<const std::uint32_t> elements) {
  BodyChange change;
  change.removed.assign(elements.begin(), elements.end());
  for (const std::uint32_t e : change.removed) {
    quarter_masses_[e] = 0.0;
    body_.rest[e] = {};
    stars_.remove(e, body_.elements[e]);
    change.touched.insert(change.touched.end(), body_.elements[e].begin(), body_.elements[e].end());
  }
  weigh(change.touched);
  return change;
}

BodyChange BodyChanger::split(std::span<const Triangle> faces) {
  const auto first_new = static_cast<std::uint32_t>(body_.vertex_count);
  detail::SplitPlan plan = detail::plan_split(body_.elements, stars_, faces, first_new, closed_);
  detail::apply_split(plan, body_.elements, stars_);
  BodyChange change{
      .removed = {}, .corners = std::move(plan.corners), .origins = std::move(plan.origins), .touched = {}};
  closed_ = std::move(plan.closed);
  for (const std::uint32_t origin : change.origins) {
    change.touched.push_back(origin);
    change.touched.push_back(static_cast<std::uint32_t>(body_.vertex_count++));
    body_.rest_positions.push_back(Vec3d(body_.rest_positions[origin]));
    body_.masses.push_back(0.0);
  }
  weigh(change.touched);
  return change;
}

}  // namespace glisson
