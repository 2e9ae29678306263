// advise.cpp — runs the rules in the order in which `glisson check` prints them.
#include <cmath>

#include "scene/advice/rules.h"

namespace glisson {
namespace advice {
namespace {

using enum Advice::Kind;
using About = Advice::About;

/// A rule and what it says of an instrument, or of the steps.
template <class... Of>
struct Rule {
  const char* name;
  Advice::Kind kind;
  Texts (*look)(Of...);
};
constexpr Rule<const Variant&, const InstrumentSpec&, const TetMesh&> kInstrumentRules[] = {
    {"misses", warning, misses}, {"edge", warning, edge}, {"zone", warning, zone}, {"coarse", warning, coarse}};
constexpr Rule<const StepCase&> kStepRules[] = {
    {"branches", remark, branches}, {"corners", warning, corners},  {"mass", remark, mass},
    {"limits", remark, limits},     {"viscous", remark, viscous},   {"slow", remark, slow},
    {"fast", warning, fast},        {"adaptive", remark, adaptive}, {"freezing", warning, freezing}};

/// Collects what rules say, with what they say it of.
class Collector {
 public:
  explicit Collector(std::string variant) { at_.variant = std::move(variant); }

  /// From here on it is about this.
  void turn_to(About about, std::size_t index = 0, std::string name = {}) {
    at_.about = about, at_.index = index, at_.name = std::move(name);
  }
  void add(const char* rule, Advice::Kind kind, Texts texts) {
    for (std::string& text : texts) {
      at_.rule = rule, at_.kind = kind, at_.text = std::move(text);
      all_.push_back(at_);
    }
  }
  std::vector<Advice> take() { return std::move(all_); }

 private:
  Advice at_;
  std::vector<Advice> all_;
};

void look_at_bounds(Collector& to, const Variant& v, const TetMesh& mesh) {
  const auto add = [&](const NearSelection& selection) {
    to.add("rounding", remark, rounding(selection));
    to.add("just_outside", warning, just_outside(selection));
  };
  std::size_t index = 0;
  for (const auto& [name, selection] : v.sets) {
    to.turn_to(About::set, index++, name);
    add({name, near_bounds(mesh, selection), "vertex", "vertices"});
  }
  for (std::size_t i = 0; i < v.regions.size(); ++i) {
    to.turn_to(About::region, i, v.regions[i].name);
    add({v.regions[i].name, near_bounds(mesh, v.regions[i]), "tet", "tets"});
  }
}

void look_at_tissues(Collector& to, const Variant& v) {
  to.turn_to(About::tissue, 0, v.tissue.name);
  to.add("locking", warning, locking(v.tissue, "tissue"));
  for (std::size_t i = 0; i < v.regions.size(); ++i) {
    const Tissue& own = v.regions[i].tissue;
    if (own.volume_change == v.tissue.volume_change) continue;  // its key is the body's
    to.turn_to(About::tissue, i + 1, own.name);
    to.add("locking", warning, locking(own, "its tissue"));
  }
}

void look_at_tools(Collector& to, const Variant& v, const TetMesh& mesh) {
  for (std::size_t i = 0; i < v.tools.size(); ++i) {
    to.turn_to(About::tool, i, v.tools[i].name);
    to.add("coarse", warning, coarse_pad(v, v.tools[i], mesh));
  }
  for (std::size_t i = 0; i < v.instruments.size(); ++i) {
    to.turn_to(About::instrument, i, v.instruments[i].name);
    for (const auto& rule : kInstrumentRules) to.add(rule.name, rule.kind, rule.look(v, v.instruments[i], mesh));
  }
}

/// The mesh of the scene: of a variant that starts loaded, not that at rest.
TetMesh starting_mesh(const Variant& variant, const Simulation& simulation) {
  TetMesh mesh = simulation.mesh();
  if (variant.start == Start::loaded) mesh.vertices = simulation.positions();
  return mesh;
}

/// No time for any trial.
class NoTrials : public TrialTime {
 public:
  bool has_time(double) const override { return false; }
};

std::vector<Advice> on_all(const Variant& variant, const VariantAtRest& rest, const MeshLoader& load, TrialTime& time) {
  std::vector<Advice> all = advise_on_body(variant, rest);
  for (Advice& one : advise_on_step(variant, rest, load, time)) all.push_back(std::move(one));
  return all;
}

}  // namespace
}  // namespace advice

VariantAtRest::VariantAtRest(const Variant& variant, const Simulation& simulation)
    : mesh(advice::starting_mesh(variant, simulation)), report(inspect(mesh)), step_s(simulation.step_size()),
      stable_step_s(simulation.stable_step()), scaling(simulation.mass_scaling()) {
  constexpr std::size_t kFew = 20;            // one tet in so many is what may keep the step short alone
  constexpr std::size_t kMostCorners = 1000;  // that are looked at
  const double end = run_duration(variant);
  for (double t = simulation.next_corner(0.0); t < end && corners.size() < kMostCorners; t = simulation.next_corner(t))
    corners.push_back(t);
  if (std::isfinite(end)) corners.push_back(end);
  for (const double m : simulation.masses()) mass_kg += m;
  if (variant.start == Start::loaded) {
    largest_shift = 0.0;
    for (const Vec3d& u : simulation.displacement()) largest_shift = std::max(*largest_shift, norm(u));
  }
  if (std::isfinite(stable_step_s)) limits = simulation.limiting_tets(mesh.tets.size() / kFew + 1);
}

std::vector<Advice> advise_on_body(const Variant& variant, const VariantAtRest& rest) {
  advice::Collector to(variant.name);
  to.turn_to(Advice::About::mesh);
  to.add("mesh", Advice::Kind::warning, advice::mesh_warnings(variant, rest));
  to.add("loaded", Advice::Kind::remark, advice::loaded(rest));
  advice::look_at_bounds(to, variant, rest.mesh);
  advice::look_at_tissues(to, variant);
  advice::look_at_tools(to, variant, rest.mesh);
  return to.take();
}

std::vector<Advice> advise_on_step(const Variant& variant, const VariantAtRest& rest, const MeshLoader& load,
                                   TrialTime& time) {
  advice::Collector to(variant.name);
  to.turn_to(Advice::About::step);
  const advice::StepCase step{variant, rest, load, time};
  for (const auto& rule : advice::kStepRules) to.add(rule.name, rule.kind, rule.look(step));
  return to.take();
}

std::vector<Advice> advise_on_laws(std::span<const Variant> variants) {
  advice::Collector to("");
  to.turn_to(Advice::About::scene);
  to.add("cycle_work", Advice::Kind::remark, advice::cycle_work(variants));
  return to.take();
}

std::vector<Advice> advise(const Variant& variant, const MeshLoader& load) {
  TrialTime time;
  return advice::on_all(variant, {variant, build_variant(variant, load).simulation}, load, time);
}

std::vector<Advice> advise_at_rest(const Variant& variant, const Simulation& simulation) {
  advice::NoTrials none;
  return advice::on_all(variant, {variant, simulation}, {}, none);
}

}  // namespace glisson
