// simulation.cpp — the public face of a body in motion: checks what comes in, and hands on.
#include "glisson/simulation.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "dynamics/make_scheme.h"
#include "mechanics/tet_fields.h"

namespace glisson {
namespace {

constexpr int kMostThreads = 1024;

void require_implicit(const ImplicitOptions& o, const auto& check) {
  const double longest = o.largest_step.value_or(1.0);
  check(o.spectral_radius >= 0.0 && o.spectral_radius <= 1.0, "spectral_radius", o.spectral_radius, "0 to 1");
  check(longest > 0.0 && std::isfinite(longest), "largest_step [s]", longest, "> 0 and finite");
  check(o.tolerance >= 1e-13 && o.tolerance <= 1e-2, "tolerance", o.tolerance, "1e-13 to 1e-2");
  check(o.most_iterations >= 1 && o.most_iterations <= 1000, "most_iterations", o.most_iterations, "1 to 1000");
  check(o.most_cuts >= 0 && o.most_cuts <= 40, "most_cuts", o.most_cuts, "0 to 40");
}

void require_options(const SimulationOptions& o) {
  const auto check = [](bool ok, const char* name, double value, const char* range) {
    if (ok) return;
    std::ostringstream text;
    text << "simulation: " << name << " = " << value << " is outside the allowed range, " << range;
    throw std::invalid_argument(text.str());
  };
  const auto not_negative = [](double v) { return v >= 0.0 && std::isfinite(v); };
  check(not_negative(o.damping_rate), "damping_rate [1/s]", o.damping_rate, ">= 0 and finite");
  check(not_negative(o.nodal_damping), "nodal_damping [kg/s]", o.nodal_damping, ">= 0 and finite");
  check(not_negative(o.gravity_ramp), "gravity_ramp [s]", o.gravity_ramp, ">= 0 and finite");
  check(o.threads >= 0 && o.threads <= kMostThreads, "threads", o.threads, "0 (automatic) to 1024");
  require_implicit(o.implicit, check);
  check(std::isfinite(norm(o.gravity)), "|gravity| [m/s^2]", norm(o.gravity), "finite");
}

}  // namespace

struct Simulation::Impl {
  TetMesh mesh;
  std::unique_ptr<Scheme> scheme;
};

Simulation::Simulation(TetMesh mesh, std::map<int, Tissue> tissues, const SimulationOptions& options) {
  require_options(options);
  Body body = build_body(mesh, tissues);
  impl_.reset(new Impl{std::move(mesh), make_scheme(std::move(body), options)});
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

ConstraintId Simulation::fix(std::span<const std::uint32_t> vertices, Axes axes) { return drive(vertices, {}, axes); }

ConstraintId Simulation::drive(std::span<const std::uint32_t> vertices, Motion motion, Axes axes, double from) {
  return impl_->scheme->add_constraint({{vertices.begin(), vertices.end()}, axes, std::move(motion), from});
}

void Simulation::add_load(std::span<const std::uint32_t> vertices, Vec3d force, std::function<double(double)> scale) {
  impl_->scheme->add_load(vertices, force, std::move(scale));
}

RemovalReport Simulation::remove_tets(std::span<const std::uint32_t> tets) { return impl_->scheme->remove(tets); }

SplitReport Simulation::split_faces(std::span<const Triangle> faces) {
  SplitReport report = impl_->scheme->split(faces);
  TetMesh& mesh = impl_->mesh;
  const Body& body = impl_->scheme->body();
  for (std::uint32_t i = 0; i < report.origins.size(); ++i) {
    mesh.vertices.push_back(Vec3d(mesh.vertices[report.origins[i]]));
    for (auto& [name, set] : mesh.vertex_sets) {
      if (std::binary_search(set.begin(), set.end(), report.origins[i])) set.push_back(report.first_new + i);
    }
  }
  for (const std::uint32_t e : impl_->scheme->last_changed()) mesh.tets[body.mesh_tet[e]] = body.elements[e];
  return report;
}

bool Simulation::is_removed(std::uint32_t tet) const {
  const std::size_t tets = impl_->mesh.tets.size();
  if (tet < tets) return impl_->scheme->is_removed(tet);
  throw std::invalid_argument("is_removed: tet " + std::to_string(tet) + " is outside the mesh, 0 to " +
                              std::to_string(tets - 1));
}

TetMesh Simulation::present_mesh() const {
  TetMesh present = impl_->mesh;
  present.tets.clear();
  present.regions.clear();
  for (std::uint32_t t = 0; t < impl_->mesh.tets.size(); ++t) {
    if (is_removed(t)) continue;
    present.tets.push_back(impl_->mesh.tets[t]);
    if (!impl_->mesh.regions.empty()) present.regions.push_back(impl_->mesh.regions[t]);
  }
  return present;
}

StepResult Simulation::step() { return impl_->scheme->step(); }

double Simulation::time() const { return impl_->scheme->time(); }
double Simulation::step_size() const { return impl_->scheme->step_size(); }
double Simulation::stable_step() const { return impl_->scheme->stable_step(); }
std::uint64_t Simulation::steps() const { return impl_->scheme->steps(); }
const TetMesh& Simulation::mesh() const { return impl_->mesh; }
std::span<const double> Simulation::masses() const { return impl_->scheme->body().masses; }
std::span<const Vec3d> Simulation::displacement() const { return impl_->scheme->displacement(); }
std::span<const Vec3d> Simulation::velocity() const { return impl_->scheme->velocity(); }

std::vector<Vec3d> Simulation::positions() const {
  std::vector<Vec3d> x = impl_->mesh.vertices;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += displacement()[i];
  return x;
}

void Simulation::set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  impl_->scheme->set_state(displacement, velocity);
}

ForceParts Simulation::force(ConstraintId constraint) const { return impl_->scheme->force(constraint); }

double Simulation::force_time() const { return impl_->scheme->force_time(); }

const EngineInfo& Simulation::engine_info() const { return impl_->scheme->info(); }

Energies Simulation::energies() const { return impl_->scheme->energies(); }

TetFields Simulation::tet_fields() const {
  return glisson::tet_fields(impl_->scheme->body(), displacement(), velocity());
}

std::uint64_t Simulation::state_hash() const {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const std::span<const Vec3d> field : {displacement(), velocity()}) {
    for (const std::byte b : std::as_bytes(field)) hash = (hash ^ static_cast<std::uint64_t>(b)) * 1099511628211ULL;
  }
  return hash;
}

}  // namespace glisson
