// [[data]] of FIT.toml says how files become curves: the same test written with other units, marks and columns gives the
// same curve, and whatever is wrong with section or files is told with place, value and way out.
#include "fit/data/section_data.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <sstream>

#include "fit/phantom.h"
#include "scene/describe/reference_sections.h"
#include "scene/parse/problems.h"

namespace glisson::fit {
namespace {

using phantom::Folder;
using phantom::have_phantoms;
using phantom::kPhantoms;
using phantom::kPhantomSize;
using phantom::text_of;
using testing::AllOf;
using testing::HasSubstr;

/// The first [[data]] of a FIT.toml.
DataSpec section(const std::string& text) {
  const scene::Node root = scene::parse_document("[[data]]\n" + text, "FIT.toml");
  scene::Problems problems("FIT.toml");
  DataSpec spec;
  const scene::Node& data = root.find("data")->array()->front();
  scene::read_section(data_section(), data, &spec, {problems, "data.0", data.where});
  problems.throw_if_any();
  return spec;
}

std::string section_fault(const std::string& text) {
  try {
    section(text);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

TEST(DataSection, FillsEveryKey) {
  const DataSpec d = section(R"(name = "slow"
batch = "B"
files = ["a.csv", "b.csv"]
use = "test"
weight = 2
columns.time = { number = 1, unit = "ms" }
columns.strain = { name = "Strain", unit = "%", sign = "negative" }
columns.stress = { name = "Stress" }
text = { separator = "tab", decimal = ",", names_line = 3 }
speed_mm_s = 2
area_mm2 = 100
height_mm = 30
skip_bad_rows = true
unlikely = true
contact = { kind = "detect", threshold_sd = 5, zero_force = false }
cycle = { part = "loading", number = 2, least = 0.2 }
crop = { max_strain = 0.5, min_displacement_mm = 1, max_force_N = 3, until = "drop", drop = 0.3 }
filter = { kind = "savitzky_golay", half_width = 4, degree = 2 }
resample = { over = "displacement", how = "pick", points = 50 }
)");
  EXPECT_EQ(d.group, "slow");
  EXPECT_EQ(d.batch, "B");
  EXPECT_EQ(d.files.size(), 2u);
  EXPECT_TRUE(d.held_out && d.skip_bad_rows && d.unlikely);
  EXPECT_EQ(d.weight, 2.0);
  EXPECT_TRUE(d.columns.time.given && d.columns.strain.given && d.columns.stress.given);
  EXPECT_FALSE(d.columns.force.given);
  EXPECT_EQ(d.columns.time.number, 1);
  EXPECT_EQ(d.columns.strain.sign, Sign::negative);
  EXPECT_EQ(d.text.separator, '\t');
  EXPECT_EQ(d.text.decimal, ',');
  EXPECT_EQ(d.text.names_line, 3u);
  EXPECT_DOUBLE_EQ(*d.speed, 2e-3);
  EXPECT_DOUBLE_EQ(*d.size.area, 1e-4);
  EXPECT_DOUBLE_EQ(*d.size.height, 0.03);
  EXPECT_EQ(d.contact.kind, ContactKind::detect);
  EXPECT_FALSE(d.contact.zero_force);
  EXPECT_EQ(d.cycle.part, CyclePart::loading);
  EXPECT_DOUBLE_EQ(*d.crop.min_displacement, 1e-3);
  EXPECT_EQ(d.crop.until, CropUntil::drop);
  EXPECT_EQ(d.filter.kind, FilterKind::savitzky_golay);
  EXPECT_EQ(d.filter.half_width, 4);
  EXPECT_EQ(d.resample.over, ResampleOver::displacement);
  EXPECT_EQ(d.resample.points, 50);
  EXPECT_EQ(section("files = [\"a\"]\ncontact = { kind = \"given\", at_mm = 2 }\n").contact.at, 2e-3);
  EXPECT_EQ(section("files = [\"a\"]\ninterval = 2\ntext.separator = \"blanks\"\n").text.interval, 2u);
}

TEST(DataSection, SaysWhatIsWrongWithIt) {
  EXPECT_THAT(section_fault("weight = 1\n"), HasSubstr("`files` is missing; name at least one"));
  EXPECT_THAT(section_fault("files = []\n"), HasSubstr("FIT.toml:2:9: data.0.files: is empty; name at least one file"));
  const std::string head = "files = [\"a.csv\"]\n";
  EXPECT_THAT(section_fault(head + "columns.force = { name = \"F\", unit = \"cd\" }\n"),
              AllOf(HasSubstr("FIT.toml:3:38: data.0.columns.force.unit: unknown unit \"cd\""),
                    HasSubstr("allowed: N, mN, kN, µN, nN, gf, kgf, lbf")));
  EXPECT_THAT(section_fault(head + "interval = 2\ntext.names_line = 3\n"),
              HasSubstr("data.0.interval: contradicts `text.names_line`"));
  EXPECT_THAT(section_fault(head + "columns.force = { unit = \"N\" }\n"), HasSubstr("give one of `name`, `number`"));
  EXPECT_THAT(section_fault(head + "columns.force = { name = \"a\", number = 2 }\n"), HasSubstr("contradicts `name`"));
  EXPECT_THAT(section_fault(head + "columns.force.name = \"a\"\ncolumns.stress.name = \"b\"\n"),
              HasSubstr("data.0.columns.stress: contradicts `force`; give one of the two"));
  EXPECT_THAT(section_fault(head + "crop = { min_strain = 0.5, max_strain = 0.2 }\n"),
              HasSubstr("must be greater than `min_strain`; nothing would be left"));
  EXPECT_THAT(section_fault(head + "contact = { kind = \"detect\", at_mm = 1 }\n"), HasSubstr("unknown key"));
  EXPECT_THAT(section_fault(head + "contact = { kind = \"given\" }\n"), HasSubstr("missing key `at_mm`"));
  EXPECT_THAT(section_fault(head + "filter = { kind = \"savitzky_golay\", half_width = 1, degree = 4 }\n"),
              HasSubstr("degree 4 must be below 2 half_width = 2; widen half_width"));
  EXPECT_THAT(section_fault(head + "resample.points = 2\n"), HasSubstr("2 is out of range; allowed: 5 to 100000"));
  EXPECT_THAT(section_fault(head + "use = \"tests\"\n"), HasSubstr("did you mean \"test\"?"));
}

// The documentation is made of the sections: every key says what it means.
TEST(DataSection, ExplainsEveryKey) {
  const std::vector<const scene::SectionSpec*> sections{&data_section(),  &column_section(),  &columns_section(),
                                                        &text_section(),  &contact_section(), &crop_section(),
                                                        &cycle_section(), &filter_section(),  &resample_section()};
  for (const scene::SectionSpec* s : sections) {
    EXPECT_FALSE(s->help.empty()) << s->name;
    for (const scene::KeySpec& key : s->keys) EXPECT_FALSE(key.help.empty()) << s->name << "." << key.name;
    for (const scene::KindSpec& kind : s->kinds) EXPECT_FALSE(kind.section.help.empty()) << kind.section.name;
    EXPECT_FALSE(scene::section_text(*s, s->name).empty());
  }
}

/// Lines of a phantom file from row `first` on, each cell changed.
using Change = std::function<std::string(std::size_t column, double value)>;
std::string rewritten(const std::string& header, char separator, const std::vector<std::size_t>& columns,
                      const Change& change) {
  std::istringstream in(text_of(kPhantoms / "EF10_100T_A1.csv"));
  std::string result = header, line;
  for (int n = 1; std::getline(in, line); ++n) {
    if (n <= 8) continue;
    std::vector<double> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(std::stod(cell));
    for (std::size_t i = 0; i < columns.size(); ++i)
      result += (i ? std::string(1, separator) : "") + change(columns[i], cells[columns[i]]);
    result += "\r\n";
  }
  return result;
}

std::string shown(double value, int digits = 12) {
  std::ostringstream out;
  out.precision(digits);
  out << value;
  return out.str();
}

std::string with_comma(std::string text) {
  for (char& c : text) c = c == '.' ? ',' : c;
  return text;
}

void expect_same(const Curve& a, const Curve& b, double force_tolerance, double way_tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a.time[i], b.time[i], 1e-9);
    EXPECT_NEAR(a.displacement[i], b.displacement[i], way_tolerance);
    EXPECT_NEAR(a.force[i], b.force[i], force_tolerance);
  }
}

class Variants : public testing::Test {
 protected:
  void SetUp() override {
    if (!have_phantoms()) GTEST_SKIP() << "the phantom files are not beside the sources";
    original_ = load("files = [\"EF10_100T_A1.csv\"]\n", kPhantoms);
  }
  Curve load(const std::string& text, const std::filesystem::path& base) {
    return load_curves(section(text), kPhantomSize, base).front().curve;
  }
  Folder folder_;
  Curve original_;
};

// Twelve digits are written: equal to 1e-9 of the largest force, 84 N, and way, 20 mm.
TEST_F(Variants, OfUnitsAndMarksGiveTheSameCurve) {
  folder_.write("german.csv", rewritten("Silikon; Probe 1;\r\nZeit (min);Weg (cm);Kraft (kN)\r\n", ';', {0, 1, 2},
                                        [](std::size_t c, double v) {
                                          return with_comma(shown(v / (c == 0 ? 60.0 : c == 1 ? 10.0 : 1000.0)));
                                        }));
  expect_same(load("files = [\"german.csv\"]\n", folder_.path()), original_, 1e-7, 1e-10);
  folder_.write("machine.csv", rewritten("Prüfzeit;Traversenweg;Standardkraft\ns;mm;N\n", ';', {0, 1, 2},
                                         [](std::size_t, double v) { return with_comma(shown(v)); }));
  expect_same(load("files = [\"machine.csv\"]\n", folder_.path()), original_, 1e-7, 1e-10);
  folder_.write("units.csv", rewritten("t\tx\tF\r\n(ms)\t(\xB5m)\t(mN)\r\n", '\t', {0, 1, 2},
                                       [](std::size_t, double v) { return shown(v * 1000.0); }));
  expect_same(load("files = [\"units.csv\"]\ncolumns.time.name = \"t\"\ncolumns.displacement.name = \"X\"\n"
                   "columns.force.number = 3\n",
                   folder_.path()),
              original_, 1e-7, 1e-10);
  folder_.write("bare.csv", rewritten("", ';', {1, 2, 0}, [](std::size_t c, double v) {
                  return with_comma(shown(c == 2 ? -v / 4.4482216152605 : c == 1 ? v / 25.4 : v));
                }));
  expect_same(load("files = [\"bare.csv\"]\ncolumns.displacement = { number = 1, unit = \"in\" }\n"
                   "columns.force = { number = 2, unit = \"lbf\" }\ncolumns.time = { number = 3, unit = \"s\" }\n",
                   folder_.path()),
              original_, 1e-7, 1e-10);
}

// Strain and stress have six decimals in the file: 5e-7 of 30 mm, and 5e-7 kPa of 1963 mm² = 1e-6 N.
TEST_F(Variants, OfStressAndStrainGiveTheSameCurve) {
  const Curve curve = load(
      "files = [\"EF10_100T_A1.csv\"]\ncolumns.strain.name = \"Engineering Strain\"\n"
      "columns.stress.name = \"engineering stress (kPa)\"\n",
      kPhantoms);
  expect_same(curve, original_, 2e-5, 3e-8);
}

// The machine went at 10 mm/min; it says 0.1 s a row, and started more slowly: 0.3 s in all.
TEST_F(Variants, OfSpeedInsteadOfTimeGiveTheSameCurve) {
  folder_.write("speed.csv", rewritten("Compression (mm),Load (N)\r\n", ',', {1, 2},
                                       [](std::size_t, double v) { return shown(v); }));
  const Curve curve = load("files = [\"speed.csv\"]\nspeed_mm_s = 0.16666666666666666\n", folder_.path());
  EXPECT_NEAR(curve.velocity, original_.velocity, 0.01 * original_.velocity);
  for (std::size_t i = 0; i < curve.size(); ++i) EXPECT_NEAR(curve.time[i], curve.displacement[i] * 6000.0, 1e-9);
}

TEST_F(Variants, CarryGroupUseAndWeight) {
  const auto all = load_curves(
      section("name = \"slow\"\nfiles = [\"EF10_75T_A1.csv\", \"EF10_75T_A2.csv\"]\nuse = \"test\"\nweight = 3\n"),
      kPhantomSize, kPhantoms);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].curve.name, "EF10_75T_A2");
  EXPECT_EQ(all[1].curve.group, "slow");
  EXPECT_TRUE(all[1].curve.held_out);
  EXPECT_EQ(all[1].curve.weight, 3.0);
  EXPECT_EQ(all[1].account.rows_read, 1202u);
  EXPECT_EQ(all[1].curve.size(), 100u);
  EXPECT_NEAR(all[1].curve.velocity, 10e-3 / 60.0, 1e-6);
}

