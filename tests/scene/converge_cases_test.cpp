// The interval of `glisson converge` holds the exact value: over the cases of tests/scene/converge_cases, whose references are
// closed forms and elements of high order of another program (scripts/converge_references).
//
// references.csv keeps the values on three meshes too, so that the rule is judged on all cases in no time; that the engine still
// gives these values is a test of its own, per case.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "glisson/instruments/instrument.h"
#include "glisson/scene/convergence.h"
#include "glisson/scene/convergence_order.h"
#include "glisson/scene/convergence_variant.h"
#include "glisson/scene/scene.h"
#include "support/places.h"

namespace glisson {
namespace {

using Verdict = GridConvergence::Verdict;

/// A line of references.csv.
struct Case {
  std::map<std::string, std::string> text;

  double number(const std::string& column) const { return std::stod(text.at(column)); }
  double reference() const { return number("reference"); }
  std::string name() const { return text.at("scene") + "_" + text.at("variant"); }
  bool held_out() const { return text.at("half") == "held"; }
  std::array<double, 3> kept() const { return {number("mesh_1"), number("mesh_2"), number("mesh_3")}; }
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::filesystem::path folder() { return test::shipped("tests/scene/converge_cases"); }

std::vector<Case> all_cases() {
  std::ifstream file(folder() / "references.csv");
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> columns = split(line);
  std::vector<Case> cases;
  while (std::getline(file, line)) {
    Case& one = cases.emplace_back();
    const std::vector<std::string> cells = split(line);
    for (std::size_t i = 0; i < columns.size(); ++i) one.text[columns[i]] = cells.at(i);
  }
  return cases;
}

Variant variant_of(const Case& one) {
  for (Variant& v : load_scene(folder() / (one.text.at("scene") + ".toml")).variants) {
    if (v.name == one.text.at("variant")) return v;
  }
  throw std::out_of_range(one.name());
}

GridConvergence judge(const Case& one, const std::array<double, 3>& values) {
  const Variant variant = variant_of(one);
  const TetMesh mesh = build_mesh(variant, {});
  const double h = cell_size(mesh);
  const std::array<MeshResult, 3> results{{{h, values[0]}, {0.5 * h, values[1]}, {0.25 * h, values[2]}}};
  return grid_convergence(results, largest_order(variant, mesh));
}

/// Whether the interval holds the reference, to the seven digits and the error with which that is known.
bool holds(const GridConvergence& g, const Case& one) {
  const double known = (2e-7 + one.number("error")) * std::abs(one.reference());
  return g.low - known <= one.reference() && one.reference() <= g.high + known;
}

/// How often the interval holds, over cases of a kind.
struct Score {
  int cases = 0, held = 0, not_converging = 0;
  std::vector<double> widths;  // half of the interval over the error of the finest mesh

