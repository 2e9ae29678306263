// A scene takes its tissue from a file, its own keys win, and what cannot be used is told at the key; a value written as
// TOML reads back as itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scene/parse/document.h"
#include "scene/parse/tissue_file.h"
#include "scene/scene_text.h"
#include "support/folder.h"

namespace glisson {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TissueFile : public test::InFolder {
 protected:
  void write(const std::string& text) { InFolder::write("tissue.toml", text); }
  Tissue tissue_of(const std::string& keys) {
    return parse_scene(test::kSmallScene + "[tissue]\n" + keys, "scene.toml", folder_).variants.at(0).tissue;
  }
  std::string complaint_of(const std::string& keys) {
    try {
      tissue_of(keys);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(TissueFile, GivesTheSceneItsKeys) {
  write(
      "# a fit\n[tissue]\nname = \"pig\"\nhyperelastic = { kind = \"ogden\", mu_Pa = [1500.5], alpha = [-7], "
      "bulk_modulus_Pa = 1e5 }\n");
  const Tissue t = tissue_of("file = \"tissue.toml\"\n");
  EXPECT_EQ(t.name, "pig");
  ASSERT_TRUE(t.hyperelastic);
  EXPECT_DOUBLE_EQ(t.lame().mu, 1500.5);
}

TEST_F(TissueFile, OwnKeysWin) {
  write("[tissue]\nyoungs_modulus_Pa = 5000\nlaw = { kind = \"linear\", slope_Pa = 20000 }\n");
  const Tissue t = tissue_of("file = \"tissue.toml\"\nyoungs_modulus_Pa = 7000\n");
  EXPECT_EQ(t.youngs_modulus, 7000.0);
  EXPECT_EQ(std::get<LinearLaw>(t.law).slope, 20000.0);
}

TEST_F(TissueFile, OfAVariantTakesNothingOverFromTheScene) {
  write("[tissue]\nyoungs_modulus_Pa = 5000\n");
  const Scene scene = parse_scene(
      test::kSmallScene + "[tissue]\nyoungs_modulus_Pa = 1\n[[variant]]\nname = \"a\"\ntissue.file = \"tissue.toml\"\n",
      "scene.toml", folder_);
  EXPECT_EQ(scene.variants.at(0).tissue.youngs_modulus, 5000.0);
}

TEST_F(TissueFile, MayStartFromAPreset) {
  write("[tissue]\npreset = \"paper_liver\"\nviscosity_Pa_s = 10\n");
  const Tissue t = tissue_of("file = \"tissue.toml\"\n");
  EXPECT_EQ(t.youngs_modulus, 3600.0);
  EXPECT_EQ(t.viscosity, 10.0);
}

TEST_F(TissueFile, ThatCannotBeUsedIsToldAtTheKey) {
  EXPECT_THAT(complaint_of("file = \"nowhere.toml\"\n"), HasSubstr("tissue.file: "));
  EXPECT_THAT(complaint_of("file = \"nowhere.toml\"\n"), HasSubstr("nowhere.toml: cannot be read; check the path"));
  write("youngs_modulus_Pa = 5000\n");
  EXPECT_THAT(complaint_of("file = \"tissue.toml\"\n"), HasSubstr("has no [tissue]"));
  write("[tissue\n");
  EXPECT_THAT(complaint_of("file = \"tissue.toml\"\n"), HasSubstr("not valid TOML"));
  write("[tissue]\nyoungs_modulus_Pa = -5\n");
  EXPECT_THAT(complaint_of("file = \"tissue.toml\"\n"), HasSubstr("-5 Pa is out of range"));
  EXPECT_THAT(complaint_of("file = \"tissue.toml\"\npreset = \"paper_liver\"\n"), HasSubstr("contradicts"));
}

// What is written as TOML reads back as the same value, whatever its characters and numbers are.
TEST(TomlText, ReadsBackAsItself) {
  const std::string text =
      "{ name = \"a \\\"b\\\" \\\\ \\u0001\", \"odd key\" = [1, 2.5, -1e-300], law = { kind = \"linear\", on = true } "
      "}";
  const scene::Node node = scene::parse_override_value("x", text);
  const std::string written = scene::toml_text(node);
  EXPECT_EQ(scene::toml_text(scene::parse_override_value("x", written)), written);
  EXPECT_EQ(*node.find("name")->text(), *scene::parse_override_value("x", written).find("name")->text());
  EXPECT_THAT(written, HasSubstr("\"odd key\" = [1, 2.5, -1e-300]"));
}

}  // namespace
}  // namespace glisson
