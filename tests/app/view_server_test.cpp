// The live server lets in who may come in, keeps who misbehaves out, and lets one viewer lead.
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <random>
#include <thread>

#include "app/program.h"
#include "app/view_client.h"
#include "view/engine/engine.h"
#include "view/server/access.h"
#include "view/server/lead.h"
#include "view/server/server.h"

namespace glisson::view::view_server_test {
namespace {

using namespace std::chrono_literals;
using test::Answer;
using test::Heard;
using test::ViewClient;

constexpr const char* kToken = "a-token-of-a-test";
constexpr int kBusy = 50;  ///< how much later things may be on a machine that does much else
constexpr std::string_view kPage = "<!doctype html><title>the page</title>";

class LiveServer : public ::testing::Test {
 protected:
  LiveServer() : engine_(parse_scene(test::small_scene(), "view.toml", ".").variants.front(), {}) {}
  void SetUp() override { open({.token = kToken}); }
  void TearDown() override {
    server_->stop();
    engine_.stop();
  }
  void open(const ServerOptions& options) {
    server_ = std::make_unique<Server>(engine_, SceneFacts{"a scene", "main", "0", "[]", {}}, kPage, options);
    engine_.start();
    server_->start();
  }
  std::string host() const { return "127.0.0.1:" + std::to_string(server_->port()); }
  std::string query(const std::string& more = "") const { return std::string("token=") + kToken + more; }
  unsigned short port() const { return server_->port(); }