  void add(const GridConvergence& g, const Case& one) {
    ++cases;
    held += holds(g, one);
    not_converging += g.verdict == Verdict::not_monotone;
    const double error = std::abs(one.kept()[2] - one.reference());
    if (error > 1e-6 * std::abs(one.reference())) widths.push_back(0.5 * (g.high - g.low) / error);
  }
  double share() const { return static_cast<double>(held) / cases; }
  double median_width() {
    if (widths.empty()) return 0.0;
    std::nth_element(widths.begin(), widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2), widths.end());
    return widths[widths.size() / 2];
  }
};

// Of all cases the interval holds 95 %, of each kind 90 %; half of it is at most three times the error of the finest mesh, in the
// median; at most 15 % do not converge. The same holds of the cases that were not looked at when the rule was chosen.
TEST(ConvergeCases, IntervalsHoldTheReferences) {
  std::map<std::string, Score> scores;
  for (const Case& one : all_cases()) {
    const GridConvergence g = judge(one, one.kept());
    for (const char* kind : {"place", "nu", "volume", "strain"}) scores[kind + (" " + one.text.at(kind))].add(g, one);
    scores["all"].add(g, one);
    if (one.held_out()) scores["held out"].add(g, one);
    if (!holds(g, one)) {
      std::printf("%s: %.6g is not within %.6g and %.6g\n", one.name().c_str(), one.reference(), g.low, g.high);
    }
  }
  for (auto& [kind, score] : scores) {
    const double width = score.median_width(), lost = static_cast<double>(score.not_converging) / score.cases;
    std::printf("%-22s %3d cases, %5.1f %% held, half width %.2f errors, %4.1f %% not converging\n", kind.c_str(),
                score.cases, 100.0 * score.share(), width, 100.0 * lost);
    const bool whole = kind == "all" || kind == "held out";
    EXPECT_GE(score.share(), whole ? 0.95 : 0.90) << kind;
    if (!whole) continue;
    EXPECT_LE(width, 3.0) << kind;
    EXPECT_LE(lost, 0.15) << kind;
  }
  EXPECT_GE(scores["all"].cases, 100);
  EXPECT_GE(scores["held out"].cases, 50);
  for (const char* kind : {"place smooth", "place clamp", "place pad", "nu 0.45", "nu 0.49", "nu 0.499",
                           "volume element", "volume average_nodal", "strain large"}) {
    EXPECT_GE(scores[kind].cases, 10) << kind;
  }
}

/// Keeps the value of largest size of a column.
class Largest : public RunObserver {
 public:
  explicit Largest(std::string column) : column_(std::move(column)) {}

  void on_built(const BuiltVariant& built) override {
    const auto find = [&](const auto& columns, auto name) {
      const auto found =
          std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return name(c) == column_; });
      return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
    };
    probe_ = find(built.probes.columns(), [](const std::string& c) { return c; });
    if (built.instruments.empty()) return;
    own_ = find(built.instruments.front()->columns(), [](const InstrumentColumn& c) { return c.name; });
    direction_ = built.instruments.front()->direction();
  }
  void on_sample(const Sample& s) override {
    const double x = probe_ >= 0 ? s.probes[static_cast<std::size_t>(probe_)]
                     : own_ >= 0 ? s.instruments.front().values[static_cast<std::size_t>(own_)]
                                 : dot(s.instruments.front().force, direction_);
    if (std::abs(x) > std::abs(value)) value = x;
  }
  double value = 0.0;

 private:
  std::string column_;
  int probe_ = -1, own_ = -1;
  Vec3d direction_{};
};

class ConvergeCase : public ::testing::TestWithParam<Case> {};

// The engine gives the values that are kept, to the tolerance of Newton's method, and with them the interval.
TEST_P(ConvergeCase, GivesTheKeptValues) {
  const Case& one = GetParam();
  std::array<double, 3> values{};
  for (int k = 0; k < 3; ++k) {
    const RefinedVariant fine = refined_variant(variant_of(one), k, {});
    Largest largest(one.text.at("column"));
    const std::atomic<bool> stop{false};
    ASSERT_EQ(run_variant(fine.variant, fine.load, largest, stop).end, RunSummary::End::finished);
    const auto i = static_cast<std::size_t>(k);
    values[i] = largest.value;
    EXPECT_NEAR(values[i], one.kept()[i], 2e-6 * std::abs(one.kept()[i])) << "mesh " << k + 1;
  }
  EXPECT_EQ(holds(judge(one, values), one), holds(judge(one, one.kept()), one));
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) { return info.param.name(); }

/// Some of each place, of both treatments of volume and of large strain, a second or two each.
std::vector<Case> first_cases() {
  std::vector<Case> first;
  for (const Case& one : all_cases()) {
    for (const char* name : {"strip_bonded_nu049_nodal", "pad_free_nu030_element", "pad_bonded_nu045_nodal",
                             "pad_square_nu030_element", "bending_nu045_nodal", "uniform_large_nu045_element"}) {
      if (one.name() == name) first.push_back(one);
    }
  }
  return first;
}
INSTANTIATE_TEST_SUITE_P(First, ConvergeCase, ::testing::ValuesIn(first_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(All, ConvergeCase, ::testing::ValuesIn(all_cases()), name_of);  // verify

}  // namespace
}  // namespace glisson
