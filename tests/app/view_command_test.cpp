// glisson view: the address it prints opens the page, Ctrl-C ends it, and what would open it to others is refused with a reason.
#include <chrono>
#include <csignal>
#include <regex>
#include <thread>

#include "app/program.h"
#include "app/view_client.h"

namespace glisson::test {
namespace {

class ViewCommand : public ProgramTest {
 protected:
  std::vector<std::string> with(std::vector<std::string> more) const {
    more.insert(more.begin(), {"view", write("s.toml", small_scene())});
    return more;
  }
  /// The address printed, in its parts: port and token.
  static std::smatch address_of(const Started& program, std::string& out) {
    std::smatch found;
    const std::regex address("http://127\\.0\\.0\\.1:([0-9]+)(/\\?token=(\\S+))");
    for (int i = 0; i < 1500; ++i) {
      out = program.output_so_far();
      if (out.find("Ctrl-C") != std::string::npos && std::regex_search(out, found, address)) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return found;
  }
};

TEST_F(ViewCommand, PrintsAnAddressThatOpensAndEndsByCtrlC) {
  Started program = start(with({}));
  std::string out;
  const std::smatch address = address_of(program, out);
  ASSERT_EQ(address.size(), 4u) << out;
  EXPECT_EQ(address[3].length(), 32) << "a random token";
  const auto port = static_cast<unsigned short>(std::stoi(address[1]));
  const Answer page = get(port, address[2], "127.0.0.1:" + address[1].str());
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.text.find("<title>Glisson live view</title>"), std::string::npos);
  EXPECT_EQ(get(port, "/", "127.0.0.1:" + address[1].str()).status, 403);
  const ViewClient watching(port, "token=" + address[3].str());
  EXPECT_EQ(watching.status(), 101);
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_THAT(outcome, Exits(0));
  EXPECT_EQ(outcome.err, "");
}

TEST_F(ViewCommand, TakesATokenOfOnesOwn) {
  Started program = start(with({"--token", "sixteen-letters-x"}));
  std::string out;
  ASSERT_EQ(address_of(program, out)[3], "sixteen-letters-x") << out;
  program.signal(SIGTERM);
  EXPECT_THAT(program.wait(), Exits(0));
}

TEST_F(ViewCommand, SaysWhyItWillNot) {
  const auto why = [&](std::vector<std::string> options) {
    const Outcome outcome = run(with(std::move(options)));
    EXPECT_THAT(outcome, Exits(2));
    return outcome.err;
  };
  EXPECT_NE(why({"--host", "0.0.0.0"}).find("give a --token TEXT of 16 characters or more"), std::string::npos);
  EXPECT_NE(why({"--token", "short"}).find("16 characters or more"), std::string::npos);
  EXPECT_NE(why({"--token", "has spaces in its text"}).find("letters, digits"), std::string::npos);
  EXPECT_NE(why({"--host", "example.org"}).find("an address in digits or localhost"), std::string::npos);
  EXPECT_NE(why({"--port", "99999"}).find("--port"), std::string::npos);
}

}  // namespace
}  // namespace glisson::test
