// Files in the form that machines write them: every number is read to its last digit, in the unit that the file says, or the
// file is refused with the line of FIT.toml that mends it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "fit/data/load_curves.h"
#include "fit/data/prepare.h"
#include "fit/data/section_data.h"
#include "phantom.h"
#include "scene/parse/problems.h"
#include "scene/parse/section.h"

namespace glisson::fit::machine_files_test {
namespace {

using phantom::Folder;
using testing::AllOf;
using testing::HasSubstr;

/// A number as `%.{digits}f` writes it.
std::string plain(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// The same with another decimal mark, and a mark of thousands where one is given.
std::string written(double value, int digits, const std::string& decimal, const std::string& thousands = "") {
  const std::string text = plain(std::abs(value), digits);
  const std::size_t point = std::min(text.find('.'), text.size());
  std::string out = value < 0.0 ? "-" : "";
  for (std::size_t i = 0; i < point; ++i) {
    if (i > 0 && (point - i) % 3 == 0) out += thousands;
    out += text[i];
  }
  return point < text.size() ? out + decimal + text.substr(point + 1) : out;
}

constexpr std::size_t kRows = 40;
double time_at(std::size_t i) { return 0.1 * static_cast<double>(i); }
double way_at(std::size_t i) { return 0.08 * static_cast<double>(i); }
double load_at(std::size_t i) {
  return 127.7463 * static_cast<double>(i) + 0.8125 * std::pow(static_cast<double>(i), 2);
}

/// Rows of time, displacement and load with these marks: 3, 4 and 3 decimals.
std::string rows(const std::string& between, const std::string& decimal, const std::string& thousands = "",
                 const std::string& quote = "") {
  std::string text;
  for (std::size_t i = 0; i < kRows; ++i) {
    text += quote + written(time_at(i), 3, decimal, thousands) + quote + between;
    text += quote + written(way_at(i), 4, decimal, thousands) + quote + between;
    text += quote + written(load_at(i), 3, decimal, thousands) + quote + "\n";
  }
  return text;
}

/// What a reader of the digits has: of the text in plain form.
double digits_of(double value, int digits) { return std::strtod(plain(value, digits).c_str(), nullptr); }

const std::string kBlock = "kind = \"cylinder\"\ndiameter_mm = 30\nheight_mm = 20";
const std::string kPoint = "kind = \"point\"";

DataSpec section(const std::string& keys) {
  const scene::Node root = scene::parse_document("[[data]]\n" + keys, "FIT.toml");
  scene::Problems problems("FIT.toml");
  DataSpec spec;
  const scene::Node& data = root.find("data")->array()->front();
  scene::read_section(data_section(), data, &spec, {problems, "data.0", data.where});
  problems.throw_if_any();
  return spec;
}

class Machine : public testing::Test {
 protected:
  RawTest read(const std::string& text, const std::string& keys = "", const std::string& specimen = kBlock) {
    const DataSpec spec = section("files = [\"t.csv\"]\n" + keys);
    SpecimenSize size{.area = M_PI * 0.015 * 0.015, .height = 0.02, .radius = 0.015};
    if (specimen == kPoint) size = {.area = 1.0, .height = 1.0, .radius = {}, .point = true};
    const CurveFile file = parse_curve_file(text, "t.csv", spec.text);
    scene::Problems problems("t.csv");
    RawTest test = raw_test(file, spec, size, problems);
    problems.throw_if_any();
    return test;
  }

  std::string fault(const std::string& text, const std::string& keys = "", const std::string& specimen = kBlock) {
    try {
      read(text, keys, specimen);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "no fault";
  }

  /// Rows of `rows()` in units of these factors.
  void expect_rows(const RawTest& test, double second, double metre, double newton) {
    ASSERT_EQ(test.size(), kRows);
    for (std::size_t i = 0; i < kRows; ++i) {
      EXPECT_EQ(test.time[i], digits_of(time_at(i), 3) * second) << i;
      EXPECT_EQ(test.displacement[i], digits_of(way_at(i), 4) * metre) << i;
      EXPECT_EQ(test.force[i], digits_of(load_at(i), 3) * newton) << i;
    }
  }
};

std::string utf16(const std::string& ascii, bool big, bool mark) {
  std::string bytes = mark ? (big ? "\xFE\xFF" : "\xFF\xFE") : "";
  for (const char c : ascii) {
    const std::string zero(1, '\0'), one(1, c);
    bytes += big ? zero + one : one + zero;
  }
  return bytes;
}

// Ways to write one table: quotes with commas for thousands, points for thousands, blanks, no-break blanks, apostrophes.
TEST_F(Machine, MarksOfThousandsReadToTheLastDigit) {
  const std::string quoted =
      "\"Results Table 1\"\n\"Time\",\"Compressive extension\",\"Compressive load\"\n"
      "\"(s)\",\"(mm)\",\"(mN)\"\n";
  expect_rows(read(quoted + rows(",", ".", ",", "\"")), 1.0, 1e-3, 1e-3);
  const std::string german = "Prüfzeit;Standardweg;Standardkraft\ns;mm;mN\n";
  for (const std::string mark : {".", " ", "\u00A0", "\u202F", "'", "’"})
    expect_rows(read(german + rows(";", ",", mark)), 1.0, 1e-3, 1e-3);
  const std::string french = "Essai n\xB0 1\nTemps;D\xE9placement;Charge de compression\ns;mm;mN\n";  // Latin-1
  expect_rows(read(french + rows(";", ",")), 1.0, 1e-3, 1e-3);
}

// A mark that may be either is asked for; one that also parts the columns, or stands in some large numbers only, is refused.
TEST_F(Machine, MarksThatMayBeEitherAreRefused) {
  const std::string names = "Time (s);Extension (mm);Load (mN)\n";
  EXPECT_THAT(
      fault(names + "1;2;500\n2;3;750\n3;4;1,000\n4;5;1,250\n5;6;1,500\n"),
      HasSubstr("t.csv:4:1: \"1,000\" may have a decimal mark or one of thousands; give text.decimal = \".\" or"));
  const std::string twofold = names + "1;2;500\n2;3;750\n3;4;1,000\n4;5;1,250\n5;6;1,500\n";
  EXPECT_EQ(read(twofold, "text.decimal = \".\"\n").force.back(), 1500.0 * 1e-3);
  EXPECT_THAT(fault("Time (s),Extension (mm),Load (mN)\n1,2,916.5\n2,3,1,051.8\n3,4,1,188.4\n"),
              AllOf(HasSubstr("t.csv:3:1: has 4 fields where 3 are expected: in \"1,051.8\" a comma parts thousands"),
                    HasSubstr("export with `;` or tabs")));
  EXPECT_THAT(
      fault(names + "0.5;2;1,051.5\n0.6;3;1250.5\n0.7;4;1,500.5\n"),
      AllOf(HasSubstr("t.csv:2:1: \"1,051.5\" in \"Load (mN)\" has a mark of thousands, and \"1250.5\" in line 3"),
            HasSubstr("give text.decimal")));
  // three decimals in every number are decimals
  EXPECT_EQ(read(names + "1,000;2,000;1,500\n2,000;3,000;1,750\n").force.front(), 1.5 * 1e-3);
}

// Unicode of two bytes a character, with its mark or without, either byte first.
TEST_F(Machine, Utf16ReadsAsUtf8) {
  const std::string text = "Time (s)\tExtension (mm)\tLoad (mN)\r\n" + rows("\t", ",");
  for (const bool big : {false, true}) {
    for (const bool mark : {false, true}) expect_rows(read(utf16(text, big, mark)), 1.0, 1e-3, 1e-3);
  }
  EXPECT_THAT(fault("PK\x03\x04 and more"),
              AllOf(HasSubstr("t.csv:1:1: is a workbook (.xlsx)"), HasSubstr("python -m glisson.workbook")));
}

// Columns that blanks part: NumPy's savetxt, and a table of fixed columns whose names have blanks.
TEST_F(Machine, BlanksPartColumns) {
  expect_rows(read("# time_s displacement_mm force_mN\n" + rows(" ", ".")), 1.0, 1e-3, 1e-3);
  expect_rows(read("Specimen 1 of 3\n Time (s)    Crosshead travel (mm)   Axial load (mN)\n" + rows("    ", ".")), 1.0,
              1e-3, 1e-3);
  expect_rows(read("Time (s) Extension (mm) Load (mN)\n" + rows("   ", ",")), 1.0, 1e-3, 1e-3);
  EXPECT_THAT(fault("Time of the test Extension Load\n" + rows(" ", ".")), HasSubstr("the file has no line of names"));
}

struct Maker {
  std::string name, head, between, decimal;
  double second, metre, newton;
};

// Names and units of ten makers, in the form in which their programs export a press.
TEST_F(Machine, HeadsOfTenMakersAreUnderstood) {
  constexpr double kGramForce = 1e-3 * 9.80665;
  // of the columns time, displacement, load: the rows have that order
  const std::vector<Maker> makers{
      {"a materials tester in its raw table", "Interval,100 ms\n\nTime,Extension,Load\n(sec),(mm),(N)\n", ",", ".", 1,
       1e-3, 1},
      {"a texture analyser", "Test 1\nTime (sec)\tDistance (mm)\tForce (g)\n", "\t", ".", 1, 1e-3, kGramForce},
      {"a micromechanical tester", "<INFO>\nDate:\tMon\n<END INFO>\n<DATA>\nTime, s\tPosition (z), mm\tFz, gf\n", "\t",
       ".", 1, 1e-3, kGramForce},
      {"a servohydraulic frame",
       "Data Header:\tTime:\t12.5\tSec\nElapsed Time\tAxial Displacement\tAxial Force\n"
       "Sec\tmm\tkN\n",
       "\t", ".", 1, 1e-3, 1e3},
      {"a nano-indenter", "Date\t1/2/2026\nTip radius (um)\t50.5\n\nTime (s)\tIndentation (nm)\tLoad (uN)\n", "\t", ".",
       1, 1e-9, 1e-6},
      {"an ultra nano-indenter", "Measured values\nTime (s)\tPd (µm)\tFn (nN)\n\n", "\t", ".", 1, 1e-6, 1e-9},
      {"a German frame", "Legende;1;2\nZeit [s];Weg [µm];Kraft [N]\n", ";", ",", 1, 1e-6, 1},
      {"a German press", "Zeit in min;Stauchung in mm;Druckkraft in kN\n", ";", ",", 60, 1e-3, 1e3},
      {"a Japanese frame", "\"1 _ 1\"\n\"Time\",\"Stroke\",\"Force\"\n\"sec\",\"mm\",\"N\"\n", ",", ".", 1, 1e-3, 1},
      {"a French frame", "Temps;Enfoncement;Effort\nmin;cm;daN\n", ";", ",", 60, 1e-2, 10},
      {"a shear cell", "Zeit (ms)\tScherweg (in)\tScherkraft (lbf)\n", "\t", ",", 1e-3, 0.0254, 0.45359237 * 9.80665}};
  for (const Maker& m : makers) {
    SCOPED_TRACE(m.name);
    const std::string keys = m.name == "a shear cell"     ? "test = \"simple_shear\"\n"
                             : m.name == "a German press" ? "columns.displacement.name = \"Stauchung\"\n"
                                                          : "";
    const std::string text = m.head + rows(m.between, m.decimal);
    EXPECT_EQ(fault(text, keys), "no fault");
    expect_rows(read(text, keys), m.second, m.metre, m.newton);
  }
}

// A strain in percent over N/mm², psi or kgf/cm², in a line of units of its own or behind a comma.
TEST_F(Machine, StressesReadInTheUnitsOfTheTrade) {
  const std::vector<std::pair<std::string, double>> heads{
      {"Dehnung;Spannung\n%;N/mm²\n", 1e6},
      {"Tensile strain, %;Tensile stress, psi\n", 0.45359237 * 9.80665 / (0.0254 * 0.0254)},
      {"Strain [%];Stress [kgf/cm^2]\n", 9.80665 / (1e-2 * 1e-2)},
      {"Déformation (%);Contrainte (N/mm2)\n", 1e6}};
  for (const auto& [head, pascal] : heads) {
    const RawTest test = read(head + "0.3;0.000179\n0.6;0.000358\n0.9;0.000535\n", "test = \"tension\"\n", kPoint);
    ASSERT_EQ(test.size(), 3u) << head;
    EXPECT_DOUBLE_EQ(test.displacement[2], 0.009) << head;
    EXPECT_DOUBLE_EQ(test.force[2], 0.000535 * pascal) << head;
  }
}

std::string interval(const std::string& first, double frequency, double scale) {
  std::string text = first;
  for (int i = 1; i <= 6; ++i)
    text += "\t" + std::to_string(i) + "\t" + plain(frequency * i, 3) + "\t" + plain(scale * 100.5 * i, 2) + "\t" +
            plain(scale * 10.25 * i, 3) + "\n";
  return text + "\n";
}

const std::string kRheometer =
    "Project:\tliver 1\n\n" +
    interval(
        "Interval and data points:\t1\t6\nInterval data:\tPoint No.\tAngular Frequency\tStorage Modulus\tLoss "
        "Modulus\n\t\t[rad/s]\t[Pa]\t[Pa]\n",
        10.0, 1.0) +
    interval(
        "Interval and data points:\t2\t6\nInterval data:\tPoint No.\tAngular Frequency\tStorage Modulus\tLoss "
        "Modulus\n\t\t[rad/s]\t[kPa]\t[Pa]\n",
        1.0, 2.0);

// Tables one below the other are no one test: which is meant has to be said, and each has its own units.
TEST_F(Machine, IntervalsOfARheometerAreChosen) {
  const std::string keys = "test = \"oscillation\"\n";
  EXPECT_THAT(fault(kRheometer, keys, kPoint),
              AllOf(HasSubstr("holds 2 intervals: 1 in lines 6 to 11 (6 rows), 2 in lines 16 to 21 (6 rows)"),
                    HasSubstr("give interval = 1 to 2")));
  const RawTest first = read(kRheometer, keys + "interval = 1\n", kPoint);
  const RawTest second = read(kRheometer, keys + "interval = 2\n", kPoint);
  ASSERT_EQ(first.size(), 6u);
  ASSERT_EQ(second.size(), 6u);
  EXPECT_DOUBLE_EQ(first.displacement[5], 60.0 / (2.0 * M_PI));
  EXPECT_DOUBLE_EQ(second.displacement[5], 6.0 / (2.0 * M_PI));
  EXPECT_DOUBLE_EQ(first.force[5], 603.0);
  EXPECT_DOUBLE_EQ(second.force[5], 1206.0 * 1e3);
  EXPECT_THAT(fault(kRheometer, keys + "interval = 3\n", kPoint),
              HasSubstr("has 2 intervals, and interval = 3 is asked for: 1 in lines 6 to 11"));
}

// German names, several steps below titles, and a summary above the curve that is no interval of its own.
TEST_F(Machine, OtherRheometersAndSummaries) {
  const std::string german = interval(
      "Intervall und Datenpunkte:\t1\t6\nIntervalldaten:\tPunkt Nr.\tKreisfrequenz\tSpeichermodul\tVerlustmodul\n"
      "\t\t[rad/s]\t[Pa]\t[Pa]\n",
      10.0, 1.0);
  EXPECT_DOUBLE_EQ(read(german, "test = \"oscillation\"\n", kPoint).force[5], 603.0);
  const std::string step = "f in Hz;G' in Pa;G\" in Pa\n0.1;100.5;10.5\n0.2;201;21\n0.3;301.5;31.5\n";
  EXPECT_DOUBLE_EQ(read(step, "test = \"oscillation\"\n", kPoint).force[2], 301.5);
  const std::string trios = "[step]\nFrequency - 1\n";
  const std::string names = "Angular frequency\tStorage modulus\tLoss modulus\nrad/s\tPa\tPa\n";
  EXPECT_DOUBLE_EQ(
      read(trios + names + "0.1\t100.5\t10.5\n0.2\t201\t21\n", "test = \"oscillation\"\n", kPoint).force[1], 201.0);
  expect_rows(read("Probe;hmax;Fmax\n;mm;mN\n1;3,12;6.217,9\n\nZeit;Weg;Kraft\ns;mm;mN\n" + rows(";", ",", ".")), 1.0,
              1e-3, 1e-3);
}

// 1/s of a frequency is Hz to some and rad/s to others: the name of the column decides, else the user is asked with the line that
// settles it; a shear rate beside it, and units that stand below the names, are read for what they are.
TEST_F(Machine, FrequenciesPerSecondAreReadByTheirName) {
  const std::string keys = "test = \"oscillation\"\n";
  const std::string numbers = "0.5\t100.5\t10.5\n1\t201\t21\n2\t301.5\t31.5\n";
  const auto table = [&](const std::string& frequency, const std::string& unit) {
    return frequency + "\tStorage Modulus\tLoss Modulus\n" + unit + "\t[Pa]\t[Pa]\n" + numbers;
  };
  for (const char* angular : {"Angular Frequency", "Kreisfrequenz", "Pulsation", "ω"}) {
    for (const char* unit : {"[1/s]", "[s⁻¹]", "[s^-1]", "[1 / s]"})
      EXPECT_DOUBLE_EQ(read(table(angular, unit), keys, kPoint).displacement[1], 0.5 / M_PI) << angular << unit;
    EXPECT_DOUBLE_EQ(read(std::string(angular) + " (1/s)\tG' (Pa)\tG\" (Pa)\n" + numbers, keys, kPoint).displacement[2],
                     1.0 / M_PI);
  }
  const std::string plain_name = table("Frequency", "[1/s]");
  const std::string asked =
      "\"1/s\" of column \"Frequency\" may be Hz or rad/s; give `unit` as the one that is meant: "
      "columns.frequency = { number = 1, unit = \"Hz\" } or unit = \"rad/s\"";
  EXPECT_THAT(fault(plain_name, keys, kPoint), HasSubstr(asked));
  EXPECT_THAT(fault(plain_name, keys + "columns.frequency = { number = 1, unit = \"1/s\" }\n", kPoint),
              HasSubstr(asked));
  const auto with = [&](const std::string& unit) {
    return keys + "columns.frequency = { number = 1, unit = \"" + unit + "\" }\n";
  };
  EXPECT_EQ(read(plain_name, with("Hz"), kPoint).displacement[1], 1.0);
  EXPECT_DOUBLE_EQ(read(plain_name, with("rad/s"), kPoint).displacement[1], 0.5 / M_PI);
  EXPECT_DOUBLE_EQ(read(table("Angular Frequency", ""), with("1/s"), kPoint).displacement[1], 0.5 / M_PI);
  EXPECT_EQ(section("files = [\"t.csv\"]\ncolumns.frequency = { number = 1, unit = \"1/s\" }\n").columns.frequency.unit,
            "1/s");
}

// A rate beside the columns of a test: `1/s` is one unit, in brackets, after a comma, a blank or below the names.
TEST_F(Machine, RatesBesideTheTestAreLeftAlone) {
  const auto beside = [](const std::string& title) {
    std::string text = "Time (s);" + title + ";Extension (mm);Load (mN)\n";
    for (std::size_t i = 0; i < kRows; ++i)
      text += plain(time_at(i), 3) + ";0.125;" + plain(way_at(i), 4) + ";" + plain(load_at(i), 3) + "\n";
    return text;
  };
  for (const char* title : {"Strain rate (1/s)", "Strain rate, 1/s", "Strain rate 1/s", "Speed_mm/s", "Time rate 1/s"})
    expect_rows(read(beside(title)), 1.0, 1e-3, 1e-3);
  std::string below = "Strain rate;Weg;Kraft;Zeit\n1/s;mm;mN;s\n";
  for (std::size_t i = 0; i < kRows; ++i)
    below += "0.125;" + plain(way_at(i), 4) + ";" + plain(load_at(i), 3) + ";" + plain(time_at(i), 3) + "\n";
  expect_rows(read(below), 1.0, 1e-3, 1e-3);
}

std::string with_faults(const std::vector<std::size_t>& bad, std::size_t size) {
  std::string text = "Time (s);Extension (mm);Load (mN)\n";
  for (std::size_t i = 0; i < size; ++i) {
    const bool lost = std::find(bad.begin(), bad.end(), i) != bad.end();
    text += plain(time_at(i), 3) + ";" + plain(way_at(i), 4) + ";" + (lost ? "ERR" : plain(load_at(i), 3)) + "\n";
  }
  return text;
}

// Rows are skipped where they are scattered slips, and never where a part of the test would go with them: 5 of 101 is the most, 2
// in a row, and rows that all lie at one end are no slips. The advice to skip is given only where it would be taken.
TEST_F(Machine, SkipsSlipsAndNoPartOfATest) {
  const std::string skip = "skip_bad_rows = true\n";
  const std::string scattered = with_faults({10, 35, 52, 77, 90}, 101);
  EXPECT_THAT(fault(scattered),
              AllOf(HasSubstr("\"ERR\" is no finite number in \"Load (mN)\"; correct the row, or give "
                              "skip_bad_rows = true"),
                    HasSubstr("5 of 101 rows are bad, the first 3 named above")));
  const RawTest kept = read(scattered, skip);
  EXPECT_EQ(kept.size(), 96u);
  EXPECT_EQ(kept.rows_skipped, 5u);
  const auto refused = [&](const std::vector<std::size_t>& bad, std::size_t size, const std::string& why) {
    const std::string text = with_faults(bad, size);
    EXPECT_THAT(fault(text), AllOf(HasSubstr(why), testing::Not(HasSubstr("skip_bad_rows"))));
    EXPECT_THAT(fault(text, skip), AllOf(HasSubstr(why), HasSubstr("too much for skip_bad_rows")));
  };
  refused({10, 20, 35, 52, 77, 90}, 101, "6 of 101 rows are bad, the first 3 named above: more than a twentieth");
  refused({10, 35, 98, 99, 100}, 101, "lines 100 to 102 are lost in a row");
  refused({183, 186, 189, 192, 195, 198}, 201, "they lie together, between lines 185 and 200");
  refused({0, 1, 2, 3, 4}, 5, "all of the test");
}

const std::filesystem::path kFolder = test::shipped("../shared/data/cases/machine_files");

/// `1:01:02.5` of a time in seconds: hours, minutes and seconds, or minutes and seconds alone.
std::string clock(double seconds, bool hours, const std::string& decimal = ".", int digits = 3) {
  const auto whole = static_cast<long>(seconds);
  const auto two = [](long part) { return (part < 10 ? "0" : "") + std::to_string(part); };
  std::string text = hours ? two(whole / 3600) + ":" + two(whole / 60 % 60) : std::to_string(whole / 60);
  const double left = seconds - 60.0 * static_cast<double>(whole / 60);
  return text + ":" + (left < 10.0 ? "0" : "") + written(left, digits, decimal);
}

std::string clock_rows(double start, bool hours, const std::string& between = ";", const std::string& decimal = ".",
                       int digits = 3, double every = 0.1) {
  std::string text;
  for (std::size_t i = 0; i < kRows; ++i) {
    text += clock(start + every * static_cast<double>(i), hours, decimal, digits) + between;
    text += written(way_at(i), 4, decimal) + between + written(load_at(i), 3, decimal) + "\n";
  }
  return text;
}

// Clock times are seconds since the first row, over the turn of minutes and hours, whatever the name says of their unit; the account says so.
TEST_F(Machine, ClockTimesAreSecondsSinceTheFirstRow) {
  const std::vector<std::string> files{"Time;Displacement (mm);Load (mN)\n" + clock_rows(3598.5, true),
                                       "Time (hh:mm:ss);Displacement (mm);Load (mN)\n" + clock_rows(45296.25, true),
                                       "Time;Displacement;Load\ns;mm;mN\n" + clock_rows(58.0, false),
                                       "Time,Displacement (mm),Load (mN)\n" + clock_rows(3598.5, true, ","),
                                       "Zeit;Weg (mm);Kraft (mN)\n" + clock_rows(3598.5, true, ";", ","),
                                       "Zeit\tWeg\tKraft\nmm:ss\tmm\tmN\n" + clock_rows(58.0, false, "\t", ",")};
  for (const std::string& file : files) {
    SCOPED_TRACE(file.substr(0, 80));
    const RawTest test = read(file);
    ASSERT_EQ(test.size(), kRows);
    EXPECT_FALSE(test.clock.empty());
    for (std::size_t i = 0; i < kRows; ++i) EXPECT_NEAR(test.time[i], time_at(i), 1e-9) << i;
    EXPECT_EQ(test.force.back(), digits_of(load_at(kRows - 1), 3) * 1e-3);
  }
  const RawTest whole = read("Time;Displacement (mm);Load (mN)\n" + clock_rows(3590.0, true, ";", ".", 0, 1.0));
  EXPECT_EQ(whole.time.back(), static_cast<double>(kRows - 1));
  scene::Problems problems("t.csv");
  const auto prepared =
      prepare(whole, section("files = [\"t.csv\"]\n"), {.area = 1e-3, .height = 0.02, .radius = 0.015}, problems);
  ASSERT_TRUE(prepared.has_value());
  EXPECT_THAT(prepared->account.text(), HasSubstr("clock times, read as seconds since 00:59:50"));
}

// A clock time of two meanings is refused with the line that mends it; so is a clock that is said to be something else.
TEST_F(Machine, ClockTimesOfTwoMeaningsAreRefused) {
  const std::string names = "Time;Displacement (mm);Load (mN)\n";
  EXPECT_THAT(
      fault("Time (s);Displacement (mm);Load (mN)\n" + clock_rows(0.0, false, ";", ".", 0, 1.0)),
      AllOf(HasSubstr("t.csv:2"), HasSubstr("\"0:00\" in \"Time (s)\" is minutes and seconds, or hours and minutes"),
            HasSubstr("write hours, minutes and seconds (00:0:00)")));
  EXPECT_THAT(fault(names + clock_rows(10.0, true), "columns.time = { name = \"Time\", unit = \"min\" }\n"),
              HasSubstr("holds clock times, from \"00:00:10.000\" on, which are read in seconds; leave `unit` out"));
  EXPECT_THAT(fault(names + clock_rows(10.0, true), "columns.displacement = { name = \"Time\", unit = \"mm\" }\n"),
              HasSubstr("which are a time"));
}

struct Known {
  std::string file, keys, specimen;
  std::size_t rows;
  double driven, answering;  ///< of the last row [SI]
};

// The files of the shared folder, by the digits of their last row.
TEST_F(Machine, SharedFilesReadToTheLastDigit) {
  if (!std::filesystem::exists(kFolder)) GTEST_SKIP() << "the shared files are not beside the sources";
  const std::string sweep = "test = \"oscillation\"\n", turn = "test = \"tension\"\n";
  const std::vector<Known> known{{"bluehill.csv", "", kBlock, 101, 8e-3, 23090.706 * 1e-3},
                                 {"stiff.csv", "", kBlock, 101, 8e-3, 135288.859 * 1e-3},
                                 {"zwick.csv", "", kBlock, 101, 8e-3, 23090.706 * 1e-3},
                                 {"savetxt.txt", "", kBlock, 101, 8e-3, 2.309070600388497496e+01},
                                 {"mach1.txt", turn, kBlock, 600, 5.99e-3, 20.01008 * 1e-3 * 9.80665},
                                 {"nmm2.csv", turn, kPoint, 101, 0.3, 0.014166e6},
                                 {"rheo_utf16.csv", sweep, kPoint, 16, 100.0 / (2.0 * M_PI), 999.8},
                                 {"rheo_two.csv", sweep + "interval = 2\n", kPoint, 16, 100.0 / (2.0 * M_PI), 999.8},
                                 {"unht.txt", "", kBlock, 301, 15.0 * 1e-6, 1385.4908 * 1e-6}};
  for (const Known& k : known) {
    SCOPED_TRACE(k.file);
    const RawTest test = read(phantom::text_of(kFolder / k.file), k.keys, k.specimen);
    EXPECT_EQ(test.size(), k.rows);
    EXPECT_DOUBLE_EQ(test.displacement.back(), k.driven);
    EXPECT_DOUBLE_EQ(test.force.back(), k.answering);
  }
}

}  // namespace
}  // namespace glisson::fit::machine_files_test
