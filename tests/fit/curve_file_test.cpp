// Files as laboratories write them give the same numbers however they are separated, marked, encoded and headed; the ten
// phantom files read as they are and carry the published stresses.
#include "fit/data/curve_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "fit/phantom.h"

namespace glisson::fit {
namespace {

using phantom::Folder;
using phantom::have_phantoms;
using phantom::kPhantoms;
using phantom::kPhantomSize;
using phantom::spec_of;
using phantom::text_of;
using testing::ElementsAre;
using testing::HasSubstr;

CurveFile parsed(std::string text, const TextSpec& spec = {}) {
  return parse_curve_file(std::move(text), "t.csv", spec);
}

std::string fault(std::string text, const TextSpec& spec = {}) {
  try {
    parsed(std::move(text), spec);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

/// All fields of all rows as numbers.
std::vector<double> numbers(const CurveFile& file) {
  std::vector<double> all;
  for (const auto& row : file.rows) {
    for (const auto& f : row.fields) all.push_back(parse_number(f.text, file.decimal).value_or(std::nan("")));
  }
  return all;
}

const std::vector<double> kSame{0.0, 0.5, -1.25, 0.1, 1.5, 1e3};

// One table written in every way that is meant to be understood.
TEST(CurveFile, FindsSeparatorAndDecimalMark) {
  const std::vector<std::string> ways{
      "Time (s),Depth (mm),Load (N)\n0,0.5,-1.25\n0.1,1.5,1e3\n",
      "Time (s);Depth (mm);Load (N)\n0;0,5;-1,25\n0,1;1,5;1e3\n",
      "Time (s)\tDepth (mm)\tLoad (N)\n0\t0,5\t-1,25\n0,1\t1,5\t1,0E+03\n",
      "Time (s)\tDepth (mm)\tLoad (N)\n0\t0.5\t-1.25\n0.1\t1.5\t+1e3\n",
      "\"Time (s)\",\"Depth (mm)\",\"Load (N)\"\n\"0\",\"0,5\",\"-1,25\"\n\"0,1\",\"1,5\",\"1000\"\n",
      "\xEF\xBB\xBFTime (s) ; Depth (mm) ; Load (N) ;\r\n\r\n0 ; 0.5 ; -1.25;\r\n 0.1;1.5;1000 ;;\r\n\r\n",
      "sep=;\nTest of liver; 12.5.\n\nTime (s);Depth (mm);Load (N)\r0;0,5;-1,25\r0,1;1,5;1000\r",
      "Time,Depth,Load\n(s),(mm),(N)\n0,0.5,-1.25\n0.1,1.5,1e3\nEnd of test\n",
      "Time;Depth;Load\ns;mm;N\n0;0,5;-1,25\n0,1;1,5;1000\n",
  };
  for (const std::string& way : ways) {
    const CurveFile file = parsed(way);
    EXPECT_EQ(numbers(file), kSame) << way;
    EXPECT_THAT(file.units, ElementsAre("s", "mm", "N")) << way;
  }
}

TEST(CurveFile, CountsLinesAsAnEditorDoes) {
  const CurveFile file = parsed("prose\r\n\r\na (s);b (mm)\r\n\r\n0,5;1\r\n1,5;2\r\n");
  EXPECT_EQ(file.names_line, 3u);
  EXPECT_EQ(file.rows[0].line, 5u);
  EXPECT_EQ(file.rows[1].line, 6u);
  EXPECT_EQ(file.rows[1].fields[1].column, 5u);
}

// A byte of Latin-1 is the sign µ, not a fault, and a name may hold the separator in quotes.
TEST(CurveFile, ReadsOldEncodingsAndQuotedNames) {
  const CurveFile file = parsed("Time (s),\"Depth, \"\"tip\"\" (\xB5m)\",x/mN\n0,1,2\n1,2,3\n");
  EXPECT_THAT(file.names, ElementsAre("Time (s)", "Depth, \"tip\" (µm)", "x/mN"));
  EXPECT_THAT(file.units, ElementsAre("s", "µm", "mN"));
}

TEST(CurveFile, DoesAsItIsTold) {
  const std::string text = "a,b\nc,d\n1,2\n3,4\n";
  EXPECT_THAT(parsed(text).names, ElementsAre("c", "d"));
  TextSpec spec;
  spec.decimal = ',';
  EXPECT_EQ(numbers(parsed("a;b\n1;2,5\n3;4\n", spec)), (std::vector<double>{1, 2.5, 3, 4}));
  spec.decimal = '.';
  EXPECT_THAT(fault("a;b\n1,5;2,5\n3,5;4,5\n", spec), HasSubstr("no rows of numbers"));
  spec.names_line = 7;
  EXPECT_THAT(fault(text, spec), HasSubstr("t.csv:7:1: is said to hold the columns' names (`text.names_line`)"));
}

TEST(CurveFile, SaysWhatIsNoTable) {
  EXPECT_THAT(fault(""), HasSubstr("t.csv:1:1: is empty; expected a line of names and rows of numbers"));
  EXPECT_THAT(fault(" \r\n\n"), HasSubstr("is empty"));
  EXPECT_THAT(fault("only\nwords\n"), HasSubstr("has no rows of numbers"));
  EXPECT_THAT(fault(std::string("a,b\n1,2\0", 9)), HasSubstr("is not text"));
  EXPECT_THAT(phantom::complaint(spec_of({"/no/such.csv"})), HasSubstr("/no/such.csv: cannot be read; check the path"));
}

// Marks of thousands part groups of three, the first not 0, and are one all through.
TEST(CurveFile, ReadsThousandsAndNoHalfNumbers) {
  EXPECT_EQ(parse_number("1.234,5", ','), 1234.5);
  EXPECT_EQ(parse_number("-1,234,567.5", '.'), -1234567.5);
  EXPECT_EQ(parse_number("−1 234,5", ','), -1234.5);
  for (const char* half : {"1,23.5", "1,2345", "0,123.5", "1234,567.5", "1,234'567.5", ",123", "1,234,", "--1", "+-1"})
    EXPECT_EQ(parse_number(half, '.'), std::nullopt) << half;
  EXPECT_EQ(parse_number("1.5 N", '.'), std::nullopt);
  EXPECT_EQ(parse_number("nan", '.'), std::nullopt);
  EXPECT_EQ(parse_number("1e999", '.'), std::nullopt);
  EXPECT_EQ(parse_number("", '.'), std::nullopt);
  EXPECT_EQ(parse_number(" +1,5E-3 ", ','), 1.5e-3);
}

// Random bytes and broken lines of a sound file: a table or a message, nothing else.
RC_GTEST_PROP(CurveFileProperty, AnyBytesGiveATableOrAMessage, (const std::string& bytes)) {
  try {
    RC_ASSERT(!parsed(bytes).rows.empty());
  } catch (const SceneError& error) {
    RC_ASSERT(std::string_view(error.what()).starts_with("t.csv"));
  }
}

// Stress at a strain, the mean over bins of a file's rows.
double stress_at(const Curve& curve, double strain) {
  const double x = strain * *kPhantomSize.height;
  const auto above = std::lower_bound(curve.displacement.begin(), curve.displacement.end(), x);
  const auto i = static_cast<std::size_t>(above - curve.displacement.begin());
  const double part = (x - curve.displacement[i - 1]) / (curve.displacement[i] - curve.displacement[i - 1]);
  return (curve.force[i - 1] + part * (curve.force[i] - curve.force[i - 1])) / *kPhantomSize.area * 1e-3;
}

struct Published {
  std::string mix;
  std::vector<double> mean, deviation;  ///< of ten runs at 5, 10, 20, 30, 40, 50, 60 % [kPa], [Dawood2026]
};
const std::vector<double> kStrains{0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
const std::vector<Published> kPublished{
    {"EF10_100T", {.29, .66, 1.48, 2.54, 4.33, 8.33, 19.23}, {.05, .06, .08, .12, .22, .46, 1.08}},
    {"EF10_75T", {.47, .99, 2.18, 3.68, 6.23, 12.05, 28.71}, {.01, .01, .03, .06, .12, .29, .95}},
};

DataSpec phantom(const std::string& mix) {
  DataSpec spec;
  for (int i = 1; i <= 5; ++i) spec.files.push_back(mix + "_A" + std::to_string(i) + ".csv");
  return spec;
}

// The five files here are half of the ten runs that the published means are of: their mean lies from that of all ten by
// sd √(1/5 − 1/10) = 0.32 sd if drawn at random; they are repetitions on one specimen, so by up to the whole sd between
// the two specimens. One sd, and the rounding of the table.
TEST(Phantom, CarriesThePublishedStresses) {
  if (!have_phantoms()) GTEST_SKIP() << "the phantom files are not beside the sources";
  for (const Published& mix : kPublished) {
    const auto curves = load_curves(phantom(mix.mix), kPhantomSize, kPhantoms);
    ASSERT_EQ(curves.size(), 5u);
    for (std::size_t s = 0; s < kStrains.size(); ++s) {
      double mean = 0.0;
      for (const PreparedCurve& c : curves) mean += stress_at(c.curve, kStrains[s]) / 5.0;
      EXPECT_NEAR(mean, mix.mean[s], mix.deviation[s] + 0.005) << mix.mix << " at " << kStrains[s];
    }
  }
}

/// Scatter of the five files at a strain [kPa].
double scatter(const std::vector<PreparedCurve>& curves, double strain) {
  double mean = 0.0, squares = 0.0;
  for (const PreparedCurve& c : curves) mean += stress_at(c.curve, strain) / 5.0;
  for (const PreparedCurve& c : curves) squares += std::pow(stress_at(c.curve, strain) - mean, 2.0);
  return std::sqrt(squares / 4.0);
}

// Two of the five files of EF10_100T begin a quarter of a millimetre before the plate touches, by the sign of their force.
// Counted from contact, the repetitions agree far better: 0.004 kPa instead of 0.033 at 5 %, 0.005 instead of 0.037 at 10 %;
// a factor of 4 is asked for, so that the bound does not hang on the last digit.
TEST(Phantom, AgreesBetterCountedFromContact) {
  if (!have_phantoms()) GTEST_SKIP() << "the phantom files are not beside the sources";
  DataSpec spec = phantom("EF10_100T");
  const auto recorded = load_curves(spec, kPhantomSize, kPhantoms);
  spec.contact.kind = ContactKind::detect;
  const auto touched = load_curves(spec, kPhantomSize, kPhantoms);
  EXPECT_EQ(touched[1].account.contact_how, "extrapolated");
  EXPECT_NEAR(touched[1].account.contact, 0.26e-3, 0.02e-3);
  EXPECT_NEAR(touched[4].account.contact, 0.24e-3, 0.02e-3);
  for (const double strain : {0.05, 0.1})
    EXPECT_LT(scatter(touched, strain), scatter(recorded, strain) / 4.0) << strain;
}

}  // namespace
}  // namespace glisson::fit
