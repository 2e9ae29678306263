#include "heat/heat_flows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glisson::heat {
namespace {

constexpr double kSame = 1e-9;    // of shares that a limiter leaves
constexpr double kMoves = 1e-11;  // of a temperature, by one flow too large [K]

}  // namespace

FlowFinder::FlowFinder(const HeatBody& body, Blocks& blocks)
    : body_(&body), blocks_(&blocks), states_(body.size()), conducted_(body.part_count(), 0.0), left_(body.links().w),
      positive_sum_(body.part_count(), 0.0), negative_sum_(body.part_count(), 0.0), left_sum_(body.part_count(), 0.0),
      shares_(body.negative_links().size(), 1.0), rise_(body.size(), 1.0), fall_(body.size(), 1.0) {
  if (body.tissues() > 1) ratio_.assign(body.part_count(), 1.0);
  const Links& links = body.links();
  for (std::size_t p = 0; p < body.part_count(); ++p) {
    for (std::uint32_t k = links.begin[p]; k < links.negative[p]; ++k) positive_sum_[p] += left_[k];
    for (std::uint32_t k = links.negative[p]; k < links.begin[p + 1]; ++k) negative_sum_[p] -= left_[k];
    left_sum_[p] = positive_sum_[p] - negative_sum_[p];
  }
}

void FlowFinder::set_temperature(std::span<const double> temperature, std::span<const SurfaceHeat> surfaces,
                                 std::span<const std::uint8_t> dead, Flows& flows) {
  const std::size_t n = body_->size();
  for (auto* of : {&flows.conduction, &flows.blood, &flows.metabolism, &flows.loss}) of->resize(n);
  flows.surface.assign(n, 0.0), flows.lines.assign(n, 0.0);
  blocks_->run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      VertexState sum;
      double blood = 0.0, metabolism = 0.0, loss = 0.0;
      const std::size_t first = body_->first_part(i);
      const std::span<const Part> parts = body_->parts(i);
      for (std::size_t k = 0; k < parts.size(); ++k) {
        const double volume = parts[k].volume;
        const ThermalCurve& curve = body_->curve(parts[k].tissue);
        const ThermalState s = curve.at(temperature[i]);
        conducted_[first + k] = s.conducted;
        if (!ratio_.empty()) ratio_[first + k] = s.conductivity;
        sum.heat += volume * s.heat, sum.capacity += volume * s.capacity, sum.conductivity += volume * s.conductivity;
        const double warms = curve.blood_heat * (curve.blood_temperature - temperature[i]);
        blood += s.liquid * volume * warms, metabolism += s.liquid * volume * curve.metabolic_heat;
        loss += volume * (s.liquid * curve.blood_heat - s.melting * (warms + curve.metabolic_heat));
      }
      sum.conductivity = body_->volume(i) > 0.0 ? sum.conductivity / body_->volume(i) : 1.0;
      if (!ratio_.empty()) {
        for (std::size_t k = 0; k < parts.size(); ++k) ratio_[first + k] /= sum.conductivity;
      }
      states_[i] = sum;
      if (dead[i] != 0) blood = metabolism = loss = 0.0;
      flows.blood[i] = blood, flows.metabolism[i] = metabolism, flows.loss[i] = loss;
    }
  });
  for (const SurfaceHeat& x : surfaces) {
    for (std::size_t k = 0; k < x.vertices.size(); ++k) {
      const std::uint32_t v = x.vertices[k];
      if (x.what == SurfaceHeat::What::flux) {
        flows.surface[v] += x.area[k] * x.value;
      } else {
        const double per_kelvin = x.area[k] * x.coefficient;
        (x.what == SurfaceHeat::What::line ? flows.lines : flows.surface)[v] += per_kelvin * (x.value - temperature[v]);
        flows.loss[v] += per_kelvin;
      }
    }
  }
}

double FlowFinder::conduction(std::size_t vertex) const {
  const Links& links = body_->links();
  const std::size_t first = body_->first_part(vertex), last = first + body_->parts(vertex).size();
  double sum = 0.0;
  for (std::size_t p = first; p < last; ++p) {
    const double here = conducted_[p];
    for (std::uint32_t k = links.begin[p]; k < links.begin[p + 1]; ++k)
      sum += left_[k] * (conducted_[links.to[k]] - here);
  }
  return sum;
}

// Of a vertex, in W; sums of flows and of their sizes, which at an extreme are the same to the last bit.
struct FlowFinder::Around {
  double along = 0.0, along_size = 0.0, against = 0.0, against_size = 0.0;
  double up = 0.0, down = 0.0;  // γ Σ |w| (Θ_+ − Θ), γ Σ |w| (Θ − Θ_−)
};

