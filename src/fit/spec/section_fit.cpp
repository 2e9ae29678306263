#include "fit/spec/section_fit.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "fit/data/section_data.h"
#include "fit/forward/section_forward.h"
#include "fit/spec/fit_spec.h"
#include "scene/parse/section.h"

namespace glisson::fit {
namespace {

using scene::Node;
using scene::Place;
using scene::Section;
using scene::SectionSpec;
using scene::ValueType;

scene::KeySpec bare_table(std::string name, std::string help, std::string otherwise) {
  return {
      .name = std::move(name), .help = std::move(help), .type = ValueType::table, .default_text = std::move(otherwise)};
}

void check_bounds(ParameterSpec& p, const Node& table, const Place& place) {
  p.origin = place.text();
  if (!(p.low < p.high)) {
    place.complain(*table.find("high"), "high",
                   scene::show(p.high) + " is not above `low` = " + scene::show(p.low) + "; the parameter has no room");
  }
  if (p.scale == Scale::logarithmic && !(p.low > 0.0)) {
    place.complain(*table.find("low"), "low",
                   scene::show(p.low) +
                       " is out of range; allowed: > 0 on a logarithmic scale; set scale = \"linear\" for numbers of "
                       "either sign");
  }
  if (p.start && (*p.start < p.low || *p.start > p.high)) {
    place.complain(*table.find("start"), "start",
                   scene::show(*p.start) + " is out of range; allowed: " + scene::show(p.low) + " to " +
                       scene::show(p.high) + ", the bounds");
  }
  if (p.name.empty()) p.name = p.key;
}

void check_parameters(const std::vector<ParameterSpec>& list, const Node& table, const Place& place) {
  const Node* nodes = table.find("parameter");
  std::set<std::string> keys, names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Node& own = (*nodes->array())[i];
    const Place here = place.inside("parameter." + std::to_string(i), own.where);
    if (!keys.insert(list[i].key).second) here.complain("the key \"" + list[i].key + "\" is free twice; give it once");
    if (!names.insert(list[i].name).second)
      here.complain("two parameters are called \"" + list[i].name + "\"; give one another `name`");
  }
  if (list.empty()) place.complain("nothing is free; give one or more [[parameter]] with key, low and high");
}

/// Friction is a number of [specimen] and of a parameter, and asks for a forward model of its own.
void check_faces(const FitSpec& fit, const Place& place) {
  const bool rubs =
      fit.specimen && fit.specimen->shape == SpecimenShape::cylinder && fit.specimen->faces == lab::Faces::friction;
  const auto frees = [](const ParameterSpec& p) { return is_plate_key(p.key); };
  const auto any = [&](const auto& list) { return std::any_of(list.begin(), list.end(), frees); };
  const bool freed = any(fit.parameters) ||
                     std::any_of(fit.laws.begin(), fit.laws.end(), [&](const LawSpec& l) { return any(l.parameters); });
  if (freed && !rubs) place.complain("parameters `specimen.…` need a cylinder with faces = \"friction\" in [specimen]");
  if (!fit.specimen) return;
  if (rubs && !freed && !(fit.specimen->grip.friction > 0.0 || fit.specimen->grip.adhesion > 0.0))
    place.complain(
        "[specimen] faces = \"friction\" needs `friction` or `adhesion_Pa` above 0, or a "
        "[[parameter]] with the key `specimen.friction` or `specimen.adhesion_Pa`");
  if (layer_of(*fit.specimen) && fit.forward.kind != ForwardKind::automatic)
    place.complain("[forward] kind does not apply to a layer; remove it");
  if (plates_of(*fit.specimen) && fit.forward.kind != ForwardKind::automatic)
    place.complain("[forward] kind applies to smooth faces; remove it, or set faces = \"smooth\" in [specimen]");
}

/// An indenter presses a layer, and nothing else does.
void check_layer(const FitSpec& fit, const DataSpec& data, const Node& own, const Place& here) {
  if (!fit.specimen) return;
  const bool layer = layer_of(*fit.specimen).has_value();
  const char* key = own.find("test") ? "test" : "files";
  if (data.indents() && !layer) here.complain(*own.find(key), key, "indentation needs [specimen] kind = \"layer\"");
  if (!data.indents() && layer)
    here.complain(*own.find(key), key,
                  "test = \"" + std::string(word_of(data.test)) +
                      "\" is not made on a layer, which is pressed by an indenter; give test = \"indentation\", or "
                      "[specimen] kind = \"cylinder\", \"block\" or \"point\"");
}

/// What plates that the faces cling to cannot do. @return what is wrong and the way out; empty: nothing
std::string fault_of_plates(const DataSpec& data, lab::Faces faces) {
  const auto how = data.deforming.value_or(data.test == LabTest::tension ? Deforming::tension : Deforming::compression);
  const bool two_axes = data.test == LabTest::equibiaxial || data.test == LabTest::planar ||
                        how == Deforming::equibiaxial || how == Deforming::planar;
  if (two_axes) return "is not made between plates; set faces = \"smooth\" in [specimen]";
  if (faces != lab::Faces::friction) return {};
  if (how == Deforming::tension)
    return "pulls, and plates pull only what is glued to them; set faces = \"bonded\" in [specimen]";
  if (data.test == LabTest::cyclic && how == Deforming::compression)
    return "goes back, and friction is that of a compression that goes on; give test = \"compression\" with "
           "cycle.part = \"loading\", or set faces = \"bonded\" or \"smooth\" in [specimen]";
  return {};
}

/// Tests that a scene, a specimen that sticks, or a point cannot make.
void check_tests(const FitSpec& fit, const Node& table, const Place& place) {
  const std::optional<Plates> plates = fit.specimen ? plates_of(*fit.specimen) : std::nullopt;
  const bool round = fit.specimen && fit.specimen->shape == SpecimenShape::cylinder;
  for (std::size_t i = 0; i < fit.data.size(); ++i) {
    const DataSpec& data = fit.data[i];
    const Node& own = (*table.find("data")->array())[i];
    const Place here = place.inside("data." + std::to_string(i), own.where);
    if (data.is_heat() != fit.is_heat())
      here.complain("tests of heat and of mechanics are fitted apart; give each a FIT.toml of its own");
    if (data.is_heat()) {
      if (fit.scene.empty()) here.complain(*own.find("test"), "test", "test = \"heat\" needs a `scene` with [heat]");
      continue;
    }
    check_layer(fit, data, own, here);
    if (data.test == LabTest::compression) continue;
    const std::string test = "test = \"" + std::string(word_of(data.test)) + "\" ";
    const std::string fault = plates ? fault_of_plates(data, plates->faces) : std::string{};
    if (!fit.specimen)
      here.complain(*own.find("test"), "test",
                    test + "needs a [specimen]; a scene is driven by its tool, which is \"compression\"");
    else if (!fault.empty())
      here.complain(*own.find("test"), "test", test + fault);
    const bool twisted = data.test == LabTest::torsion || data.deforming == Deforming::torsion;
    if (fit.specimen && twisted && !round)
      here.complain(*own.find("test"), "test", "torsion needs [specimen] kind = \"cylinder\"");
  }
}

/// What of [forward] goes by tools and laws of the mechanics.
void check_heat(const FitSpec& fit, const Place& place) {
  const ForwardSpec& f = fit.forward;
  const bool mechanics =
      f.kind == ForwardKind::uniaxial || f.integrator || !f.tool.empty() || !f.force.empty() || f.approach > 0.0;
  if (fit.is_heat() && mechanics)
    place.complain(
        "[forward] of a fit of heat has kind = \"auto\" or \"scene\", `tolerance` and `points` alone; remove the rest");
}

/// One needle, one curve, and nothing else that is free.
void check_insertion(const FitSpec& fit, const Place& place) {
  if (!fit.insertion) return;
  if (fit.scene.empty()) place.complain("[insertion] needs a `scene` with a needle");
  if (!fit.parameters.empty() || !fit.laws.empty())
    place.complain("[insertion] fits membranes alone; remove [[parameter]] and [[law]], or fit these first without it");
  if (fit.data.size() != 1 || fit.data.front().files.size() != 1)
    place.complain("[insertion] needs one curve: one [[data]] with one file");
}

void finish_fit(FitSpec& fit, const Node& table, const Place& place) {
  if (const Node* set = table.find("set")) {
    const std::vector<Override> more = overrides_of(*set, "");
    fit.set.insert(fit.set.end(), more.begin(), more.end());
  }
  if (const Node* tissue = table.find("tissue")) fit.set.push_back({"tissue", scene::toml_text(*tissue)});
  if (!fit.parameters.empty()) check_parameters(fit.parameters, table, place);
  check_faces(fit, place);
  check_tests(fit, table, place);
  check_insertion(fit, place);
  check_heat(fit, place);
  if (fit.data.empty()) place.complain("there are no curves; give one or more [[data]] with `files`");
  const bool any_fitted = std::any_of(fit.data.begin(), fit.data.end(), [](const DataSpec& d) { return !d.held_out; });
  if (!fit.data.empty() && !any_fitted)
    place.complain("all curves are held out; give one or more [[data]] with use = \"fit\"");
}

}  // namespace

