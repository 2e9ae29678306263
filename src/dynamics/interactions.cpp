#include "dynamics/interactions.h"

#include <algorithm>

namespace glisson {

std::span<const std::uint32_t> Interactions::newcomers(double time, double h, std::size_t vertex_count) {
  newcomers_.clear();
  for (const std::shared_ptr<Interaction>& x : all_) {
    for (const std::uint32_t v : x->reach(time, h)) {
      if (v < vertex_count && (v >= place_of_.size() || place_of_[v] == InteractionStep::kNowhere)) {
        newcomers_.push_back(v);
      }
    }
  }
  std::sort(newcomers_.begin(), newcomers_.end());
  newcomers_.erase(std::unique(newcomers_.begin(), newcomers_.end()), newcomers_.end());
  return newcomers_;
}

void Interactions::find_places(std::span<const ActiveVertex> active, std::size_t vertex_count) {
  if (all_.empty()) return;
  place_of_.assign(vertex_count, InteractionStep::kNowhere);
  for (std::uint32_t k = 0; k < active.size(); ++k) place_of_[active[k].vertex] = k;
  impulses_.assign(active.size(), Vec3d{});
}

void Interactions::begin(double time, double h, std::span<ActiveVertex> active, std::span<const Vec3d> rest,
                         bool accounted) {
  std::fill(impulses_.begin(), impulses_.end(), Vec3d{});
  step_.time = time;
  step_.h = h;
  step_.vertices = active;
  step_.place_of = place_of_;
  step_.rest = rest;
  step_.mobility = {};
  step_.impulses = impulses_;
  step_.interface_book = nullptr;
  if (!accounted || all_.empty()) return;
  book_.begin(active.size());
  step_.interface_book = &book_;
}

void Interactions::add_forces() {
  for (const std::shared_ptr<Interaction>& x : all_) x->add_forces(step_);
}

void Interactions::constrain(std::span<const Vec3d> mobility) {
  step_.mobility = mobility;
  for (const std::shared_ptr<Interaction>& x : all_) x->constrain(step_);
}

void Interactions::moved() {
  for (const std::shared_ptr<Interaction>& x : all_) x->moved(step_);
}

void Interactions::body_changed(const BodyView& body, std::span<const std::uint32_t> origins) {
  for (const std::shared_ptr<Interaction>& x : all_) x->body_changed(body, origins);
}

double Interactions::tool_energy() const {
  double sum = 0.0;
  for (const std::shared_ptr<Interaction>& x : all_) sum += x->tool_energy();
  return sum;
}

double Interactions::squared_frequency() const {
  double sum = 0.0;
  for (const std::shared_ptr<Interaction>& x : all_) sum += x->squared_frequency();
  return sum;
}

void Interactions::archive(Archive& ar) {
  auto count = static_cast<std::uint32_t>(all_.size());
  ar(count);
  ar.check(count == all_.size());
  for (const std::shared_ptr<Interaction>& x : all_) x->archive(ar);
  ar.same_size(impulses_);
}

}  // namespace glisson
