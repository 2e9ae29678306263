// heat_simulation.h — temperature of a body of tetrahedra over time: conduction, blood, freezing, probes.
//
//   HeatSimulation s(mesh, {{0, ThermalTissue{}}}, {.temperature = 37.0});
//   s.hold("needle", -140.0);
//   s.advance_to(600.0);
//   s.temperature();                       °C at every vertex
//
// Linear elements with the capacity lumped at the vertices, backward Euler in time. Of two vertices of a tet
// flows w (Θ_j − Θ_i), Θ = ∫ k dT, w = −V ∇φ_i·∇φ_j: conservative, exact for linear fields of one tissue. Where w summed over the
// tets of an edge is negative, as between obtuse tets, a limiter keeps the flow from making extremes; it takes nothing of linear
// fields [KuzminShashkovSvyatskiy2009; BarrenecheaJohnKnobloch2017].
//
// The heat of a vertex is what has flowed into it; its temperature follows from that. So the balance of a step is exact to rounding,
// and latent heat is not stepped over.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glisson/archive.h"
#include "glisson/field.h"
#include "glisson/heat/heat_history.h"
#include "glisson/heat/radio_frequency.h"
#include "glisson/heat/thermal_tissue.h"
#include "glisson/mesh.h"
#include "glisson/time_function.h"

namespace glisson {

struct HeatOptions {
  double temperature = 37.0;   ///< at the start [°C]
  double step = 0.0;           ///< [s]; 0: as long as `tolerance` allows
  double first_step = 0.01;    ///< of those [s]
  double longest_step = 60.0;  ///< of those [s]
  double tolerance = 0.02;     ///< error of temperature that one step may add, mean square over the volume [K]
  std::vector<double> isotherms{0.0, -20.0, -40.0};  ///< for which the time below them is kept, place by place [°C]
  std::vector<int> hollow{};  ///< numbers of regions that are no tissue, such as vessels: insulated but for add_vessel
  int threads = 0;            ///< 0: chosen by the size of the body; the result is the same bytes on any number

  template <class Take>
  static constexpr auto fields(Take take) {
    using O = HeatOptions;
    return take(field("temperature", &O::temperature, "°C", between(-200, 200), "at the start")
                    .keyed("temperature_C")
                    .advise("temperatures are in °C, not in K"),
                field("step", &O::step, "s", at_least(0), "length of steps; 0: as long as the tolerance allows"),
                field("first_step", &O::first_step, "s", above(0), "the first of these"),
                field("longest_step", &O::longest_step, "s", above(0), "the longest of these"),
                field("tolerance", &O::tolerance, "K", above(0),
                      "error of temperature that one step may add, mean square over the volume"),
                field("isotherms", &O::isotherms, "°C", between(-200, 200),
                      "for which the time below them is kept, place by place")
                    .keyed("isotherms_C")
                    .advise("temperatures are in °C, not in K"),
                no_key("hollow", &O::hollow), no_key("threads", &O::threads, between(0, 1024)));
  }
};

/// A line that gives heat, such as the active length of a probe: a power, or c (T_s − T) of a surface at T_s. Each is a function of
/// time [s]; those that are not given do nothing.
struct LineSource {
  Vec3d from{}, to{};                       ///< at rest [m]
  TimeFunction<double> power_per_length{};  ///< [W/m], below 0: it cools
  TimeFunction<double> temperature{};       ///< of the surface, T_s [°C]; with a coefficient
  TimeFunction<double> coefficient{};       ///< c ≥ 0, of the whole circumference and what lies on it [W/(m K)]
  /// On which the heat is given, around the line [m]; 0: on the line itself. On a mesh that is coarser than it, T is that of the
  /// mesh around the line, and c one of this mesh.
  double radius = 0.0;
};

/// Where heat came from since the start [J]; what flows in counts positive.
struct HeatLedger {
  double stored = 0.0;   ///< change of the body's heat content
  double held = 0.0;     ///< through vertices whose temperature is held
  double surface = 0.0;  ///< flux, convection and walls of vessels
  double blood = 0.0;    ///< perfusion
  double metabolism = 0.0;
  double sources = 0.0;
  double removed =
      0.0;  ///< with tets that were removed, 0 where they would just begin to freeze: below 0 where they were warmer

  double imbalance() const { return stored - held - surface - blood - metabolism - sources - removed; }
};

enum class HeatStatus { ok, not_converged };

struct HeatStep {
  HeatStatus status = HeatStatus::ok;
  double step = 0.0;   ///< its length [s]
  int iterations = 0;  ///< of Newton's method
};

/// What the steps of a simulation have cost so far, those that were not taken included; no part of its state.
struct HeatWork {
  std::size_t steps = 0;              ///< tried
  std::size_t iterations = 0;         ///< of Newton's method
  std::size_t linear_iterations = 0;  ///< of conjugate gradients
  std::size_t products = 0;           ///< of the matrix with a vector
  std::size_t limiter_rounds = 0;
  // CPU time of all threads where HeatSimulation::count_time() was called [s]; products are part of the solves.
  double state_seconds = 0.0, limiter_seconds = 0.0, residual_seconds = 0.0, solve_seconds = 0.0, product_seconds = 0.0;
};

/// All that changes while a simulation runs; a value that may be kept and given back.
struct HeatState {
  double time = 0.0;  ///< [s]
  std::size_t steps = 0;
  std::vector<double> temperature;         ///< of every vertex [°C]
  std::vector<double> heat;                ///< of every vertex, 0 where it would just begin to freeze [J]
  std::vector<double> rate;                ///< of temperature in the last step [K/s]; empty: no step was made
  double step_before = 0.0, wanted = 0.0;  ///< length of the last step, and of the next as the error of that allows [s]
  HeatLedger ledger;
  double limited_share = 0.0;     ///< conduction that the limiter took away over all conduction, of the last step [-]
  HeatHistory history;            ///< what each vertex has been through
  std::vector<RadioState> radio;  ///< of each add_radio()