const std::string kHead = "Machine 5\nTime (s),Depth (mm),Load (N)\n";

/// Ten sound rows, line 3 to 12, of which some are replaced.
std::string rows(const std::vector<std::pair<int, std::string>>& changed = {}) {
  std::string text = kHead;
  for (int i = 0; i < 10; ++i) {
    std::string row = shown(i) + "," + shown(0.5 * i) + "," + shown(0.1 * i);
    for (const auto& [line, other] : changed) {
      if (line == i + 3) row = other;
    }
    text += row + "\n";
  }
  return text;
}

class BadFile : public testing::Test {
 protected:
  std::string fault(const std::string& text, const std::string& keys = {}, const SpecimenSize& size = {}) {
    folder_.write("t.csv", text);
    return phantom::complaint(section("files = [\"t.csv\"]\n" + keys), size, folder_.path());
  }
  Folder folder_;
};

TEST_F(BadFile, SoundOnesPass) { EXPECT_EQ(fault(rows()), ""); }

TEST_F(BadFile, MissingColumn) {
  EXPECT_THAT(fault(rows(), "columns.force.name = \"Laod\"\n"),
              AllOf(HasSubstr("t.csv:2:1: columns.force: no column \"Laod\""),
                    HasSubstr("Columns: \"Time (s)\", \"Depth (mm)\", \"Load (N)\"")));
  EXPECT_THAT(fault(rows(), "columns.force.name = \"Laod (N)\"\n"), HasSubstr("did you mean \"Load (N)\"?"));
  EXPECT_THAT(fault(rows(), "columns.force.number = 4\n"), HasSubstr("no column number 4; allowed: 1 to 3"));
  EXPECT_THAT(fault("Time (s),Depth (mm),Signal (N)\n0,1,2\n1,2,3\n"),
              AllOf(HasSubstr("columns.force: is not given, and no column has a customary name"),
                    HasSubstr("say columns.force = { name = \"…\", unit = \"N\" }")));
  EXPECT_THAT(fault("0,1,2\n1,2,3\n", "columns.time.name = \"t\"\n"),
              HasSubstr("the file has no line of names; choose by `number`, 1 to 3"));
  EXPECT_THAT(fault("Time (s),Depth (mm),Load (N),Load cell 2 (N)\n0,1,2,3\n1,2,3,4\n"),
              HasSubstr("several columns could be it"));
}

