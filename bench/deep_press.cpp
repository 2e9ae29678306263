// deep_press.cpp — a liver pressed by 60 % of its height under each law: the table of docs/integrators.md.
//
//   deep_press liver.vtu [integrator=central_difference] [law …]
//
// The lowest 20 mm are held, the vertices of the highest 20 mm driven down by 60 % of the height within a second and held there
// for a tenth of one. Single precision, automatic steps, energies kept.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <limits>
#include <string>
#include <vector>

#include "glisson/instruments/motion.h"
#include "glisson/io.h"
#include "glisson/simulation/simulation.h"

namespace {

using namespace glisson;

constexpr double kShare = 0.6, kDepth = 0.02;  ///< of the height; of what is held and driven [m]
constexpr double kPress = 1.0, kHold = 0.1;    ///< [s]

struct Law {
  const char* name;
  Tissue tissue;
};

/// Laws of the small-strain moduli E = 18388 Pa, ν = 0.4 (scenes/organs/liver.toml).
std::vector<Law> laws() {
  Tissue liver;
  liver.youngs_modulus = 18388.0, liver.poisson_ratio = 0.4, liver.density = 1060.0;
  const double mu = liver.lame().mu, kappa = liver.lame().lambda + 2.0 / 3.0 * mu;
  std::vector<Law> all;
  const auto add = [&](const char* name, auto change) {
    all.push_back({name, liver});
    change(all.back().tissue);
  };
  const auto hyperelastic = [&](const char* name, const HyperelasticLaw& law) {
    add(name, [&](Tissue& t) { t.hyperelastic = law; });
  };
  add("small", [](Tissue&) {});
  add("corotational", [](Tissue& t) { t.kinematics = Kinematics::corotational; });
  add("green", [](Tissue& t) { t.kinematics = Kinematics::green; });
  hyperelastic("neo_hookean", NeoHookean{.mu = mu, .bulk_modulus = kappa});
  hyperelastic("mooney_rivlin", MooneyRivlin{.c10 = 0.35 * mu, .c01 = 0.15 * mu, .bulk_modulus = kappa});
  hyperelastic("yeoh", Yeoh{.c1 = 0.5 * mu, .c2 = 0.25 * mu, .c3 = 0.25 * mu, .bulk_modulus = kappa});
  hyperelastic("veronda_westmann", VerondaWestmann{.c = 0.5 * mu, .b = 2.0, .bulk_modulus = kappa});
  hyperelastic("fung", Fung{.mu = mu, .b = 3.0, .bulk_modulus = kappa});
  hyperelastic("ogden", Ogden{.mu = {mu}, .alpha = {-4.7}, .bulk_modulus = kappa});
  return all;
}

/// What a run was like.
struct Run {
  StepStatus status = StepStatus::ok;
  std::string message;
  double time = 0.0, shortest = std::numeric_limits<double>::infinity();  ///< [s]
  std::size_t inverted = 0;                                               ///< tets, at most
  double imbalance = 0.0;                                                 ///< of the energies, over the tool's work
  double seconds = 0.0;                                                   ///< of one processor
  std::uint64_t steps = 0;
};

std::vector<std::uint32_t> within(const TetMesh& mesh, double low, double high) {
  std::vector<std::uint32_t> set;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    if (mesh.vertices[i].z >= low && mesh.vertices[i].z <= high) set.push_back(i);
  }
  return set;
}

Run press_down(const TetMesh& mesh, const Tissue& tissue, Integrator integrator) {
  const auto [low, high] = std::minmax_element(mesh.vertices.begin(), mesh.vertices.end(),
                                               [](const Vec3d& a, const Vec3d& b) { return a.z < b.z; });
  const double bottom = low->z, top = high->z, depth = kShare * (top - bottom);
  SimulationOptions o;
  o.integrator = integrator;
  o.damping_rate = 20.0;
  o.threads = 1;
  Simulation s(mesh, {{0, tissue}}, o);
  s.fix(within(mesh, bottom, bottom + kDepth));
  s.drive(within(mesh, top - kDepth, top), press({.velocity = depth / kPress, .depth = depth, .hold = kHold}));
  Run run;
  const std::clock_t begin = std::clock();
  while (s.time() < kPress + kHold && run.status <= StepStatus::inverted) {
    const double before = s.time();
    const StepResult r = s.step();
    run.status = r.status, run.message = r.message;
    if (r.status > StepStatus::inverted) break;
    run.shortest = std::min(run.shortest, s.time() - before);
    run.inverted = std::max(run.inverted, r.inverted_tets.size());
  }
  run.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  run.time = s.time(), run.steps = s.steps();
  run.imbalance = std::abs(s.energies().imbalance()) / s.energies().work_tools;
  return run;
}

void show(const char* name, const Run& run) {
  const bool ended = run.status <= StepStatus::inverted;
  std::printf("| %s | %llu | %.2g ms | %zu | %.1e | %.1f | %s |\n", name, static_cast<unsigned long long>(run.steps),
              1e3 * run.shortest, run.inverted, run.imbalance, run.seconds,
              ended ? "yes" : (std::to_string(run.time) + " s: " + run.message).c_str());
  std::fflush(stdout);
}

Integrator integrator_of(const std::string& word) {
  for (const Word<Integrator>& w : kWords<Integrator>) {
    if (word == w.word) return w.value;
  }
  throw std::invalid_argument("integrator=" + word + " is none; `glisson schema` lists them at [motion]");
}

void run(int argc, char** argv) {
  TetMesh mesh = read_mesh(argv[1]).mesh;
  mesh.regions.clear();
  Integrator integrator = Integrator::central_difference;
  std::vector<std::string> chosen;
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("integrator=", 0) == 0) {
      integrator = integrator_of(word.substr(std::strlen("integrator=")));
    } else {
      chosen.push_back(word);
    }
  }
  std::printf(
      "| law | steps | shortest step | tets inside out | imbalance | processor [s] | ended "
      "|\n|---|---|---|---|---|---|---|\n");
  for (const Law& law : laws()) {
    if (!chosen.empty() && std::find(chosen.begin(), chosen.end(), law.name) == chosen.end()) continue;
    show(law.name, press_down(mesh, law.tissue, integrator));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "deep_press: name the liver's mesh, and laws if not all are meant\n");
    return 1;
  }
  try {
    run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "deep_press: %s\n", error.what());
    return 1;
  }
  return 0;
}