std::vector<Override> overrides_of(const Node& table, const std::string& prefix) {
  std::vector<Override> list;
  for (const scene::Member& m : *table.table()) {
    // a key in quotes may itself be dotted: "tissue.density_kg_m3" = 1000
    list.push_back({scene::join_path(prefix, m.key), scene::toml_text(m.value)});
  }
  return list;
}

const SectionSpec& parameter_section() {
  static const SectionSpec section = [] {
    Section<ParameterSpec> s("parameter", "A number of the scene that the fit varies.");
    s.key("key", &ParameterSpec::key,
          "the scene's key, as for `--set`; append `[i]` for an element of a list of numbers")
        .must();
    s.key("name", &ParameterSpec::name, "its name in tables").otherwise("the key");
    s.key("low", &ParameterSpec::low, "lower bound, in the key's unit").must();
    s.key("high", &ParameterSpec::high, "upper bound").must();
    s.key("start", &ParameterSpec::start, "value of the first start").otherwise("the middle of the bounds");
    s.key("scale", &ParameterSpec::scale, "how the range between the bounds is divided");
    s.finish(check_bounds);
    return s.spec();
  }();
  return section;
}

const SectionSpec& search_section() {
  static const SectionSpec section = [] {
    Section<SearchSpec> s("search", "Search for the optimum.");
    s.key("starts", &SearchSpec::starts, "largest number of descents").within(between(1, 10000));
    s.key("found_again", &SearchSpec::found_again,
          "ends when the best optimum has been found this many times; 0: all starts are made")
        .within(between(0, 10000));
    s.key("screen", &SearchSpec::screen, "points screened for each start; the best becomes the start")
        .within(between(1, 1000));
    s.key("most_iterations", &SearchSpec::most_iterations, "largest number of steps of a descent")
        .within(between(1, 10000));
    s.key("seed", &SearchSpec::seed, "seed of the quasi-random starts");
    s.choice<Weighing>("weighing", &SearchSpec::weighing,
                       {{"auto", Weighing::automatic, "common for tests of one kind, else peak"},
                        {"common", Weighing::common, "all points have equal weight, in newtons"},
                        {"noise", Weighing::noise, "each curve by its own noise"},
                        {"peak", Weighing::peak, "each curve by its own largest force"}},
                       "relative weight of the curves");
    s.choice<LossKind>(
        "loss", [](SearchSpec & x) -> auto& { return x.loss.kind; },
        {{"squares", LossKind::squares, "least squares"},
         {"huber", LossKind::huber, "linear for large residuals"},
         {"soft_l1", LossKind::soft_l1, "smoothly linear for large residuals"},
         {"cauchy", LossKind::cauchy, "outliers have little weight"}},
        "cost of a residual");
    s.key(
         "loss_scale", [](SearchSpec & x) -> auto& { return x.loss.scale; },
         "residual beyond which the weight falls, in standard deviations of the noise")
        .in("-")
        .within(above(0));
    return s.spec();
  }();
  return section;
}

