// keep_history.h — adds a step to what the vertices have been through.
#pragma once

#include <span>
#include <vector>

#include "glisson/heat/heat_history.h"
#include "heat/blocks.h"
#include "heat/heat_body.h"

namespace glisson::heat {

class HistoryKeeper {
 public:
  HistoryKeeper(const HeatBody& body, std::vector<double> isotherms);

  /// The history of a body that has been at these temperatures for no time yet.
  HeatHistory begin(std::span<const double> temperature) const;
  /// @param h  length of the step [s] @param before,after  temperatures at its ends [°C]
  void add(double h, std::span<const double> before, std::span<const double> after, Blocks& blocks,
           HeatHistory& history) const;

 private:
  void add_at(std::size_t vertex, double h, double before, double after, HeatHistory& history) const;
  double liquid_share(std::size_t vertex, double temperature) const;

  const HeatBody* body_;
  std::vector<double> isotherms_;
  std::vector<const TissueDeath*> death_;  // of each vertex; null: its tissue does not die
};

}  // namespace glisson::heat
