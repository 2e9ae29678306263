// reference_test.cpp — docs/scene.md is the schema, and what it shows works.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <type_traits>

#include "scene/describe/reference_text.h"
#include "scene/parse/sections.h"
#include "scene/scene_text.h"
#include "support/places.h"

namespace glisson {
namespace {

std::string file_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// The committed reference is the one the program writes.
TEST(Reference, IsUpToDate) {
  EXPECT_EQ(file_text(test::shipped("docs/scene.md")), scene_reference_markdown())
      << "docs/scene.md differs from the schema; write it again with: glisson schema > docs/scene.md";
}

void expect_documented(const scene::SectionSpec& section, const std::string& text) {
  for (const scene::KeySpec& key : section.keys) {
    EXPECT_NE(text.find("| `" + key.name + "` |"), std::string::npos) << section.name << "." << key.name;
    EXPECT_FALSE(key.help.empty()) << section.name << "." << key.name;
    for (const scene::AllowedWord& w : key.words)
      EXPECT_NE(text.find("`\"" + w.word + "\"`"), std::string::npos) << key.name << " " << w.word;
    if (key.section) expect_documented(*key.section, text);
  }
  for (const scene::KindSpec& kind : section.kinds) {
    EXPECT_NE(text.find("`kind = \"" + kind.section.name + "\"`"), std::string::npos) << kind.section.name;
    expect_documented(kind.section, text);
  }
}

// Every key, kind and word of the schema is in the reference, with a meaning.
TEST(Reference, HasEveryKey) {
  expect_documented(scene::scene_section(), scene_reference_markdown());
  expect_documented(scene::variant_section(), scene_reference_markdown());
}

void expect_units(const scene::SectionSpec& section, bool parent_has_unit) {
  for (const scene::KeySpec& key : section.keys) {
    const bool suffix = key.name.find('_') != std::string::npos;
    const bool pure = key.unit.empty() || key.unit == "-";
    EXPECT_TRUE(pure || suffix || parent_has_unit)
        << section.name << "." << key.name << " [" << key.unit << "] does not name its unit";
    if (key.section) expect_units(*key.section, key.name.ends_with("_m"));
  }
  for (const scene::KindSpec& kind : section.kinds) expect_units(kind.section, false);
}

// A key with a unit ends in it, or the key of its table does.
TEST(Reference, KeysNameTheirUnits) { expect_units(scene::variant_section(), false); }

template <class... Laws>
void expect_laws(std::type_identity<std::variant<Laws...>>, const std::string& text) {
  for (const std::string_view formula : {Laws::kHelp...}) EXPECT_NE(text.find(formula), std::string::npos) << formula;
}

// Every law's formula is in the reference.
TEST(Reference, HasTheFormulaOfEveryLaw) {
  expect_laws(std::type_identity<StiffnessLaw>{}, scene_reference_markdown());
}

// The complete example of the reference is a sound scene of three variants.
TEST(Reference, ExampleParses) {
  const Scene scene = test::parse(std::string(scene::kReferenceExample));
  ASSERT_EQ(scene.variants.size(), 3u);
  EXPECT_EQ(law_name(scene.variants[1].tissue.law), "step");
  EXPECT_EQ(scene.charts.size(), 1u);
}

// The snippets on variants and overrides do what is said of them.
TEST(Reference, SnippetsParse) {
  const std::string text(scene::kReferenceVariants);
  const std::size_t begin = text.find('\n', text.find("```toml")) + 1;
  const std::string snippet = text.substr(begin, text.find("```", begin) - begin);
  const Scene scene = test::parse(test::kSmallScene + snippet, {{"tissue.density_kg_m3", "1060"},
                                                                {"tissue.law.kind", "linear"},
                                                                {"tissue.law.slope_Pa", "2e4"},
                                                                {"variant.slow.motion.precision", "double"}});
  EXPECT_EQ(scene.variants.at(0).tools.at(0).motion.velocity, 0.002);
  EXPECT_EQ(scene.variants[0].simulation.precision, Precision::double_precision);
  EXPECT_EQ(scene.variants.at(1).simulation.precision, Precision::single_precision);
  EXPECT_EQ(law_name(scene.variants[1].tissue.law), "linear");
}

}  // namespace
}  // namespace glisson
