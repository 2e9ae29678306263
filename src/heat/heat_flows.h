// heat_flows.h — what flows into each vertex at given temperatures.
#pragma once

#include <span>
#include <vector>

#include "heat/heat_body.h"

namespace glisson::heat {

/// Heat through a part of the surface, by vertex: flux · area + coefficient · area (ambient − T).
struct SurfaceHeat {
  std::vector<std::uint32_t> vertices;
  std::vector<double> area;  ///< of each [m²]
  double coefficient = 0.0;  ///< [W/(m² K)]
  double value =
      0.0;  ///< at the time in question: flux [W/m²], or ambient temperature [°C] where there is a coefficient
};

/// Of each vertex [W].
struct Flows {
  std::vector<double> conduction, blood, metabolism, surface;
  std::vector<double> loss;  ///< −d(blood + metabolism + surface)/dT [W/K]; below 0 where blood comes with thaw
  double limited = 0.0;      ///< conduction that the limiter took away over all of it [-]

  double sum(std::size_t i) const { return conduction[i] + blood[i] + metabolism[i] + surface[i]; }
};

/// What a limiter leaves of a flow: what these temperatures allow; what it left before, so that iterations come to rest; a share of the
/// less of the two where these temperatures do not allow all.
enum class Limiter { follows, keeps, tightens };

class FlowFinder {
 public:
  explicit FlowFinder(const HeatBody& body);

  void find(std::span<const double> temperature, std::span<const SurfaceHeat> surfaces, Limiter limiter, double share,
            Flows& flows);
  /// What the limiter left of each conductance, at the temperatures of the last find() [m].
  std::span<const double> conductances() const { return left_; }
  /// Whether shares that were kept leave more than these temperatures allow.
  bool keeps_too_much() const { return too_much_; }

 private:
  void conduct(Limiter limiter, double share, Flows& flows);
  void limit(Limiter limiter, double share, Flows& flows);

  const HeatBody* body_;
  bool too_much_ = false;
  std::vector<std::uint32_t> negative_;                            // conductances below 0
  std::vector<double> flow_, left_;                                // of each conductance: heat into i [W], itself [m]
  std::vector<std::vector<double>> conducted_;                     // ∫ k dT, by tissue and vertex
  std::vector<double> in_least_, in_most_, may_least_, may_most_;  // of the limiter
};

}  // namespace glisson::heat