TEST_F(BadFile, TwoColumnsOfOneName) {
  EXPECT_THAT(
      fault("Time (s),Depth (mm),Load (N),Load (N)\n0,1,2,3\n1,2,3,4\n", "columns.force.name = \"Load (N)\"\n"),
      HasSubstr("t.csv:1:1: columns.force: 2 columns match \"Load (N)\": numbers 3, 4; choose one by `number`"));
}

TEST_F(BadFile, UnknownUnit) {
  EXPECT_THAT(
      fault("Time (s),Depth (mm),Load (cd)\n0,1,2\n1,2,3\n", "columns.force.name = \"Load (cd)\"\n"),
      HasSubstr(
          "t.csv:1:1: columns.force: unknown unit \"cd\" of column \"Load (cd)\"; give `unit` as one of N, mN, kN"));
  EXPECT_THAT(fault("Time (s),Depth (mm),Load\n0,1,2\n1,2,3\n"),
              HasSubstr("column \"Load\" says no unit; give `unit` as one of N"));
}

TEST_F(BadFile, RowsWithoutNumbers) {
  const std::string bad = rows({{5, "2,NaN,0.2"}, {7, "4,2,"}, {8, "5"}, {10, "7,x,0.7"}});
  const std::string text = fault(bad);
  EXPECT_THAT(text, HasSubstr("t.csv:5:3: \"NaN\" is no finite number in \"Depth (mm)\"\n"));
  EXPECT_THAT(fault(rows({{5, "2,1e300,0.2"}})), HasSubstr("t.csv:5:3: \"1e300\" is beyond any measurement in"));
  EXPECT_THAT(text, HasSubstr("t.csv:7:"));
  EXPECT_THAT(text, HasSubstr("t.csv:8:1: has 1 fields, none for \"Depth (mm)\""));
  EXPECT_THAT(text, HasSubstr("4 of 10 rows are bad, the first 3 named above: more than a twentieth of the test"));
  folder_.write("t.csv", rows({{8, "5"}}));
  EXPECT_THAT(fault(rows({{8, "5"}})),
              HasSubstr("t.csv:8:1: has 1 fields, none for \"Depth (mm)\"; correct the row, or "
                        "give skip_bad_rows = true"));
  const auto curves = load_curves(section("files = [\"t.csv\"]\nskip_bad_rows = true\n"), {}, folder_.path());
  EXPECT_EQ(curves.front().account.rows_skipped, 1u);
  EXPECT_EQ(curves.front().account.rows_read, 10u);
  EXPECT_EQ(curves.front().curve.size(), 9u);
  EXPECT_THAT(curves.front().account.text(), HasSubstr("10 rows, 1 bad ones skipped"));
  EXPECT_THAT(curves.front().account.skipped_text(), HasSubstr("1 of 10 rows of t have no number in a column"));
}