  void archive(Archive& ar);
};

/// Of a mesh at rest. Moving it moves its contents; a copy shares nothing.
class HeatSimulation {
 public:
  /// @param tissues  by region number; each region of the mesh has one
  /// @throws std::invalid_argument naming what is not allowed
  HeatSimulation(TetMesh mesh, std::map<int, ThermalTissue> tissues, const HeatOptions& options = {});
  HeatSimulation(HeatSimulation&&) noexcept;
  HeatSimulation& operator=(HeatSimulation&&) noexcept;
  ~HeatSimulation();

  /// Holds vertices at a temperature [°C], from now on. @param set  of the mesh
  void hold(const std::string& set, TimeFunction<double> temperature);
  void hold(std::span<const std::uint32_t> vertices, TimeFunction<double> temperature);
  /// Heat through the triangles of the surface whose corners are all in the set [W/m²], positive into the body.
  void add_flux(const std::string& set, TimeFunction<double> flux);
  /// Heat h (T_a − T) through these triangles. @param coefficient  h [W/(m² K)] @param ambient  T_a [°C]
  void add_convection(const std::string& set, double coefficient, TimeFunction<double> ambient);
  void add_convection(const std::string& set, TimeFunction<double> coefficient, TimeFunction<double> ambient);
  /// Blood through a region of HeatOptions::hollow: heat h (T_b − T) through its faces to tissue. @param coefficient  h ≥ 0 [W/(m² K)],
  /// as of wall_coefficient() (vessel_wall.h) @param blood  T_b [°C]
  void add_vessel(int region, TimeFunction<double> coefficient, TimeFunction<double> blood);
  /// Heat per volume of a region [W/m³].
  void add_source(int region, TimeFunction<double> power_per_volume);
  /// A given pattern, such as what a microwave antenna's tissue absorbs (density times SAR). @param power_per_volume  of each tet [W/m³]
  /// @param scale  what it is multiplied by, over time [-]
  void add_source(std::span<const double> power_per_volume, TimeFunction<double> scale);
  /// @throws std::invalid_argument where a part of it lies outside the body, or it gives no heat
  void add_line_source(const LineSource& source);
  /// Current between electrodes through tissues that have an electric_conductivity (radio_frequency.h). The state has its potential,
  /// voltage, power and resistance.
  void add_radio(RadioFrequency radio);

  /// Conducts from now on in the shape that a body has, as its mechanics move it; what the material contains, gets from blood and
  /// sources goes by its shape at rest. A tet that is nearly flat or inverted conducts as it did at rest.
  /// @param positions  one a vertex of mesh() [m] @throws std::invalid_argument for another number
  /// Cost: some 1 µs a tet.
  void set_positions(std::span<const Vec3d> positions);
  /// Goes on with a body that was cut or that tets were removed from: the same vertices at first, then copies. A copy has the
  /// temperature and history of its origin. Faces of a cut are insulated; the heat of tets that are gone is booked as removed. Sources
  /// give what they gave to the places that are left.
  /// @param mesh  present tets (Simulation::present_mesh) @param origins  the last vertices are copies of these
  /// @throws std::invalid_argument where the numbers do not fit; nothing is changed then
  void change_mesh(TetMesh mesh, std::span<const std::uint32_t> origins);

  /// One step, of the length that the options give; the state is as before it where it did not converge.
  HeatStep step();
  /// One step that does not go beyond a time, which lies ahead [s].
  HeatStep step_towards(double time);
  /// Steps to a time, the last one as long as is left. @param time  [s]
  HeatStep advance_to(double time);

  const HeatState& state() const;
  /// Goes on from a state of this simulation. @throws std::invalid_argument where it is of another mesh
  void load_state(HeatState state);
  /// Writes the state: bytes from which a simulation of the same mesh, tissues and options goes on with the same bytes.
  void save(std::ostream& out) const;
  /// @throws std::runtime_error for bytes that are no state of such a simulation; it then stays as it is
  void load(std::istream& in);

  double time() const;
  const TetMesh& mesh() const;
  std::span<const double> temperature() const;  ///< of every vertex [°C]
  /// Of every vertex the share that is frozen of its part of the body; moves on while a row of vertices freezes.
  /// @param region  number; none: of the whole body
  double frozen_volume(std::optional<int> region = {}) const;  ///< [m³]
  std::vector<double> frozen_share() const;                    ///< that of every vertex [-]
  /// Volume that is colder than an isotherm; temperature is linear within tets [m³].
  double volume_below(double temperature, std::optional<int> region = {}) const;
  /// Volume of the vertices' parts that have died [m³].
  double dead_volume(std::optional<int> region = {}) const;
  HeatLedger ledger() const;
  std::size_t steps() const;
  const HeatWork& work() const;
  /// From now on work() has seconds, too: some clock calls an iteration.
  void count_time();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glisson
