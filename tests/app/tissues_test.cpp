// tissues_test.cpp — glisson tissues: the presets as text and JSON, and a scene that names one.
#include "app/program.h"

namespace glisson::test {
namespace {

using Tissues = ProgramTest;
using ::testing::HasSubstr;

/// A small box pressed on its top, with the tissue that is appended.
const std::string kBareScene = R"(
[mesh]
kind = "box"
cells = [2, 2, 2]
size_m = [0.02, 0.02, 0.02]
[motion]
duration_s = 0.01
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
depth_mm = 1
)";

// The list names every preset with its law, its measurement and its source, as text and as JSON alike.
TEST_F(Tissues, AreListed) {
  const Outcome text = run({"tissues"});
  ASSERT_THAT(text, Exits(0));
  const Outcome listed = run({"tissues", "--json"});
  ASSERT_THAT(listed, Exits(0));
  const nlohmann::json list = nlohmann::json::parse(listed.out);
  ASSERT_GE(list.size(), 12u);
  for (const nlohmann::json& preset : list) {
    for (const char* key : {"name", "what", "law", "fitted_to", "source"})
      EXPECT_THAT(text.out, HasSubstr(preset[key].get<std::string>())) << preset["name"];
  }
  EXPECT_THAT(run({"tissues", "--help"}).out, HasSubstr("Examples:\n  glisson tissues"));
}

// One of them is told whole, and what is printed to paste is a tissue that a scene takes.
TEST_F(Tissues, OneIsToldWhole) {
  const Outcome text = run({"tissues", "brain_miller"});
  ASSERT_THAT(text, Exits(0));
  const nlohmann::json json = nlohmann::json::parse(run({"tissues", "brain_miller", "--json"}).out);
  for (const auto& [key, value] : json.items()) {
    if (value.is_number()) continue;
    EXPECT_THAT(text.out, HasSubstr(value.get<std::string>())) << key;
  }
  EXPECT_EQ(json["density_kg_m3"], 1000);
  const std::string toml = json["toml"];
  const Outcome check = run({"check", write("pasted.toml", kBareScene + toml)});
  EXPECT_THAT(check, Exits(0));
  EXPECT_THAT(check.out, HasSubstr("\"brain_miller\": ogden: mu_Pa = [842], alpha = [-4.7]"));
}

// A name that is none ends with the exit status of a user's mistake and the nearest name.
TEST_F(Tissues, UnknownIsRefused) {
  const Outcome outcome = run({"tissues", "brain_miler"});
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, HasSubstr("there is no tissue preset \"brain_miler\"; did you mean \"brain_miller\"?"));
  EXPECT_TRUE(outcome.out.empty());
}

// A run of a scene that names a preset says so in its summary.
TEST_F(Tissues, AreNamedInTheSummary) {
  const std::string scene = write("s.toml", kBareScene + "[tissue]\npreset = \"liver_mre\"\n");
  const Outcome outcome = run({"run", scene, "--out", "o", "--quiet"});
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_EQ(read_json(folder_ / "o/main/summary.json")["tissue"], "liver_mre");
}

}  // namespace
}  // namespace glisson::test