TEST_F(BadFile, TimeThatGoesBack) {
  EXPECT_THAT(
      fault(rows({{8, "3.5,2.5,0.5"}})),
      HasSubstr(
          "t.csv:8:1: time goes back: 3.5 s in \"Time (s)\" after 4 s in line 7; it must not fall: sort the rows"));
  // late in a long record the difference is in the sixth digit
  EXPECT_THAT(fault(kHead + "1000.1,0,0\n1000.3,1,1\n1000.2,2,2\n1000.4,3,3\n"),
              HasSubstr("1000.2 s in \"Time (s)\" after 1000.3 s"));
  folder_.write("t.csv", rows({{8, "4,2.5,0.5"}}));
  const auto merged = load_curves(section("files = [\"t.csv\"]\n"), {}, folder_.path()).front();
  EXPECT_EQ(merged.account.rows_merged, 1u);
  EXPECT_DOUBLE_EQ(merged.curve.force[4], 0.45);
  EXPECT_EQ(merged.curve.size(), 9u);
}

TEST_F(BadFile, TooFewPointsAndEmptyFile) {
  EXPECT_THAT(fault(kHead + "0,0,0\n1,1,1\n2,2,2\n"),
              HasSubstr("t.csv:5:1: too few points: the file has 3 of the 3 rows read; at least 5 are needed"));
  EXPECT_THAT(fault(""), HasSubstr("t.csv:1:1: is empty"));
  EXPECT_THAT(fault(kHead), HasSubstr("has no rows of numbers"));
}

