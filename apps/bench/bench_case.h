// bench_case.h — what the benchmark measures: a body, a model, a number of threads.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/material/tissue.h"
#include "glisson/mesh.h"
#include "glisson/words.h"

namespace glisson::app {

/// The paper's three steps of complexity: constant stiffness, stiffness that follows the shape, and viscosity on top; then
/// the tissues of large deformation, elastic unless said.
enum class Model {
  linear,
  law,
  full,
  branches,      ///< linear, two branches
  law_branches,  ///< law, two branches
  corotational,
  green,
  green_energy,  ///< Green strain, E doubles at s = 0.5, as an energy
  fibres,        ///< Green strain and fibres
  neo_hookean,
  nodal,    ///< neo-Hookean, nodal volume changes
  maxwell,  ///< neo-Hookean, two branches
  mooney_rivlin,
  yeoh,
  fung,
  veronda_westmann,
  ogden,  ///< of two terms
  gent,
  rivlin,      ///< `invariants` with Rivlin's six terms
  invariants,  ///< with all terms: four exponentials
  following    ///< neo-Hookean, two branches whose times follow the deformation
};

}  // namespace glisson::app

namespace glisson {
template <>
inline constexpr Word<app::Model> kWords<app::Model>[] = {{"linear", app::Model::linear},
                                                          {"law", app::Model::law},
                                                          {"full", app::Model::full},
                                                          {"branches", app::Model::branches},
                                                          {"law_branches", app::Model::law_branches},
                                                          {"corotational", app::Model::corotational},
                                                          {"green", app::Model::green},
                                                          {"green_energy", app::Model::green_energy},
                                                          {"fibres", app::Model::fibres},
                                                          {"neo_hookean", app::Model::neo_hookean},
                                                          {"nodal", app::Model::nodal},
                                                          {"maxwell", app::Model::maxwell},
                                                          {"mooney_rivlin", app::Model::mooney_rivlin},
                                                          {"yeoh", app::Model::yeoh},
                                                          {"fung", app::Model::fung},
                                                          {"veronda_westmann", app::Model::veronda_westmann},
                                                          {"ogden", app::Model::ogden},
                                                          {"gent", app::Model::gent},
                                                          {"rivlin", app::Model::rivlin},
                                                          {"invariants", app::Model::invariants},
                                                          {"following", app::Model::following}};
}  // namespace glisson

namespace glisson::app {

/// E = 3.6 kPa, ν = 0.4, or the same μ and κ; `law`: E doubles at s = 0.5; `full`: and η = 10 Pa·s, shear tensor.
Tissue model_tissue(Model model);

/// A mesh and the smooth state every repetition starts from.
struct BenchBody {
  std::string name;
  TetMesh mesh;
  std::vector<Vec3d> displacement, velocity;  ///< [m], [m/s]
};

/// What is measured where no `--sizes` are given: about that many tets, a box of cubes each.
std::vector<std::size_t> usual_sizes();
/// A box of about so many tets, ≥ 6: of six times a whole number of cubes.
BenchBody box_body(std::size_t size);
BenchBody file_body(std::string name, TetMesh mesh);

/// One measurement. `accounting`: energies are kept, which the rows of the table do without.
struct BenchCase {
  Model model = Model::full;
  int threads = 1;
  bool accounting = false;
};

}  // namespace glisson::app
