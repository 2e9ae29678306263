#include "heat/heat_flows.h"

#include <algorithm>
#include <cmath>

namespace glisson::heat {
namespace {

constexpr double kSame = 1e-9;  // of shares that a limiter leaves

}  // namespace

FlowFinder::FlowFinder(const HeatBody& body) : body_(&body), flow_(body.conductances().size()) {
  const auto all = body.conductances();
  for (std::uint32_t e = 0; e < all.size(); ++e) {
    if (all[e].w < 0.0) negative_.push_back(e);
    left_.push_back(all[e].w);
  }
  conducted_.assign(body.tissues(), std::vector<double>(body.size(), 0.0));
}

void FlowFinder::find(std::span<const double> temperature, std::span<const SurfaceHeat> surfaces, Limiter limiter,
                      double share, Flows& flows) {
  const std::size_t n = body_->size();
  for (auto* of : {&flows.conduction, &flows.blood, &flows.metabolism, &flows.surface, &flows.loss}) of->assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (const Part& p : body_->parts(i)) {
      const ThermalTissue& t = body_->tissue(p.tissue);
      const ThermalState s = thermal_state(t, temperature[i]);
      conducted_[p.tissue][i] = s.conducted;
      const double blood = t.perfusion * t.blood_heat_capacity * p.volume;
      flows.blood[i] += s.liquid * blood * (t.blood_temperature - temperature[i]);
      flows.metabolism[i] += s.liquid * t.metabolic_heat * p.volume;
      flows.loss[i] +=
          s.liquid * blood - s.melting * (blood * (t.blood_temperature - temperature[i]) + t.metabolic_heat * p.volume);
    }
  }
  for (const SurfaceHeat& x : surfaces) {
    for (std::size_t k = 0; k < x.vertices.size(); ++k) {
      const std::uint32_t v = x.vertices[k];
      if (x.coefficient == 0.0) {
        flows.surface[v] += x.area[k] * x.value;
      } else {
        flows.surface[v] += x.area[k] * x.coefficient * (x.value - temperature[v]);
        flows.loss[v] += x.area[k] * x.coefficient;
      }
    }
  }
  conduct(limiter, share, flows);
}

void FlowFinder::conduct(Limiter limiter, double share, Flows& flows) {
  const auto all = body_->conductances();
  double whole = 0.0;
  for (std::size_t e = 0; e < all.size(); ++e) {
    const std::vector<double>& theta = conducted_[all[e].tissue];
    flow_[e] = all[e].w * (theta[all[e].j] - theta[all[e].i]);
    whole += std::abs(flow_[e]);
  }
  flows.limited = 0.0;
  if (!negative_.empty()) limit(limiter, share, flows);
  if (whole > 0.0) flows.limited /= whole;
  for (std::size_t e = 0; e < all.size(); ++e) {
    flows.conduction[all[e].i] += flow_[e], flows.conduction[all[e].j] -= flow_[e];
  }
}

// Flows against the temperature's fall may not exceed, vertex by vertex, those along it: at an extreme these are on one side, so
// that no flow makes it larger.                                                                            [KuzminShashkovSvyatskiy2009]
void FlowFinder::limit(Limiter limiter, double share, Flows& flows) {
  const auto all = body_->conductances();
  const std::size_t n = body_->size();
  too_much_ = false;
  for (auto* of : {&in_least_, &in_most_, &may_least_, &may_most_}) of->assign(n, 0.0);
  for (std::size_t e = 0; e < all.size(); ++e) {
    std::vector<double>&most = all[e].w < 0.0 ? in_most_ : may_most_, &least = all[e].w < 0.0 ? in_least_ : may_least_;
    const double f = flow_[e];
    most[all[e].i] += std::max(0.0, f), least[all[e].i] += std::min(0.0, f);
    most[all[e].j] += std::max(0.0, -f), least[all[e].j] += std::min(0.0, -f);
  }
  const auto allowed = [](double may, double in) { return std::abs(in) <= std::abs(may) ? 1.0 : may / in; };
  for (const std::uint32_t e : negative_) {
    const std::uint32_t up = flow_[e] > 0.0 ? all[e].i : all[e].j, down = flow_[e] > 0.0 ? all[e].j : all[e].i;
    double passes = std::min(allowed(may_most_[up], in_most_[up]), allowed(may_least_[down], in_least_[down]));
    const double before = left_[e] / all[e].w;
    if (limiter == Limiter::keeps) {
      too_much_ = too_much_ || before > passes + kSame;
      passes = before;
    } else if (limiter == Limiter::tightens) {
      passes = std::min(before, passes < 1.0 ? share * passes : 1.0);
    }
    flows.limited += (1.0 - passes) * std::abs(flow_[e]);
    flow_[e] *= passes, left_[e] = passes * all[e].w;
  }
}

}  // namespace glisson::heat
