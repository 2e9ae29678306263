// The parts of the report that have exact answers: numbers as text, base64, the place of the data, page rows.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "report/base64.h"
#include "report/output_file.h"
#include "report/report_page.h"

namespace glisson {
namespace {

std::string encoded(const std::string& text) { return base64(std::as_bytes(std::span(text.data(), text.size()))); }

// Numbers in files read back as the same double, whatever their size.
TEST(NumberText, ReadsBackAsTheSameNumber) {
  for (const double value : {0.1, 1.0 / 3.0, 5e-324, -1.7976931348623157e308, 1e-9, 123456789.123456789}) {
    EXPECT_EQ(std::strtod(number_text(value).c_str(), nullptr), value) << number_text(value);
  }
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(number_text(-std::numeric_limits<double>::quiet_NaN()), "nan");
}

// The test vectors of RFC 4648, section 10, and the last digits of the alphabet.
TEST(Base64, FollowsTheStandard) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xef\xbe"), "/+++");
  const std::vector<float> one{1.0f};
  EXPECT_EQ(base64_of(std::span<const float>(one)), "AACAPw==") << "little-endian";
}

// The data take the place of the token, and no "<" of theirs survives to end the element they are in.
TEST(ReportPage, PutsTheDataInTheirPlace) {
  const nlohmann::json data{{"text", "</script>"}, {"none", std::numeric_limits<double>::quiet_NaN()}};
  const std::string page = report_page("<a>/*GLISSON_DATA*/</a>", data);
  EXPECT_EQ(page, "<a>{\"none\":null,\"text\":\"\\u003c/script>\"}</a>");
}

// A template without its token, or with two, is a broken build and said to be one.
TEST(ReportPage, RefusesABrokenTemplate) {
  EXPECT_THROW(report_page("<a></a>", {}), std::logic_error);
  EXPECT_THROW(report_page("/*GLISSON_DATA*/ /*GLISSON_DATA*/", {}), std::logic_error);
}

// Bytes that are no UTF-8 (a name from a mesh file) do not keep a report from being written.
TEST(ReportPage, ReplacesWhatIsNoText) {
  const std::string page = report_page("/*GLISSON_DATA*/", {{"name", "caf\xe9"}});
  EXPECT_NE(page.find("caf"), std::string::npos);
}

}  // namespace
}  // namespace glisson
