// Text that is no UTF-8 ends nothing: it goes out as JSON with U+FFFD in its place, whoever brought it; and what comes in as JSON
// is read to a bounded depth, its faults told by key.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "app/program.h"
#include "report/json_field.h"
#include "report/json_text.h"
#include "support/places.h"
#include "view/protocol/messages.h"
#include "view/replay/run_folder.h"

namespace glisson::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kMark = "\xef\xbf\xbd";  // U+FFFD

TEST(JsonText, PutsTheMarkInPlaceOfWhatIsNoText) {
  const std::string text = json_text(nlohmann::json{{"name", "caf\xe9"}});
  EXPECT_EQ(text, std::string("{\"name\":\"caf") + kMark + "\"}");
  EXPECT_EQ(json_text(nlohmann::ordered_json{{"b", "\xff"}, {"a", 1}}),
            std::string("{\"b\":\"") + kMark + "\",\"a\":1}");
  EXPECT_EQ(valid_utf8("caf\xe9 ü €"), std::string("caf") + kMark + " ü €");
  EXPECT_EQ(valid_utf8("plain \"text\"\n"), "plain \"text\"\n");
}

// The reader refuses before anything recurses: a hundred thousand brackets are a message, not a stack that runs out.
TEST(JsonText, ReadsToABoundedDepth) {
  const auto why = [](const std::string& text) -> std::string {
    try {
      parse_json(text);
    } catch (const JsonError& error) {
      return error.what();
    }
    return "";
  };
  const auto nested = [](std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); };
  EXPECT_EQ(why(nested(kDeepestJson)), "");
  EXPECT_EQ(why(nested(kDeepestJson + 2)), "nested deeper than 64 levels");
  EXPECT_EQ(why(std::string(100000, '[')), "nested deeper than 64 levels");
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  EXPECT_EQ(why(objects), "nested deeper than 64 levels");
  EXPECT_EQ(why("{\"a\" 1}"), "not valid JSON at byte 6");
  EXPECT_EQ(why("[1e999]"), "not valid JSON: a number is out of range");
}

TEST(JsonText, TellsWhereAndWhatIsWrong) {
  const nlohmann::json json = parse_json(R"({"tools":[{"name":5}],"end":[1,2]})");
  const auto why = [](auto look) -> std::string {
    try {
      look();
    } catch (const JsonError& error) {
      return error.what();
    }
    return "";
  };
  const JsonField field(json);
  EXPECT_EQ(why([&] { field.at("tools").at(0).at("name").text(); }), "tools[0].name: expected a text, found 5");
  EXPECT_EQ(why([&] { field.at("tools").at(0).at("depth").number(); }), "tools[0]: no key \"depth\"");
  EXPECT_EQ(why([&] { field.at("end").at(2).number(); }), "end: expected a list of 3 or more, found a list of 2");
  EXPECT_EQ(why([&] { field.at("end").text(); }), "end: expected a text, found a list of 2");
}

// One place writes JSON: elsewhere the library's own dump() would throw at the first name of another encoding.
TEST(JsonText, IsTheOnlyPlaceThatWritesJson) {
  for (const char* room : {"src", "apps", "python/src"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(shipped(room))) {
      const std::string name = entry.path().filename().string();
      if (!entry.is_regular_file() || (entry.path().extension() != ".cpp" && entry.path().extension() != ".h"))
        continue;
      if (name == "json_text.cpp" || name == "json_text.h") continue;
      EXPECT_THAT(read_text(entry.path()), Not(HasSubstr(".dump("))) << entry.path() << ": use json_text()";
    }
  }
}

class ViewText : public ProgramTest {
 protected:
  fs::path recorded(const std::string& scene, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run", scene, "--out", "o", "--quiet", "--set", "output.frames=3"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_THAT(run(words), Exits(0));
    return folder_ / "o";
  }
  /// All that a server would say of a run as text; every line of it is JSON.
  std::string said_of(const view::RunFolder& run) {
    view::Snapshot state;
    state.events = run.events;
    std::string all;
    for (const std::string& text :
         {view::notice_message(run.notice + run.title + run.label), view::state_message(state, 1)}) {
      EXPECT_NO_THROW(nlohmann::json::parse(text)) << text;
      all += text;
    }
    return all;
  }
  static std::string untitled() { return small_scene().substr(small_scene().find('\n') + 1); }
};

TEST_F(ViewText, AScenesNameOfAnotherEncoding) {
  const fs::path folder = recorded(write("caf\xe9.toml", untitled()));
  EXPECT_EQ(read_json(folder / "main/summary.json")["scene"], std::string("caf") + kMark);
  EXPECT_EQ(report_data(folder / "report.html")["scenes"][0]["title"], std::string("caf") + kMark);
  const view::RunFolder shown = view::open_run(folder, "");
  EXPECT_EQ(shown.notice, "");
  said_of(shown);
  EXPECT_THAT(read_text(folder / "main/view.jsonl"), HasSubstr(std::string("\"scene\":\"caf") + kMark));
}

TEST_F(ViewText, AnOptionOfAnotherEncoding) {
  const fs::path folder = recorded(write("s.toml", small_scene()), {"--set",
                                                                    "title=R\xfc"
                                                                    "ckenmark"});
  EXPECT_EQ(report_data(folder / "report.html")["scenes"][0]["title"], std::string("R") + kMark + "ckenmark");
  EXPECT_EQ(view::open_run(folder, "").notice, "");
  EXPECT_THAT(run({"check", "o/scene.toml"}), Exits(0)) << "the comment that names the option is UTF-8";
}

TEST_F(ViewText, AFolderAndAVariantOfAnotherEncoding) {
  const fs::path folder = recorded(write("s.toml", small_scene()));
  const fs::path other = folder_ /
                         "r\xfc"
                         "n";
  fs::rename(folder, other);
  fs::rename(other / "main", other / "m\xe4in");
  const view::RunFolder shown = view::open_run(other, "");
  EXPECT_EQ(shown.variant, "m\xe4in");
  said_of(shown);
  try {
    view::open_run(other, "none");
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(view::notice_message(error.what()), HasSubstr(kMark));
  }
}

// A byte flipped anywhere leaves a run that opens, and words that can be sent.
TEST_F(ViewText, FlippedBytesInViewJsonlAndEvents) {
  const fs::path folder = recorded(write("s.toml", small_scene())), file = folder / "main/view.jsonl";
  const std::string whole = read_text(file);
  for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 60) {
    std::string bad = whole;
    bad[at] = '\xff';
    std::ofstream(file, std::ios::binary) << bad;
    said_of(view::open_run(folder, ""));
  }
  std::ofstream(folder / "main/events.csv") << "time_s,depth_m,event,instrument\n0.001,0.002,pun\xfeture,n\xff"
                                               "dle\n";
  const view::RunFolder shown = view::open_run(folder, "");
  ASSERT_EQ(shown.events.size(), 1u);
  EXPECT_THAT(said_of(shown), HasSubstr(std::string("pun") + kMark + "ture"));
}

// Scenes are UTF-8, as TOML says: other bytes are refused with their place.
TEST_F(ViewText, ASceneIsUtf8) {
  std::string text = small_scene();
  text.replace(text.find("Small press"), 5, "Sm\xe4ll");
  const Outcome outcome = run({"run", write("s.toml", text), "--out", "o"});
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, HasSubstr("s.toml:1:"));
  EXPECT_THAT(outcome.err, HasSubstr("invalid utf-8"));
}

}  // namespace
}  // namespace glisson::test