const SectionSpec& proof_section() {
  static const SectionSpec section = [] {
    Section<ProofSpec> s("proof", "Uncertainty of the fit.");
    s.key("profiles", &ProofSpec::profiles, "profile likelihood of every parameter");
    s.key("bootstrap", &ProofSpec::bootstrap, "fits to resampled curves; 0: none").within(between(0, 100000));
    s.key("next", &ProofSpec::next, "searches for the most informative next test");
    s.key<scene::OptionalMilli>("displacement_mm", &ProofSpec::displacement,
                                "errors of held-out curves are also reported up to here")
        .in("mm")
        .within(above(0))
        .otherwise("all");
    return s.spec();
  }();
  return section;
}

const SectionSpec& fit_law_section() {
  static const SectionSpec section = [] {
    Section<LawSpec> s("law", "A law to compare with others: the keys it sets in the scene, and its own parameters.");
    s.key("name", &LawSpec::name, "name in tables").must();
    s.bare(bare_table("set", "keys of the scene and their values", "none"));
    s.tables("parameter", parameter_section(), &LawSpec::parameters, "its free parameters").must();
    s.finish([](LawSpec& law, const Node& table, const Place& place) {
      if (const Node* set = table.find("set")) law.set = overrides_of(*set, "");
      check_parameters(law.parameters, table, place);
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& experiment_section() {
  static const SectionSpec section = [] {
    Section<ExperimentSpec> s(
        "experiment", "A candidate for the next test; the fit reports how much it would narrow the parameters.");
    s.key("name", &ExperimentSpec::name, "name in tables").otherwise("its velocity and depth");
    s.key<scene::Milli>("velocity_mm_s", &ExperimentSpec::velocity, "speed").in("mm/s").within(above(0)).must();
    s.key<scene::Milli>("depth_mm", &ExperimentSpec::depth, "depth").in("mm").within(above(0)).must();
    s.key("hold_s", &ExperimentSpec::hold, "rest at depth, the force recorded")
        .in("s")
        .within(above(0))
        .otherwise("none");
    s.finish([](ExperimentSpec& e, const Node&, const Place&) {
      if (!e.name.empty()) return;
      e.name = scene::show(1e3 * e.velocity) + " mm/s to " + scene::show(1e3 * e.depth) + " mm";
      if (e.hold) e.name += ", held " + scene::show(*e.hold) + " s";
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& fit_section() {
  static const SectionSpec section = [] {
    Section<FitSpec> s("", "Keys before any heading.");
    s.key("title", &FitSpec::title, "heading of the report").otherwise("the file's name");
    s.key("description", &FitSpec::description, "what was measured, in a few sentences");
    s.key("notes", &FitSpec::notes, "choices made, and the reasons").otherwise("[]");
    s.key("scene", &FitSpec::scene, "the scene that simulates the test, relative to this file");
    s.key("variant", &FitSpec::variant, "variant of the scene").otherwise("the only one");
    s.table(
         "specimen", specimen_section(), [](FitSpec & f) -> auto& { return f.specimen.emplace(); },
         "a plain specimen between plates, in place of a scene")
        .otherwise("none");
    s.bare(bare_table("tissue", "of the specimen: keys as in a scene's `[tissue]`", "none"));
    s.bare(bare_table("set", "keys of the scene and their values, as `--set` takes them", "none"));
    s.tables("parameter", parameter_section(), &FitSpec::parameters, "free parameters");
    s.tables("data", data_section(), &FitSpec::data, "the measured curves").must();
    s.table("forward", forward_section(), &FitSpec::forward, "how the test is simulated").otherwise("auto");
    s.table("search", search_section(), &FitSpec::search, "search for the optimum").otherwise("20 starts");
    s.table("proof", proof_section(), &FitSpec::proof, "uncertainty of the fit").otherwise("profiles and bootstrap");
    s.table(
         "insertion", insertion_section(), [](FitSpec & f) -> auto& { return f.insertion.emplace(); },
         "inner membranes of a needle, in place of parameters")
        .otherwise("none");
    s.tables("law", fit_law_section(), &FitSpec::laws, "laws to compare");
    s.tables("experiment", experiment_section(), &FitSpec::experiments, "candidates for the next test");
    s.spec().exclusions = {{{{"scene"}, {"specimen"}}, true}};
    s.finish(finish_fit);
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::fit
