// heat_simulation_impl.h — what a HeatSimulation consists of.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "glisson/heat/heat_simulation.h"
#include "heat/heat_step.h"
#include "heat/joule_heat.h"
#include "heat/keep_history.h"

namespace glisson {

class HeatSimulation::Impl {
 public:
  Impl(TetMesh given, const std::map<int, ThermalTissue>& tissues, const HeatOptions& options);

  struct Held {
    std::vector<std::uint32_t> vertices;
    TimeFunction<double> temperature;
  };
  struct TimedSurface {
    heat::SurfaceHeat heat;
    TimeFunction<double> value;
    TimeFunction<double> coefficient{};  // none: that of `heat`
  };
  /// Power by vertex where a function of time is 1.
  struct Source {
    std::vector<std::pair<std::uint32_t, double>> shares;
    TimeFunction<double> power;
  };

  TetMesh mesh_;
  std::map<int, ThermalTissue> tissues_;
  HeatOptions options_;
  heat::HeatBody body_;
  heat::HeatStepper stepper_;
  heat::HistoryKeeper history_;
  std::vector<Held> holds_;
  std::vector<TimedSurface> surfaces_;
  std::vector<Source> sources_;
  std::vector<heat::JouleHeat> radio_;

  HeatState now_;
  std::vector<char> held_;

  void hold(std::span<const std::uint32_t> vertices, TimeFunction<double> temperature);
  heat::SurfaceHeat surface_of(const std::string& set) const;
  heat::SurfaceHeat wall_of(int region) const;
  void add_convection(heat::SurfaceHeat surface, TimeFunction<double> coefficient, TimeFunction<double> ambient);
  void add_radio(RadioFrequency radio);
  bool is_hollow(int region) const;
  void add_line(const LineSource& source);
  std::map<std::uint32_t, double> shares_of_line(const LineSource& source) const;
  HeatStep step_up_to(double most);

 private:
  struct Trial {
    std::vector<double> temperature;
    heat::Flows flows;
    std::vector<double> sources;
    int iterations = 0;
    double error = 0.0;  // [K]
  };
  std::optional<Trial> make(double h);
  std::vector<heat::SurfaceHeat> surfaces_at(double time);
  std::vector<double> sources_at(double time) const;
  /// The potentials at the temperatures before a step.
  void find_potentials();
  /// A step of this length, in halves where it does not converge at once.
  bool make_given(double h, int halvings, int& iterations);
  void accept(double h, Trial& trial);
  double next_corner() const;
};

}  // namespace glisson
