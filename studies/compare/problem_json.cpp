// problem_json.cpp — see problem_json.h.
#include "compare/problem_json.h"

#include "compare/models/boundary.h"
#include "compare/models/relaxation.h"

namespace glisson::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kTimesPerStation = 20;  // straight lines between them are within 0.03 % of half a turn in five stations

Json list(const Vec3d& v) { return {v.x, v.y, v.z}; }

Json list(std::span<const Vec3d> vectors) {
  Json out = Json::array();
  for (const Vec3d& v : vectors) out.push_back(list(v));
  return out;
}

Json list(const Axes& axes) { return {axes.x, axes.y, axes.z}; }

std::vector<double> times_of(const std::vector<double>& stations) {
  std::vector<double> times;
  double before = 0.0;
  for (const double station : stations) {
    for (int k = 1; k < kTimesPerStation; ++k) times.push_back(before + (station - before) * k / kTimesPerStation);
    times.push_back(station);
    before = station;
  }
  return times;
}

Json tool_json(const models::Tool& tool, const TetMesh& mesh, const std::vector<double>& times) {
  Json path = Json::array();
  for (const double time : times) {
    Json now = Json::array();
    for (const std::uint32_t v : tool.vertices)
      now.push_back(list(models::tool_displacement(tool, mesh.vertices[v], time)));
    path.push_back(std::move(now));
  }
  return {{"vertices", tool.vertices}, {"axes", list(tool.axes)}, {"displacements_m", std::move(path)}};
}

Json mesh_json(const models::Problem& problem, const std::vector<double>& times) {
  Json supports = Json::array(), tools = Json::array(), regions = Json::array();
  for (const models::Support& s : problem.supports) {
    supports.push_back({{"vertices", s.vertices}, {"axes", list(s.axes)}});
  }
  for (const models::Tool& t : problem.tools) tools.push_back(tool_json(t, problem.mesh, times));
  for (std::size_t t = 0; t < problem.mesh.tets.size(); ++t) regions.push_back(problem.mesh.region_of(t));
  return {{"vertices_m", list(problem.mesh.vertices)},
          {"tets", problem.mesh.tets},
          {"regions", std::move(regions)},
          {"supports", std::move(supports)},
          {"tools", std::move(tools)}};
}

Json tissues_json(const models::Problem& problem) {
  Json tissues = Json::array();
  for (const auto& [region, tissue] : problem.tissues) {
    const LameParameters lame = tissue.lame();
    tissues.push_back({{"region", region},
                       {"law", tissue.hyperelastic ? law_name(*tissue.hyperelastic) : ""},
                       {"viscous", models::is_viscous(tissue)},
                       {"density_kg_m3", tissue.density},
                       {"lambda_Pa", lame.lambda},
                       {"mu_Pa", lame.mu}});
  }
  return tissues;
}

}  // namespace

Json problem_json(const Comparison& c, const std::string& scene) {
  const models::Problem& first = c.problems.front();
  const std::vector<double> times = times_of(c.stations);
  Json meshes = Json::array();
  for (const models::Problem& problem : c.problems) meshes.push_back(mesh_json(problem, times));
  const std::span<const Vec3d> shape(c.reference.displacement);
  return {{"scene", scene},
          {"unit", c.moments ? "N m" : "N"},
          {"stations_s", c.stations},
          {"times_s", times},
          {"times_per_station", kTimesPerStation},
          {"moment_about_m", first.moment_about ? list(*first.moment_about) : Json()},
          {"gravity_m_s2", list(first.motion.gravity)},
          {"gravity_ramp_s", first.motion.gravity_ramp},
          {"damping_per_s", first.damping()},
          {"cut_at_s", first.cut ? Json(first.cut->time) : Json()},
          {"tissues", tissues_json(first)},
          {"meshes", std::move(meshes)},
          {"surface", c.surface},
          {"reference",
           {{"tets", c.reference.tets},
            {"forces", list(c.reference.forces)},
            {"displacement_m", list(shape.first(c.problems.back().mesh.vertices.size()))}}}};
}

}  // namespace glisson::app
