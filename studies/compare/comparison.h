// comparison.h — one scene given to many models: the errors of each against a converged reference, and its time.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "compare/expected_time.h"
#include "compare/models/rival.h"
#include "glisson/scene/convergence.h"
#include "glisson/scene/scene.h"

namespace glisson::app {

/// One run of one model.
struct ComparedRow {
  std::string model;
  models::Effort effort;
  std::size_t tets = 0;
  models::Answer answer;
  double error_force = -1.0;  ///< rms over the stations, over the largest force of the reference [-]; below 0: none
  double error_surface =
      -1.0;  ///< rms over the surface at the end, over the largest displacement there [-]; below 0: none
  double error_measured =
      -1.0;  ///< of the force's size, against what was measured, over its largest [-]; below 0: none

  double wall_s() const { return answer.setup_s + answer.run_s; }
};

/// The scene's own tissue on a mesh finer than those compared: in equilibrium, or where it is viscous in motion.
struct Reference {
  std::size_t tets = 0;
  std::vector<Vec3d> forces;        ///< at the stations, extrapolated to the limit of fine meshes [N or N m]
  std::vector<Vec3d> displacement;  ///< of the vertices of its mesh at the end [m]
  double extrapolated = 0.0;        ///< by how much its last force was changed for that [-]
  double low = 0.0, high = 0.0;  ///< the limit's last force is expected between these shares of it; 0 and 0: not known
  std::string words;             ///< what its meshes say of it
  std::string kind = "in equilibrium";

  /// Takes what its meshes say of the last force. @param finest  that force on the finest mesh
  /// @return by which share it is changed
  double take_limit(const GridConvergence& found, double finest);
};

struct Comparison {
  std::string title, description;
  std::string variant;   ///< label of the scene's variant; empty where there is one
  bool moments = false;  ///< forces are moments [N m]
  double target = 0.01;
  std::vector<double> stations;  ///< [s]
  std::vector<double> measured;  ///< sizes of the force at the stations [N]; empty: none
  Reference reference;
  std::vector<models::Problem> problems;  ///< a mesh each, the coarsest first
  std::vector<std::uint32_t> surface;     ///< vertices of which the surface's error is taken
  std::vector<ComparedRow> rows;

  /// Of a model's rows that keep the errors of force and surface below the target, and keep them there on finer meshes and with more steps
  /// and iterations, the one that took the shortest; null: none.
  const ComparedRow* quickest(std::string_view model) const;
};

/// The experiment of a variant on a mesh. @throws SceneError naming what other models cannot be given
models::Problem problem_of(const Variant& variant, TetMesh mesh, const CompareSpec& spec);

/// The models that a scene asks for, in the order of the table. @throws SceneError for one that is not there
std::vector<const models::Rival*> chosen_models(const Scene& scene);

/// What the explicit steps of each model that the scene asks for will take, all variants together; of viscous tissue also those of the
/// reference, by the name "reference". Models that are given their steps are left out. @throws as compare()
std::vector<ExpectedTime> expected_times(const Scene& scene, const MeshLoader& load, const std::atomic<bool>& stop);

/// Runs all models that the scene asks for, variant by variant; `say` is told of each before it runs. Where it is stopped, what is done is
/// returned.
/// @throws SceneError, std::invalid_argument for a model that is not there, a scene that cannot be compared, a reference without
///         equilibrium
std::vector<Comparison> compare(const Scene& scene, const MeshLoader& load, const std::atomic<bool>& stop,
                                const std::function<void(const std::string&)>& say);

}  // namespace glisson::app