// All problems of a file, and those of all files, in one go.
TEST_F(BadFile, TellsEverythingAtOnce) {
  folder_.write("a.csv", rows({{5, "2,NaN,0.2"}, {8, "3.5,2.5,0.5"}}));
  folder_.write("b.csv", "");
  const std::string text =
      phantom::complaint(section("files = [\"a.csv\", \"b.csv\", \"c.csv\"]\n"), {}, folder_.path());
  EXPECT_THAT(text, AllOf(HasSubstr("a.csv:5:3: "), HasSubstr("a.csv:8:1: time goes back"),
                          HasSubstr("b.csv:1:1: is empty"), HasSubstr("c.csv: cannot be read")));
}

TEST_F(BadFile, NeedsTheSpecimenForStressAndStrain) {
  const std::string text = "Time (s),Strain (-),Stress (kPa)\n0,0,0\n1,.1,1\n2,.2,2\n3,.3,3\n4,.4,4\n";
  const std::string keys = "columns.strain.name = \"Strain\"\ncolumns.stress.name = \"Stress\"\n";
  EXPECT_THAT(fault(text, keys),
              AllOf(HasSubstr("columns.strain: needs the height of the specimen"), HasSubstr("give height_mm"),
                    HasSubstr("columns.stress: needs the area"), HasSubstr("give area_mm2")));
  EXPECT_EQ(fault(text, keys + "height_mm = 30\narea_mm2 = 1000\n"), "");
}

constexpr SpecimenSize kSmall{.area = 1e-4, .height = 10e-3, .radius = {}};

