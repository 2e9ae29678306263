// heat_simulation_body.cpp — a HeatSimulation follows a body that moves, is cut, or loses tets.
#include <algorithm>
#include <stdexcept>
#include <string>

#include "base/task_pool.h"
#include "heat/heat_simulation_impl.h"

namespace glisson {

/// Makes anew what follows from the body.
void HeatSimulation::Impl::rebuild() {
  const bool counts_time = stepper_ && stepper_->counts_time();
  const HeatWork work = stepper_ ? stepper_->work() : HeatWork{};
  stepper_.emplace(body_, options_.threads > 0 ? options_.threads : detail::threads_for(body_.size()));
  stepper_->set_work(work, counts_time);
  history_.emplace(body_, options_.isotherms);
}

/// Areas that heat goes through; of a set or a wall that is gone from the surface none.
void HeatSimulation::Impl::place_surfaces() {
  for (TimedSurface& x : surfaces_) {
    const auto* set = std::get_if<std::string>(&x.place);
    const int* vessel = std::get_if<int>(&x.place);
    if (set == nullptr && vessel == nullptr) continue;
    heat::SurfaceHeat now;
    try {
      now = set != nullptr ? surface_of(*set) : wall_of(*vessel);
    } catch (const std::invalid_argument&) {
    }
    x.heat.vertices = std::move(now.vertices), x.heat.area = std::move(now.area);
  }
}

/// Places that sources give heat to, by the material of the body.
void HeatSimulation::Impl::place_sources() {
  for (TimedSurface& x : surfaces_) {
    const auto* line = std::get_if<LineSource>(&x.place);
    if (line == nullptr) continue;
    x.heat.vertices.clear(), x.heat.area.clear();
    for (const auto& [v, length] : shares_of_line(*line, false))
      x.heat.vertices.push_back(v), x.heat.area.push_back(length);
  }
  for (Source& x : sources_) {
    const auto* line = std::get_if<LineSource>(&x.place);
    const auto share = line != nullptr ? shares_of_line(*line, false) : shares_of_region(std::get<int>(x.place));
    x.shares.assign(share.begin(), share.end());
  }
}

/// @throws std::invalid_argument where a source is bound to the mesh that the body had
void HeatSimulation::Impl::require_changeable() const {
  const auto is_pattern = [](const Source& x) { return std::holds_alternative<Pattern>(x.place); };
  if (radio_.empty() && std::none_of(sources_.begin(), sources_.end(), is_pattern)) return;
  throw std::invalid_argument(
      std::string("heat: change_mesh: ") + (radio_.empty() ? "a pattern of power" : "radio frequency") +
      " belongs to the tets that the body had; give power by region or line, or leave the mesh as it is");
}

std::map<std::uint32_t, double> HeatSimulation::Impl::shares_of_region(int region) const {
  std::map<std::uint32_t, double> share;
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    if (mesh_.region_of(t) != region) continue;
    for (const std::uint32_t v : mesh_.tets[t]) share[v] += six_rest_volume(mesh_, t) / 24.0;
  }
  return share;
}

void HeatSimulation::Impl::set_positions(std::span<const Vec3d> positions) {
  if (positions.size() != mesh_.vertices.size()) {
    throw std::invalid_argument("heat: set_positions: " + std::to_string(positions.size()) +
                                " positions were given, the mesh has " + std::to_string(mesh_.vertices.size()) +
                                " vertices");
  }
  positions_.assign(positions.begin(), positions.end());
  body_ = heat::HeatBody(mesh_, tissues_, options_.hollow, positions_);
  rebuild();
  place_surfaces();
}

void HeatSimulation::Impl::change_mesh(TetMesh mesh, std::span<const std::uint32_t> origins) {
  require_changeable();
  const std::size_t before = mesh_.vertices.size();
  if (mesh.vertices.size() != before + origins.size() ||
      std::any_of(origins.begin(), origins.end(), [&](std::uint32_t v) { return v >= before; })) {
    throw std::invalid_argument("heat: change_mesh: the mesh has " + std::to_string(mesh.vertices.size()) +
                                " vertices; it had " + std::to_string(before) + ", and " +
                                std::to_string(origins.size()) + " copies of these were named");
  }
  std::vector<Vec3d> positions = positions_;
  for (const std::uint32_t v : origins) {
    if (!positions.empty()) positions.push_back(Vec3d(positions[v]));
  }
  heat::HeatBody body(mesh, tissues_, options_.hollow, positions);
  const auto extend = [&](auto& list) {
    for (const std::uint32_t v : origins) {
      const auto value = list[v];
      list.push_back(value);
    }
  };
  mesh_ = std::move(mesh), positions_ = std::move(positions);
  HeatHistory& h = now_.history;
  for (auto* of : {&now_.temperature, &h.coldest, &h.hottest, &h.cem43, &h.damage, &h.cold_time}) extend(*of);
  for (std::vector<double>& of : h.below) extend(of);
  extend(h.freezings), extend(h.frozen), extend(h.dead), extend(held_);
  if (!now_.rate.empty()) extend(now_.rate);
  for (Held& x : holds_) {
    for (std::uint32_t k = 0; k < origins.size(); ++k) {
      if (std::find(x.vertices.begin(), x.vertices.end(), origins[k]) != x.vertices.end())
        x.vertices.push_back(static_cast<std::uint32_t>(before) + k);
    }
  }
  now_.heat.resize(held_.size(), 0.0);
  double gone = 0.0;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const bool same = i < before && body.volume(i) == body_.volume(i);
    const double heat = same ? now_.heat[i] : body.state(i, now_.temperature[i]).heat;
    gone += now_.heat[i] - heat;
    now_.heat[i] = heat;
  }
  now_.ledger.stored -= gone, now_.ledger.removed -= gone;
  body_ = std::move(body);
  rebuild();
  place_surfaces();
  place_sources();
}

void HeatSimulation::set_positions(std::span<const Vec3d> positions) { impl_->set_positions(positions); }

void HeatSimulation::change_mesh(TetMesh mesh, std::span<const std::uint32_t> origins) {
  impl_->change_mesh(std::move(mesh), origins);
}

}  // namespace glisson