FlowFinder::Around FlowFinder::around(std::size_t vertex) const {
  const Links& links = body_->links();
  Around sums;
  // A vertex between two tissues is an extreme of each where heat goes through their face: so the tissues' are taken together.
  double up = 0.0, down = 0.0, negative = 0.0;
  const std::size_t first = body_->first_part(vertex), last = first + body_->parts(vertex).size();
  for (std::size_t p = first; p < last; ++p) {
    const double here = conducted_[p];
    double high = 0.0, low = 0.0;
    const auto add = [&](std::uint32_t k, double& sum, double& size) {
      const double difference = conducted_[links.to[k]] - here, flow = links.w[k] * difference;
      sum += flow, size += std::abs(flow);
      high = std::max(high, difference), low = std::min(low, difference);
    };
    for (std::uint32_t k = links.begin[p]; k < links.negative[p]; ++k) add(k, sums.along, sums.along_size);
    for (std::uint32_t k = links.negative[p]; k < links.begin[p + 1]; ++k) add(k, sums.against, sums.against_size);
    const double ratio = ratio_.empty() ? 1.0 : ratio_[p];
    up = std::max(up, high / ratio), down = std::max(down, -low / ratio);
    negative += ratio * negative_sum_[p];
  }
  negative *= body_->spread(vertex);
  sums.up = negative * up, sums.down = negative * down;
  return sums;
}

void FlowFinder::find_allowed(std::span<const double> else_in) {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  whole_ = blocks_->sums<1>([&](std::size_t begin, std::size_t end) -> std::array<double, 1> {
    double whole = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const Around x = around(i);
      const double in = x.along_size + x.along + 2.0 * (x.up + std::max(0.0, else_in[i])),
                   out = x.along_size - x.along + 2.0 * (x.down + std::max(0.0, -else_in[i])),
                   against_in = x.against_size + x.against, against_out = x.against_size - x.against;  // twice
      rise_[i] = against_in > 0.0 && else_in[i] < kAll ? in / against_in : kAll;
      fall_[i] = against_out > 0.0 && else_in[i] < kAll ? out / against_out : kAll;
      whole += x.along_size + x.against_size;
    }
    return {0.5 * whole};
  })[0];
}

// leave(share before, share allowed, flow, a, b) returns the share to leave.
template <class Leave>
bool FlowFinder::set_left(double& limited, const Leave& leave) {
  const std::span<const NegativeLink> all = body_->negative_links();
  const Links& links = body_->links();
  const auto [taken, changed] = blocks_->sums<2>(all.size(), [&](std::size_t begin, std::size_t end) {
    std::array<double, 2> sums{};
    for (std::size_t e = begin; e < end; ++e) {
      const NegativeLink& x = all[e];
      const std::uint32_t a = body_->vertex_of(x.a), b = body_->vertex_of(x.b);
      const double w = links.w[x.at_ab], flow = w * (conducted_[x.b] - conducted_[x.a]);  // into a
      const double allowed = flow > 0.0 ? std::min(rise_[a], fall_[b]) : std::min(rise_[b], fall_[a]);
      const double before = shares_[e], share = leave(before, allowed, flow, a, b);
      if (share != before) shares_[e] = share, left_[x.at_ab] = left_[x.at_ba] = share * w, sums[1] += 1.0;
      sums[0] += (1.0 - share) * std::abs(flow);
    }
    return sums;
  });
  limited = whole_ > 0.0 ? taken / whole_ : 0.0;
  if (changed == 0.0) return false;
  blocks_->run(body_->part_count(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      double sum = positive_sum_[p];
      for (std::uint32_t k = links.negative[p]; k < links.begin[p + 1]; ++k) sum += left_[k];
      left_sum_[p] = sum;
    }
  });
  return true;
}

void FlowFinder::limit(double share, std::span<const double> else_in, double& limited) {
  find_allowed(else_in);
  set_left(limited, [share](double, double allowed, double, std::uint32_t, std::uint32_t) {
    return std::min(1.0, share * allowed);
  });
}

bool FlowFinder::tighten(double share, std::span<const double> else_in, double h, double& limited) {
  find_allowed(else_in);
  return set_left(limited, [&](double before, double allowed, double flow, std::uint32_t a, std::uint32_t b) {
    const bool moves =
        h * (before - allowed) * std::abs(flow) > kMoves * std::min(states_[a].capacity, states_[b].capacity);
    return before > allowed + kSame && moves ? share * allowed : before;
  });
}

}  // namespace glisson::heat