// A slip of 1000 in way, force or time is seen from the specimen, from other columns, from the speed.
TEST_F(BadFile, UnitsThatAreOffByAThousand) {
  EXPECT_EQ(fault(rows(), "", kSmall), "");
  EXPECT_THAT(
      fault(rows(), "columns.displacement = { name = \"Depth\", unit = \"m\" }\n", kSmall),
      AllOf(HasSubstr("t.csv:2:1: \"Depth (mm)\", read in m, goes to 4.5 m, 450 of the specimen's height of 10 mm"),
            HasSubstr("in mm it would be 4.5 mm: give columns.displacement = { name = \"Depth (mm)\", unit = \"mm\" }, "
                      "or unlikely = true")));
  EXPECT_THAT(fault(rows(), "columns.displacement = { name = \"Depth\", unit = \"um\" }\n", kSmall),
              HasSubstr("in mm it would be 4.5 mm: give columns.displacement = "));
  EXPECT_EQ(fault(rows(), "unlikely = true\ncolumns.displacement = { name = \"Depth\", unit = \"m\" }\n", kSmall), "");
  std::string stressed = "Time (s),Depth (mm),Load (N),Eng. stress (kPa)\n";
  for (int i = 0; i < 10; ++i)
    stressed += shown(i) + "," + shown(0.5 * i) + "," + shown(0.1 * i) + "," + shown(i) + "\n";
  EXPECT_EQ(fault(stressed, "", kSmall), "");
  for (const std::string unit : {"kN", "mN"})
    EXPECT_THAT(fault(stressed, "columns.force = { name = \"Load\", unit = \"" + unit + "\" }\n", kSmall),
                AllOf(HasSubstr("\"Load (N)\", read in " + unit + ", goes to 0.9 " + unit + ", a stress of "),
                      HasSubstr("but \"Eng. stress (kPa)\" goes to 9 kPa; in N it would be 0.9 N: give columns.force = "
                                "{ name = \"Load (N)\", unit = \"N\" }")));
  EXPECT_THAT(fault(rows(), "columns.force = { name = \"Load\", unit = \"kN\" }\narea_mm2 = 1\nheight_mm = 10\n"),
              HasSubstr("a stiffness of 2e+09 Pa over the specimen"));
  EXPECT_THAT(
      fault(rows(), "columns.time = { name = \"Time\", unit = \"ms\" }\nspeed_mm_s = 0.5\n"),
      AllOf(HasSubstr("\"Time (s)\", read in ms, goes to 9 ms; at speed_mm_s = 0.5 the tool goes 0.0045 mm, but "
                      "\"Depth (mm)\" spans 4.5 mm"),
            HasSubstr("in s it would be 9 s: give columns.time = { name = \"Time (s)\", unit = \"s\" }")));
}

// One of three repetitions written in kN by a machine that was set up anew.
TEST_F(BadFile, RepetitionsThatDisagreeByAThousand) {
  std::string other = "Time (s),Depth (mm),Load (N)\n";
  for (int i = 0; i < 10; ++i) other += shown(i) + "," + shown(0.5 * i) + "," + shown(1e-4 * i) + "\n";
  folder_.write("a.csv", rows());
  folder_.write("b.csv", rows());
  folder_.write("c.csv", other);
  const std::string keys = "files = [\"a.csv\", \"b.csv\", \"c.csv\"]\n";
  EXPECT_THAT(
      phantom::complaint(section(keys), {}, folder_.path()),
      AllOf(HasSubstr("c.csv:1:1: \"Load (N)\", read in N, spans 0.001 times what the other tests of its group span"),
            HasSubstr("unlikely = true")));
  EXPECT_EQ(phantom::complaint(section(keys + "unlikely = true\n"), {}, folder_.path()), "");
}

// Negative is compression where a machine says so: found, or told.
TEST_F(BadFile, SignsAreFoundOrSaid) {
  std::string text = kHead;
  for (int i = 0; i < 10; ++i) text += shown(i) + "," + shown(-0.5 * i) + "," + shown(0.05 - 0.1 * i) + "\n";
  folder_.write("t.csv", text);
  const auto load = [&](const std::string& keys) {
    return load_curves(section("files = [\"t.csv\"]\n" + keys), {}, folder_.path()).front().curve;
  };
  EXPECT_DOUBLE_EQ(load("").displacement.back(), 4.5e-3);
  EXPECT_DOUBLE_EQ(load("").force.back(), 0.85);
  const std::string said = "columns.force = { name = \"Load\", sign = \"positive\" }\n";
  EXPECT_DOUBLE_EQ(load("unlikely = true\n" + said).force.back(), -0.85);
  EXPECT_THAT(fault(text, said),
              HasSubstr("t.csv:2:1: \"Load (N)\" falls as \"Depth (mm)\" rises, force against its own "
                        "displacement; give sign = \"positive\" or \"negative\" in columns.displacement or "
                        "columns.force, or leave both to be found, or unlikely = true"));
}

