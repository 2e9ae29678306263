// heat_flows.h — what flows into each vertex at given temperatures, and what the limiter leaves of conductances below 0.
//
// Flows into a vertex against the fall of temperature, over conductances below 0, may not exceed Q⁺, those out of it Q⁻:
//   Q± = flows along the fall + γ Σ |w| |Θ_± − Θ| + what else flows in (Q⁺) or out (Q⁻),   w < 0, Θ_± largest and least beside it
// "Else" are blood, surface, sources and what the vertex had and gave. At an extreme that nothing of these makes, Q is 0, so that no such
// flow makes one. With γ the spread of a vertex nothing is taken of linear fields [BarrenecheaJohnKnobloch2017]; of vertices whose
// temperature is given nothing is asked. What is left of each flow stays as it is until limit() is called again: with shares that
// stay, the flows are a symmetric operator on ∫ k dT. What one vertex loses another gets [KuzminShashkovSvyatskiy2009].
#pragma once

#include <span>
#include <vector>

#include "heat/blocks.h"
#include "heat/heat_body.h"

namespace glisson::heat {

/// Heat through a part of the surface, by vertex: flux · area, or coefficient · area (ambient − T). Of a line its length stands for the
/// area.
struct SurfaceHeat {
  enum class What { flux, convection, line } what = What::flux;
  std::vector<std::uint32_t> vertices;
  std::vector<double> area;  ///< of each [m²]; of a line [m]
  double coefficient = 0.0;  ///< at the time in question [W/(m² K)]; of a line [W/(m K)]
  double value = 0.0;        ///< at that time: flux [W/m²], or what is beyond the surface [°C]
};

/// Of each vertex [W].
struct Flows {
  std::vector<double> conduction, blood, metabolism, surface, lines;
  std::vector<double> loss;  ///< −d(blood + metabolism + surface + lines)/dT [W/K]; below 0 where blood comes with thaw
  double limited = 0.0;      ///< conduction that the limiter took away over all of it [-]

  double sum(std::size_t i) const { return conduction[i] + blood[i] + metabolism[i] + surface[i] + lines[i]; }
};

class FlowFinder {
 public:
  FlowFinder(const HeatBody& body, Blocks& blocks);

  /// States of the vertices at these temperatures, and their flows but for conduction. @param dead  1: without blood and metabolism
  void set_temperature(std::span<const double> temperature, std::span<const SurfaceHeat> surfaces,
                       std::span<const std::uint8_t> dead, Flows& flows);
  const std::vector<VertexState>& states() const { return states_; }
  /// ∫ k dT of each part [W/m].
  std::span<const double> conducted() const { return conducted_; }
  /// Of each part its k over the mean of its vertex; empty with one tissue, where it is 1.
  std::span<const double> ratio() const { return ratio_; }

  /// Conduction into a vertex [W].
  double conduction(std::size_t vertex) const;

  bool has_negative() const { return !body_->negative_links().empty(); }
  /// Leaves of each conductance below 0 a share of what these temperatures allow, all of it where that is enough.
  /// @param share  at most 1 @param else_in  what else flows into each vertex [W]; infinite where its temperature is given
  /// @param limited  as in Flows
  void limit(double share, std::span<const double> else_in, double& limited);
  /// Takes from those that leave more than these temperatures allow, where that would move a temperature. @param h  length of the step [s]
  /// @return whether it did
  bool tighten(double share, std::span<const double> else_in, double h, double& limited);

  /// What is left of each link [m], as body.links().w, and the sum of each row.
  std::span<const double> left() const { return left_; }
  std::span<const double> left_sum() const { return left_sum_; }

 private:
  void find_allowed(std::span<const double> else_in);
  struct Around;
  Around around(std::size_t vertex) const;
  template <class Leave>
  bool set_left(double& limited, const Leave& leave);

  const HeatBody* body_;
  Blocks* blocks_;
  std::vector<VertexState> states_;
  std::vector<double> conducted_, ratio_;
  std::vector<double> left_, positive_sum_, negative_sum_, left_sum_;
  std::vector<double> shares_;  // left of each negative link
  // Of each vertex: Q⁺ and Q⁻ over what flows against the fall of temperature, in and out.
  std::vector<double> rise_, fall_;
  double whole_ = 0.0;
};

}  // namespace glisson::heat
