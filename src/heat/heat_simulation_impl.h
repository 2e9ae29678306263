// heat_simulation_impl.h — what a HeatSimulation consists of.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
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
  /// Where heat goes in: a set of the surface, a region or the wall of a vessel, a line; a pattern of tets is bound to the mesh.
  struct Pattern {};
  using Place = std::variant<std::string, int, LineSource, Pattern>;
  struct TimedSurface {
    Place place;
    heat::SurfaceHeat heat;
    TimeFunction<double> value;
    TimeFunction<double> coefficient{};  // none: that of `heat`
  };
  /// Power by vertex where a function of time is 1.
  struct Source {
    Place place;
    std::vector<std::pair<std::uint32_t, double>> shares;
    TimeFunction<double> power;
  };

  TetMesh mesh_;
  std::map<int, ThermalTissue> tissues_;
  HeatOptions options_;
  std::vector<Vec3d> positions_;  // where vertices are [m]; empty: at rest
  heat::HeatBody body_;
  std::optional<heat::HeatStepper> stepper_;
  std::optional<heat::HistoryKeeper> history_;
  std::vector<Held> holds_;
  std::vector<TimedSurface> surfaces_;
  std::vector<Source> sources_;
  std::vector<heat::JouleHeat> radio_;

  HeatState now_;
  std::vector<char> held_;

  void hold(std::span<const std::uint32_t> vertices, TimeFunction<double> temperature);
  heat::SurfaceHeat surface_of(const std::string& set) const;
  heat::SurfaceHeat wall_of(int region) const;
  std::map<std::uint32_t, double> shares_of_region(int region) const;
  void add_convection(heat::SurfaceHeat surface, Place place, TimeFunction<double> coefficient,
                      TimeFunction<double> ambient);
  void add_radio(RadioFrequency radio);
  bool is_hollow(int region) const;
  void add_line(const LineSource& source);
  /// @param whole  whether it has to lie in the body as a whole
  std::map<std::uint32_t, double> shares_of_line(const LineSource& source, bool whole = true) const;
  void set_positions(std::span<const Vec3d> positions);
  void change_mesh(TetMesh mesh, std::span<const std::uint32_t> origins);
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
  void rebuild();
  void place_surfaces();
  void place_sources();
  void require_changeable() const;
};

}  // namespace glisson