  Engine engine_;
  std::unique_ptr<Server> server_;
};

std::uint32_t u32_at(const std::string& bytes, std::size_t at) {
  std::uint32_t x = 0;
  for (std::size_t i = 0; i < 4; ++i)
    x |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return x;
}
float f32_at(const std::string& bytes, std::size_t at) { return std::bit_cast<float>(u32_at(bytes, at)); }

// A recording goes to who knows the token, once there is one, and nobody else learns whether there is.
TEST_F(LiveServer, HandsOutTheRecordingByTokenOnly) {
  EXPECT_EQ(test::get(port(), "/recording?" + query(), host()).status, 404) << "nothing is recorded here";
  server_->stop();
  const auto writer = [](std::shared_ptr<const Recording> kept, const std::vector<double>&) {
    return std::vector{text_file("frames", std::to_string(kept->frames()))};
  };
  server_ =
      std::make_unique<Server>(engine_, SceneFacts{"", "", "", "[]", writer}, kPage, ServerOptions{.token = kToken});
  engine_.post({.kind = CommandKind::reset});  // what the first server has heard of belongs to no recording
  server_->start();
  test::Answer answer;
  for (int i = 0; i < 3000 && answer.status != 200; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    answer = test::get(port(), "/recording?" + query(), host());
  }
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(test::get(port(), "/recording?token=wrong", host()).status, 403);
  EXPECT_EQ(test::get(port(), "/recording?" + query(), host(), "Origin: http://evil.example\r\n").status, 403);
}

// Secrets are equal only where every character is, and an empty one opens nothing.
TEST(LiveAccess, ComparesSecrets) {
  EXPECT_TRUE(same_secret("abcdef", "abcdef"));
  for (const char* wrong : {"", "abcde", "abcdefg", "abcdeg", "Abcdef", "abcdefabcdef"})
    EXPECT_FALSE(same_secret(wrong, "abcdef"));
  EXPECT_FALSE(same_secret("", ""));
  EXPECT_NE(random_key(), random_key());
  EXPECT_EQ(random_key().size(), 32u);
}

// A Host header is ours only where no DNS could have put another page's name there.
TEST(LiveAccess, KnowsItsHosts) {
  const Place here{"127.0.0.1", 8080, true};
  for (const char* ours : {"127.0.0.1:8080", "localhost:8080", "[::1]:8080"})
    EXPECT_TRUE(host_allowed(ours, here)) << ours;
  for (const char* other :
       {"", "127.0.0.1", "127.0.0.1:80", "evil.example:8080", "10.0.0.7:8080", "localhost.evil.example:8080"})
    EXPECT_FALSE(host_allowed(other, here)) << other;
  const Place anywhere{"0.0.0.0", 8080, false};
  EXPECT_TRUE(host_allowed("10.0.0.7:8080", anywhere));
  EXPECT_TRUE(host_allowed("[fe80::1]:8080", anywhere));
  EXPECT_FALSE(host_allowed("evil.example:8080", anywhere));
  EXPECT_TRUE(origin_allowed("http://127.0.0.1:8080", "127.0.0.1:8080"));
  EXPECT_TRUE(origin_allowed("", "127.0.0.1:8080"));
  for (const char* other : {"null", "http://evil.example", "https://127.0.0.1:8080", "http://127.0.0.1:8081"})
    EXPECT_FALSE(origin_allowed(other, "127.0.0.1:8080")) << other;
}

// A bucket lets a burst through, then its rate.
TEST(LiveAccess, PacesMessages) {
  const Pacer::Clock::time_point start{};
  Pacer pacer(10.0, 3.0, start);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(pacer.take(start));
  EXPECT_FALSE(pacer.take(start));
  EXPECT_TRUE(pacer.take(start + 100ms));
  EXPECT_FALSE(pacer.take(start + 150ms));
  EXPECT_TRUE(pacer.take(start + 200ms));
}

// The first leads; who is cut off has the lead again when back in time, and loses it when late.
TEST(LiveLead, IsKeptForAWhile) {
  const Lead::Clock::time_point t{};
  Lead lead(10s);
  lead.came("a", t);
  lead.came("b", t);
  EXPECT_TRUE(lead.leads("a"));
  EXPECT_FALSE(lead.take("b", t));
  lead.went("a", t);
  EXPECT_FALSE(lead.take("b", t + 9s));
  lead.came("a", t + 9s);
  EXPECT_TRUE(lead.leads("a"));
  EXPECT_FALSE(lead.take("b", t + 30s)) << "it came back";
  lead.went("a", t + 30s);
  EXPECT_FALSE(lead.led(t + 41s));
  EXPECT_TRUE(lead.take("b", t + 41s));
  lead.give("b");
  EXPECT_TRUE(lead.take("a", t + 42s));
}

// The page is given to who has the token, under our name, and nothing else is given to anyone.
TEST_F(LiveServer, ServesOnePageToWhoHasTheToken) {
  const Answer page = test::get(port(), "/?" + query(), host());
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.text.find(kPage), std::string::npos);
  EXPECT_NE(page.text.find("Content-Security-Policy: default-src 'none'"), std::string::npos);
  EXPECT_NE(page.text.find("Referrer-Policy: no-referrer"), std::string::npos);
  for (const char* wrong : {"/", "/?token=", "/?token=a-token-of-a-tess", "/?token=a-token-of-a-test2"})
    EXPECT_EQ(test::get(port(), wrong, host()).status, 403) << wrong;
  for (const char* file : {"/etc/passwd", "/../../etc/passwd", "/live.html", "//", "/%2e%2e/x"})
    EXPECT_EQ(test::get(port(), file + std::string("?") + query(), host()).status, 404) << file;
  EXPECT_EQ(test::get(port(), "/?" + query(), "evil.example:" + std::to_string(port())).status, 421);
  EXPECT_EQ(test::get(port(), "/?" + query(), host(), "Origin: http://evil.example\r\n").status, 403);
  EXPECT_EQ(test::get(port(), "/stream?" + query(), host()).status, 426);
}

TEST_F(LiveServer, RefusesStrangersAtTheStream) {
  EXPECT_EQ(ViewClient(port(), "token=wrong").status(), 403);
  EXPECT_EQ(ViewClient(port(), query(), "Origin: http://evil.example\r\n").status(), 403);
  EXPECT_EQ(ViewClient(port(), query(), "Origin: null\r\n").status(), 403);
  EXPECT_EQ(ViewClient(port(), query(), "Origin: http://" + host() + "\r\n").status(), 101);
}

// A viewer is told the scene, gets the skin before the first frame, and frames that go on.
TEST_F(LiveServer, StreamsTheBody) {
  ViewClient viewer(port(), query());
  ASSERT_EQ(viewer.status(), 101);
  const nlohmann::json hello = viewer.wait_for("hello");
  EXPECT_EQ(hello["title"], "a scene");
  EXPECT_EQ(hello["tets"], 48);
  EXPECT_EQ(hello["tools"][0]["name"], "tool");
  const std::string keyframe = viewer.wait_for_binary(1);
  const std::uint32_t vertices = u32_at(keyframe, 8), triangles = u32_at(keyframe, 12);
  EXPECT_EQ(vertices, 26u) << "all but the one in the middle";
  EXPECT_EQ(triangles, 48u);
  EXPECT_EQ(keyframe.size(), (16 + 13 * vertices + 13 * triangles + 3) / 4 * 4 + 8) << "no name, no region";
  viewer.send({.kind = CommandKind::place, .sequence = 9, .values = {0.001f, 0.0f, 0.0f}});
  std::string frame;
  for (int i = 0; i < 500 && (frame.empty() || f32_at(frame, 64) < 0.000995f); ++i) frame = viewer.wait_for_binary(2);
  ASSERT_FALSE(frame.empty());
  EXPECT_EQ(u32_at(frame, 4), u32_at(keyframe, 4)) << "the frame names its keyframe";
  EXPECT_EQ(u32_at(frame, 12), 9u) << "the act it shows";
  EXPECT_NEAR(f32_at(frame, 64), 0.001, 1e-5) << "depth of the tool";
  EXPECT_LT(f32_at(frame, 76), 0.0f) << "it presses down";
  EXPECT_NEAR(f32_at(frame, 52), 0.001, 3e-4) << "the largest displacement";
  EXPECT_EQ(frame.size(), 64 + 64 + 7 * vertices);
  EXPECT_EQ(frame[3], 1) << "the intensity, unless a viewer asks for another field";
  EXPECT_GT(u32_at(viewer.wait_for_binary(3), 4), 0u) << "forces of the frames between";
}

// Each viewer is shown the field it asks for, with or without the lead; one that is none is refused.
TEST_F(LiveServer, ColoursForEachViewer) {
  ViewClient first(port(), query()), second(port(), query()), third(port(), query());
  const std::size_t vertices = u32_at(first.wait_for_binary(1), 8);
  second.send({.kind = CommandKind::colour, .sequence = 1, .index = 3});
  third.send({.kind = CommandKind::colour, .sequence = 1, .index = 0});
  const auto wait_for_field = [](ViewClient& viewer, int field) {
    std::string frame = viewer.wait_for_binary(2);
    for (int i = 0; i < 500 && !frame.empty() && frame[3] != field; ++i) frame = viewer.wait_for_binary(2);
    return frame;
  };
  EXPECT_EQ(wait_for_field(second, 3).size(), 64 + 64 + 7 * vertices);
  EXPECT_EQ(wait_for_field(third, 0).size(), 64 + 64 + 6 * vertices);
  EXPECT_EQ(first.wait_for_binary(2)[3], 1);
  third.send({.kind = CommandKind::colour, .sequence = 2, .index = kFields});
  EXPECT_EQ(third.wait_for_close().text, "there is no such field");
}

// One leads, the others watch: what they send moves nothing, until the lead is given away.
TEST_F(LiveServer, OneLeads) {
  ViewClient first(port(), query());
  EXPECT_EQ(first.wait_for("role")["drives"], true);
  ViewClient second(port(), query());
  const nlohmann::json role = second.wait_for("role");
  EXPECT_EQ(role["drives"], false);
  EXPECT_EQ(role["viewers"], 2);
  second.send({.kind = CommandKind::pause, .sequence = 4, .index = 1});
  second.send({.kind = CommandKind::take, .sequence = 5});
  EXPECT_EQ(second.wait_for("role")["drives"], false);
  EXPECT_EQ(second.wait_for_binary(2)[1] & 1, 0) << "it is not paused";
  first.send({.kind = CommandKind::give, .sequence = 1});
  second.send({.kind = CommandKind::take, .sequence = 6});
  nlohmann::json now = second.wait_for("role");
  for (int i = 0; i < 5 && now["drives"] != true; ++i) {  // the two messages may come in either order
    second.send({.kind = CommandKind::take, .sequence = 7});
    now = second.wait_for("role");
  }
  EXPECT_EQ(now["drives"], true);
  second.send({.kind = CommandKind::pause, .sequence = 8, .index = 1});
  bool paused = false;
  for (int i = 0; i < 300 && !paused; ++i) paused = (second.wait_for_binary(2)[1] & 1) != 0;
  EXPECT_TRUE(paused);
}

// A viewer whose line was cut comes back as itself, with the lead; a key that nobody has is a new viewer.
TEST_F(LiveServer, ReconnectGoesOn) {
  std::string session;
  {
    ViewClient first(port(), query());
    session = first.wait_for("hello")["session"];
  }
  ViewClient other(port(), query());
  EXPECT_EQ(other.wait_for("role")["drives"], false) << "the lead is kept for the first";
  ViewClient again(port(), query("&session=" + session));
  EXPECT_EQ(again.wait_for("hello")["session"], session);
  EXPECT_EQ(again.wait_for("role")["drives"], true);
  EXPECT_FALSE(again.wait_for_binary(1).empty()) << "the skin comes anew";
  ViewClient elsewhere(port(), query("&session=" + session));
  EXPECT_EQ(elsewhere.wait_for("role")["drives"], true);
  EXPECT_EQ(again.wait_for_close().text, "continued elsewhere");
}

// A key that is none is not taken over, nor sent back: bytes that are no text would be no JSON.
TEST_F(LiveServer, GivesANewKeyForOneThatIsNone) {
  for (const std::string& session :
       {std::string(32, '\xff'), std::string(32, '"'), std::string(32, 'g'), std::string(31, 'a')}) {
    ViewClient viewer(port(), query("&session=" + session));
    if (viewer.status() != 101) continue;  // the bytes were no request
    const nlohmann::json hello = viewer.wait_for("hello");
    ASSERT_TRUE(hello.is_object()) << session;
    EXPECT_TRUE(is_key(hello["session"].get<std::string>()));
    EXPECT_NE(hello["session"], session);
  }
}

// A flood of pings, which are no messages, ends the line like one of messages; that of others goes on.
TEST_F(LiveServer, LimitsPings) {
  ViewClient calm(port(), query()), flood(port(), query());
  for (int i = 0; i < 3000; ++i) flood.send_frame(9, "");
  bool ended = false;
  for (int i = 0; i < 5000 && !ended; ++i) ended = !flood.hear().has_value();
  EXPECT_TRUE(ended);
  EXPECT_FALSE(calm.wait_for_binary(2).empty());
}

// What no page sends ends the connection with a reason, and the server goes on.
TEST_F(LiveServer, ClosesOnWhatIsMalformed) {
  const auto reason = [&](int code, const std::string& payload) {
    ViewClient viewer(port(), query());
    viewer.send_frame(code, payload);
    return viewer.wait_for_close();
  };
  EXPECT_EQ(reason(1, "{}").close_code, 1003);
  EXPECT_EQ(reason(2, "short").text, "a message has 8 bytes or more");
  EXPECT_EQ(reason(2, std::string("\x63\0\0\0\0\0\0\0", 8)).text, "unknown kind of message");
  EXPECT_EQ(reason(2, std::string(37, '\1')).close_code, 1009);
  EXPECT_EQ(reason(2, std::string(1 << 20, '\xff')).close_code, 1009) << "a mebibyte of rubbish";
  const Command nan{.kind = CommandKind::speed, .values = {std::nanf("")}};
  EXPECT_EQ(reason(2, encode_command(nan)).text, "a number is not finite");
  EXPECT_EQ(ViewClient(port(), query()).wait_for("hello")["title"], "a scene");
}

// Places for a tool, a hand or a blade that make no sense are counted and told, and the line goes on: the last good one stays.
TEST_F(LiveServer, CountsPlacesThatMakeNoSense) {
  ViewClient viewer(port(), query());
  const float nan = std::nanf(""), far = 2.0f * payload_of(CommandKind::place).largest;
  for (const Command& bad :
       {Command{.kind = CommandKind::place, .values = {nan, 0.0f, 0.0f}},
        Command{.kind = CommandKind::drag, .values = {0.0f, far, 0.0f}},
        Command{.kind = CommandKind::cut, .index = 1, .values = {0.0f, 0.0f, 0.0f, 0.0f, nan, 0.0f}}}) {
    viewer.send(bad);
  }
  std::string told;
  for (int i = 0; i < 100 && !told.starts_with("3 places"); ++i) {
    told = viewer.wait_for("notice")["text"].get<std::string>();
  }
  EXPECT_EQ(told, "3 places for a tool or hand rejected (the last: a number is not finite); the last good one stays.");
  EXPECT_FALSE(viewer.wait_for_binary(2).empty());
}

// Too many messages end the connection; a page's 60 a second do not.
TEST_F(LiveServer, LimitsTheRate) {
  ViewClient calm(port(), query());
  for (std::uint32_t i = 0; i < 200; ++i) calm.send({.kind = CommandKind::let_go, .sequence = i});
  EXPECT_FALSE(calm.wait_for_binary(2).empty());
  ViewClient flood(port(), query());
  for (std::uint32_t i = 0; i < 5000; ++i) flood.send({.kind = CommandKind::let_go, .sequence = i});
  const Heard end = flood.wait_for_close();
  if (end.close_code != 0) {  // or the line was reset with messages unread
    EXPECT_EQ(end.text, "too many messages");
  }
  EXPECT_FALSE(calm.wait_for_binary(2).empty()) << "the other viewer is not bothered";
}

// Any bytes, as a request or after the handshake, leave a server that serves the next viewer.
TEST_F(LiveServer, SurvivesRandomBytes) {
  std::mt19937 random(11);
  for (int i = 0; i < 60; ++i) {
    std::string bytes(1 + random() % 300, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    if (i % 2 == 0) {
      test::Line line(port());
      line.send(bytes);
    } else {
      ViewClient viewer(port(), query());
      ASSERT_EQ(viewer.status(), 101) << i;
      viewer.send_raw(bytes);
    }
  }
  EXPECT_EQ(test::get(port(), "/?" + query(), host()).status, 200);
  ViewClient viewer(port(), query());
  EXPECT_FALSE(viewer.wait_for_binary(2).empty());
}

// A viewer that takes nothing costs the others no frame and the engine no time.
TEST_F(LiveServer, ASlowViewerHoldsNobodyUp) {
  ViewClient slow(port(), query());
  slow.line().small_buffer(4096);
  ViewClient quick(port(), query());
  double before = -1.0;
  for (int i = 0; i < 60; ++i) {
    const std::string frame = quick.wait_for_binary(2);
    ASSERT_GE(frame.size(), 64u);
    double time = 0.0;
    std::memcpy(&time, frame.data() + 16, 8);
    EXPECT_GE(time, before);
    before = time;
  }
  EXPECT_GT(before, 0.0);
}

// Ten viewers at once all get the body.
TEST_F(LiveServer, ServesTenViewers) {
  std::vector<std::unique_ptr<ViewClient>> viewers;
  for (int i = 0; i < 10; ++i) viewers.push_back(std::make_unique<ViewClient>(port(), query()));
  for (const auto& viewer : viewers) {
    ASSERT_EQ(viewer->status(), 101);
    EXPECT_FALSE(viewer->wait_for_binary(1).empty());
    EXPECT_FALSE(viewer->wait_for_binary(2).empty());
  }
}

class RestingServer : public LiveServer {
 protected:
  void SetUp() override { open({.token = kToken, .rest_after_s = 0.05}); }
  static double time_of(const std::string& frame) {
    double time = 0.0;
    std::memcpy(&time, frame.data() + 16, 8);
    return time;
  }
  /// Seconds of the processor that this process takes while nothing is asked of it.
  static double processor_s(std::chrono::milliseconds within) {
    const auto now = [] {
      timespec t{};
      clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
      return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    };
    const double begin = now();
    std::this_thread::sleep_for(within);
    return now() - begin;
  }
};

// A body that nobody watches rests: who comes later meets it where it was left, and it goes on by itself.
TEST_F(RestingServer, HoldsTheClockWhileNobodyWatches) {
  double left = 0.0;
  for (int visit = 0; visit < 3; ++visit) {
    ViewClient viewer(port(), query());
    std::string frame = viewer.wait_for_binary(2);
    ASSERT_GE(frame.size(), 64u);
    const double found = time_of(frame);
    if (visit > 0) {
      EXPECT_LT(found - left, 0.5) << "it went on while nobody looked, visit " << visit;
    }
    for (int i = 0; i < 200 && !(time_of(frame) > found); ++i) {
      frame = viewer.wait_for_binary(2);
      ASSERT_GE(frame.size(), 64u);
    }
    left = time_of(frame);
    EXPECT_GT(left, found);
    viewer.drop();
    std::this_thread::sleep_for(1500ms);
  }
}

// A hidden page gets no frames and holds the body as none at all does; once it is seen again, the next frame comes within 100 ms.
TEST_F(RestingServer, HoldsTheClockWhileThePageIsHidden) {
  ViewClient viewer(port(), query());
  ASSERT_GE(viewer.wait_for_binary(2).size(), 64u);
  viewer.send({.kind = CommandKind::visible, .sequence = 1, .index = 0});
  std::this_thread::sleep_for(300ms);
  EXPECT_LT(processor_s(2s), 0.02) << "of 2 s: rest is 0.5 % of a core at most, twice that on a busy machine";
  viewer.send({.kind = CommandKind::visible, .sequence = 2, .index = 1});
  const auto begin = std::chrono::steady_clock::now();
  std::string frame;
  double before = 0.0, after = 0.0;
  bool waited = false;  // frames that were under way when the page was hidden come first
  while (!waited) {
    const auto asked = std::chrono::steady_clock::now();
    frame = viewer.wait_for_binary(2);
    ASSERT_GE(frame.size(), 64u);
    waited = std::chrono::steady_clock::now() - asked > 1ms;
    before = after, after = time_of(frame);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 100ms * kBusy);
  EXPECT_LT(after - before, 0.5) << "simulated while hidden";
}

class RunningServer : public LiveServer {
  void SetUp() override { open({.token = kToken, .rest_after_s = 0.05, .keep_running = true}); }
};

// A body that is told to keep running does so while nobody looks.
TEST_F(RunningServer, GoesOnUnwatched) {
  double left = 0.0;
  for (int visit = 0; visit < 2; ++visit) {
    ViewClient viewer(port(), query());
    const std::string frame = viewer.wait_for_binary(2);
    ASSERT_GE(frame.size(), 64u);
    double time = 0.0;
    std::memcpy(&time, frame.data() + 16, 8);
    if (visit > 0) {
      EXPECT_GT(time - left, 0.1);
    }
    left = time;
    viewer.drop();
    std::this_thread::sleep_for(1s);
  }
}

TEST(LiveServerOptions, BeyondThisMachineNeedsAToken) {
  Engine engine(parse_scene(test::small_scene(), "view.toml", ".").variants.front(), {});
  const auto why = [&](const ServerOptions& options) -> std::string {
    try {
      Server server(engine, SceneFacts{"", "", "", "[]", {}}, kPage, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(why({.host = "0.0.0.0"}).find("--token"), std::string::npos);
  EXPECT_NE(why({.host = "0.0.0.0", .token = "too-short"}).find("16"), std::string::npos);
  EXPECT_NE(why({.host = "example.org"}).find("an address in digits"), std::string::npos);
  EXPECT_EQ(why({.host = "localhost"}), "");
}

}  // namespace
}  // namespace glisson::view::view_server_test
