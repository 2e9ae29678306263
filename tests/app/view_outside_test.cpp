// A run's folder may have been made by anyone: what is no regular file is refused at once, what is wrong inside is told by file
// and key in plain words, and the rest is shown.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "app/program.h"
#include "view/replay/run_folder.h"

namespace glisson::test::view_outside_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class ViewOutside : public ProgramTest {
 protected:
  void SetUp() override {
    ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet", "--set", "output.frames=3"}),
                Exits(0));
  }
  std::string notice_with(const std::string& file, const std::string& text) const {
    std::ofstream(own() / file, std::ios::binary) << text;
    return view::open_run(folder_ / "o", "").notice;
  }
  fs::path own() const { return folder_ / "o/main"; }
};

constexpr const char* kHead = R"({"format":1,"scene":"s","label":"l","held":[],"driven":[],"instruments":[],"tools":)";

TEST_F(ViewOutside, WrongTypesAreToldByFileAndKey) {
  EXPECT_THAT(
      notice_with("summary.json", R"({"end":5})"),
      AllOf(HasSubstr("summary.json is damaged: end: expected a text, found 5"), Not(HasSubstr("json.exception"))));
  EXPECT_THAT(notice_with("summary.json", "[1]"), HasSubstr("expected an object, found a list of 1"));
  EXPECT_THAT(notice_with("summary.json", "{"), HasSubstr("summary.json is damaged: not valid JSON at byte"));
  EXPECT_THAT(notice_with("summary.json", std::string(100000, '[')), HasSubstr("nested deeper than 64 levels"));
  EXPECT_THAT(notice_with("summary.json", R"({"end":"finished"})"), "");
  const auto line = [](const std::string& what) { return "view.jsonl, line " + what; };
  EXPECT_THAT(notice_with("view.jsonl", kHead + std::string("[{\"name\":1}]}\n")),
              AllOf(HasSubstr(line("1: tools[0].name: expected a text, found 1")), Not(HasSubstr("json.exception"))));
  EXPECT_THAT(notice_with("view.jsonl", kHead + std::string("[]}\n{\"time_s\":\"x\"}\n")),
              HasSubstr(line("2: time_s: expected a number, found \"x\"")));
  EXPECT_THAT(
      notice_with("view.jsonl",
                  kHead + std::string("[]}\n{\"time_s\":0,\"instruments\":[{\"points\":[null,1,2],\"axes\":[]}]}\n")),
      HasSubstr(line("2: instruments[0].points[0]: expected a number, found null")));
  EXPECT_THAT(
      notice_with("view.jsonl", kHead + std::string("[]}\n{\"time_s\":0,\"instruments\":[],\"torn\":[1,2,-3]}\n")),
      HasSubstr(line("2: torn[2]: expected the number of a vertex")));
  EXPECT_THAT(notice_with("view.jsonl", std::string(100000, '[') + "\n"),
              HasSubstr(line("1: nested deeper than 64 levels")));
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  std::string head = kHead + std::string("[]}\n");
  head.replace(head.find("\"instruments\":[]"), 16, "\"instruments\":" + deep);
  EXPECT_THAT(notice_with("view.jsonl", head), HasSubstr(line("1: nested deeper than 64 levels")));
}

// Reading a pipe would wait for a writer that never comes; a device may never end.
TEST_F(ViewOutside, WhatIsNoRegularFileIsRefused) {
  for (const char* name : {"view.jsonl", "events.csv", "forces.csv", "summary.json", "../scene.toml"}) {
    const fs::path file = own() / name, aside = folder_ / "aside";
    const bool was = fs::exists(file);
    if (was) fs::rename(file, aside);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    const Outcome outcome = run({"view", "o"});
    EXPECT_THAT(outcome, Exits(2)) << name;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(file.filename().string()), HasSubstr("not a regular file"))) << name;
    fs::remove(file);
    fs::create_symlink("/dev/zero", file);
    EXPECT_THROW(view::open_run(folder_ / "o", ""), std::invalid_argument) << name;
    fs::remove(file);
    if (was) fs::rename(aside, file);
  }
  EXPECT_EQ(view::open_run(folder_ / "o", "").notice, "");
}

}  // namespace
}  // namespace glisson::test::view_outside_test
