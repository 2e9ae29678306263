// rival.h — what `glisson compare` asks of a model of soft tissue, and what the model answers. Each model is one file of this
// folder, on the public headers alone.
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "glisson/material/tissue.h"
#include "glisson/math.h"
#include "glisson/mesh.h"
#include "glisson/pose.h"
#include "glisson/simulation/simulation.h"

namespace glisson::models {

/// Vertices that are held.
struct Support {
  std::vector<std::uint32_t> vertices;
  Axes axes;
};

/// Vertices that are moved: by a displacement, or as a rigid body whose pose is the identity at time 0.
struct Tool {
  std::vector<std::uint32_t> vertices;
  Axes axes;
  std::variant<Motion, PoseMotion> motion;
  double start = 0.0;  ///< [s]
};

/// Tets that are gone from a time on, with their stiffness; what is left of the body stays as it is.
struct Cut {
  double time = 0.0;  ///< [s]
  std::vector<std::uint32_t> tets;
};

/// One experiment on one mesh.
struct Problem {
  TetMesh mesh;
  std::map<int, Tissue> tissues;  ///< by region
  SimulationOptions motion;       ///< of it gravity, its ramp and nodal damping are what a model is given
  std::vector<Support> supports;
  std::vector<Tool> tools;
  double duration = 0.0;         ///< [s]
  std::vector<double> stations;  ///< times at which the force is read [s], ascending; the last is the duration
  /// Where it is given, moments about this point are read in the place of forces [m].
  std::optional<Vec3d> moment_about{};
  /// How long the test lasts by which models without viscosity are given the moduli of a tissue that relaxes [s]; 0: at once
  /// (relaxation.h).
  double test_time = 0.0;
  std::optional<Cut> cut{};

  double damping() const { return motion.damping_rate; }  ///< of the vertices [1/s]
  const Tissue& tissue_of(std::size_t tet) const { return tissues.at(mesh.region_of(tet)); }
  Vec3d gravity_at(double time) const {
    return time < motion.gravity_ramp ? motion.gravity * (time / motion.gravity_ramp) : motion.gravity;
  }
};

/// What a model is given to spend. A model without steps or iterations of its own ignores it.
struct Effort {
  int steps = 0;       ///< over the whole experiment
  int iterations = 0;  ///< of each step, or of the whole; of a model by modes their number
  bool operator==(const Effort&) const = default;
};

struct Answer {
  /// Of the first tool on the tissue, or without tools of the first support, at each station [N or N m]; empty where the model has
  /// none.
  std::vector<Vec3d> forces;
  std::vector<Vec3d> displacement;  ///< of every vertex at the end [m]
  double setup_s = 0.0;             ///< before the first step, by the clock [s]
  double run_s = 0.0;               ///< from the first step to the end [s]
  std::size_t bytes = 0;            ///< of the model's own arrays
  std::size_t steps = 0;            ///< that it made
  double share_done = 0.0;          ///< of the experiment, in 0 to 1: below 1 where it was stopped; 0: not known
  double cut_s = 0.0;               ///< of run_s, what the cut took [s]
  std::string trouble;              ///< why there is no answer; empty where there is one
};

/// Ends a run early where it is set.
using Stop = std::atomic<bool>;

struct Rival {
  std::string_view name;            ///< as in the table
  std::string_view what;            ///< in a few words
  std::string_view source;          ///< where it was published
  std::string_view cannot;          ///< what it cannot do at all, whatever it spends
  std::span<const Effort> efforts;  ///< that are tried, from the cheapest; one or more
  Answer (*run)(const Problem& problem, const Effort& effort, const Stop& stop);
  /// As many steps as stability asks for, whatever the effort: a stiff tissue has any number of them.
  bool explicit_steps = false;
};

/// All models, in the order of the table.
std::span<const Rival> rivals();

// Each in the file of its name.
Answer spring_mass_by_volume(const Problem& problem, const Effort& effort, const Stop& stop);
Answer spring_mass_by_length(const Problem& problem, const Effort& effort, const Stop& stop);
Answer spring_mass_with_volume(const Problem& problem, const Effort& effort, const Stop& stop);
Answer chain_mail(const Problem& problem, const Effort& effort, const Stop& stop);
Answer linear_fem(const Problem& problem, const Effort& effort, const Stop& stop);
Answer linear_fem_implicit(const Problem& problem, const Effort& effort, const Stop& stop);
Answer linear_fem_modal(const Problem& problem, const Effort& effort, const Stop& stop);
Answer hybrid(const Problem& problem, const Effort& effort, const Stop& stop);
Answer xpbd(const Problem& problem, const Effort& effort, const Stop& stop);
Answer projective_dynamics(const Problem& problem, const Effort& effort, const Stop& stop);
Answer linear_tensor_mass(const Problem& problem, const Effort& effort, const Stop& stop);
Answer schwartz_tensor_mass(const Problem& problem, const Effort& effort, const Stop& stop);
Answer green_tensor_mass(const Problem& problem, const Effort& effort, const Stop& stop);
Answer corotational(const Problem& problem, const Effort& effort, const Stop& stop);
Answer neo_hookean(const Problem& problem, const Effort& effort, const Stop& stop);
Answer own_tissue(const Problem& problem, const Effort& effort, const Stop& stop);
Answer own_tissue_at_rest(const Problem& problem, const Effort& effort, const Stop& stop);
Answer own_tissue_in_double(const Problem& problem, const Effort& effort, const Stop& stop);
Answer own_tissue_implicit(const Problem& problem, const Effort& effort, const Stop& stop);
Answer kelvin_voigt(const Problem& problem, const Effort& effort, const Stop& stop);
Answer linear_maxwell(const Problem& problem, const Effort& effort, const Stop& stop);
Answer miller_brain(const Problem& problem, const Effort& effort, const Stop& stop);
Answer pioletti_rate(const Problem& problem, const Effort& effort, const Stop& stop);
Answer pioletti_memory(const Problem& problem, const Effort& effort, const Stop& stop);

}  // namespace glisson::models