// A ramp of six rows that is held after the third and let go a little: its sign is that of the first row's way, not of a middle.
TEST_F(BadFile, SparseCurvesKeepTheirSign) {
  const auto turned = [&](double sign) {
    std::string text = kHead;
    const std::array<double, 6> depth{0.0, 2.0, 4.0, 4.0, 4.0, 3.2}, load{0.0, 0.5, 1.4, 1.0, 0.8, 0.5};
    for (std::size_t i = 0; i < depth.size(); ++i)
      text += shown(static_cast<double>(i)) + "," + shown(sign * depth[i]) + "," + shown(sign * load[i]) + "\n";
    folder_.write("t.csv", text);
    return load_curves(section("files = [\"t.csv\"]\nresample.over = \"none\"\n"), {}, folder_.path()).front();
  };
  for (const double sign : {1.0, -1.0}) {
    const PreparedCurve found = turned(sign);
    EXPECT_DOUBLE_EQ(found.curve.displacement.back(), 3.2e-3) << sign;
    EXPECT_DOUBLE_EQ(found.curve.force[2], 1.4) << sign;
    EXPECT_EQ(found.account.turned.size(), sign < 0.0 ? 2u : 0u);
    EXPECT_EQ(found.account.text().find("sign of \"Depth (mm)\" turned") != std::string::npos, sign < 0.0);
  }
}

// Any bytes put into a phantom's lines, any cut, any line twice: a curve in order, or a message that names the file.
RC_GTEST_PROP(MutatedFile, GivesACurveOrAMessage, ()) {
  static const std::string sound = rows();
  std::string text = sound;
  const int changes = *rc::gen::inRange(1, 8);
  for (int i = 0; i < changes; ++i) {
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto kind = *rc::gen::inRange(0, 4);
    if (kind == 0) text[at] = static_cast<char>(*rc::gen::inRange(0, 256));
    if (kind == 1) text.erase(at, *rc::gen::inRange<std::size_t>(1, 20));
    if (kind == 2) text.insert(at, text.substr(at / 2, *rc::gen::inRange<std::size_t>(1, 30)));
    if (kind == 3)
      text.insert(at, *rc::gen::element<std::string>(",", ";", "\t", "\n", "\r", "\"", "-", "e9", "nan", "9", "."));
    if (text.empty()) text = "1";
  }
  const DataSpec spec = *rc::gen::element(section("files = [\"t.csv\"]\nskip_bad_rows = true\n"),
                                          section("files = [\"t.csv\"]\nunlikely = true\ncontact.kind = \"detect\"\n"),
                                          section("files = [\"t.csv\"]\nskip_bad_rows = true\ncrop.until = \"drop\"\n"
                                                  "filter.kind = \"savitzky_golay\"\nresample.points = 5\n"));
  scene::Problems problems("t.csv");
  try {
    const CurveFile file = parse_curve_file(text, "t.csv", spec.text);
    const RawTest raw = raw_test(file, spec, kSmall, problems);
    if (problems.count() == 0) check_units(raw, spec, kSmall, problems);
    problems.throw_if_any();
    const auto prepared = prepare(raw, spec, kSmall, problems);
    problems.throw_if_any();
    RC_ASSERT(prepared.has_value());
    const Curve& c = prepared->curve;
    RC_ASSERT(c.size() >= 5u && c.displacement.size() == c.size() && c.force.size() == c.size());
    for (std::size_t i = 0; i < c.size(); ++i) {
      RC_ASSERT(std::isfinite(c.displacement[i]) && std::isfinite(c.force[i]) && std::isfinite(c.time[i]));
      if (i > 0) RC_ASSERT(c.time[i] > c.time[i - 1]);  // the macro would look at both sides of an ||
    }
  } catch (const SceneError& error) {
    RC_ASSERT(std::string_view(error.what()).starts_with("t.csv"));
  }
}

}  // namespace
}  // namespace glisson::fit
