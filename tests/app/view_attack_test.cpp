// The live server keeps its doors open and its thread alive whatever a line does: silent strangers give way to visitors, slow
// lines get all of their answer, floods without content end, and a fault of its own is survived with a word.
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "app/program.h"
#include "app/view_client.h"
#include "view/engine/engine.h"
#include "view/server/access.h"
#include "view/server/server.h"
#include "view/server/strangers.h"

namespace glisson::view {
namespace {

using namespace std::chrono_literals;
using test::Answer;
using test::Line;
using test::ViewClient;
using ::testing::HasSubstr;

constexpr const char* kToken = "a-token-of-a-test";
constexpr std::size_t kArchive = 6'000'000;

/// Passes an engine on, and breaks where it is told to.
class BreakingSource final : public Source {
 public:
  explicit BreakingSource(Engine& engine) : engine_(engine) {}
  void start() override {}
  void stop() override {}
  bool post(const Command& command) override { return engine_.post(command); }
  const Snapshot* latest() override {
    if (breaks.exchange(false)) throw std::runtime_error("no such thing as caf\xe9");
    return engine_.latest();
  }
  bool next_sample(ForceSample& sample) override { return engine_.next_sample(sample); }
  const std::vector<ToolInfo>& tools() const override { return engine_.tools(); }
  const std::vector<ParameterInfo>& parameters() const override { return engine_.parameters(); }
  const std::string& forms() const override { return engine_.forms(); }
  bool can_grab() const override { return engine_.can_grab(); }
  const std::string& why_no_cut() const override { return engine_.why_no_cut(); }
  bool has_stress() const override { return engine_.has_stress(); }
  std::size_t vertices() const override { return engine_.vertices(); }
  std::size_t tets() const override { return engine_.tets(); }

  std::atomic<bool> breaks{false};

 private:
  Engine& engine_;
};

class ViewAttack : public ::testing::Test {
 protected:
  ViewAttack() : engine_(parse_scene(test::small_scene(), "view.toml", ".").variants.front(), {}), source_(engine_) {}
  void SetUp() override { open({.token = kToken, .standstill_s = 1.0}); }
  void TearDown() override {
    server_->stop();
    engine_.stop();
  }
  void open(const ServerOptions& options) {
    const auto writer = [this](std::shared_ptr<const Recording>, const std::vector<double>&) {
      return std::vector<ZipFile>{{"big", [this](const TextSink& out) { content(out); }}};
    };
    server_ = std::make_unique<Server>(source_, SceneFacts{"a scene", "main", "0", "[]", writer}, page_, options);
    engine_.start();
    server_->start();
  }
  void content(const TextSink& out) {
    ++at_work_;
    most_at_work_ = std::max(most_at_work_.load(), at_work_.load());
    for (std::size_t i = 0; i < kArchive; i += 50000) {
      if (!out(std::string(50000, 'x'))) break;
    }
    --at_work_;
  }
  std::string host() const { return "127.0.0.1:" + std::to_string(server_->port()); }
  unsigned short port() const { return server_->port(); }
  std::string query() const { return std::string("token=") + kToken; }
  void ask(Line& line, const std::string& path) const {
    line.send("GET " + path + "?" + query() + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
  }
  void wait_for_recording() {
    ViewClient viewer(port(), query());
    for (int i = 0; i < 30; ++i) ASSERT_FALSE(viewer.wait_for_binary(2).empty());
  }
  /// Reads an answer to its end, at a pace. @return its bytes
  static std::size_t read_slowly(Line& line, std::size_t bytes, std::chrono::milliseconds pause) {
    std::size_t all = 0;
    for (;;) {
      const std::size_t got = line.read(bytes).size();
      all += got;
      if (got < bytes) return all;
      std::this_thread::sleep_for(pause);
    }
  }

  std::string page_ = std::string(3'000'000, 'p');
  Engine engine_;
  BreakingSource source_;
  std::atomic<int> at_work_{0}, most_at_work_{0};
  std::unique_ptr<Server> server_;
};

// The oldest gives way, once; those who have shown the token, or went, are no strangers.
TEST(ViewStrangers, TheOldestGivesWay) {
  Strangers strangers(3);
  std::vector<int> dropped;
  std::array<int, 6> who{};
  for (int i = 0; i < 4; ++i)
    strangers.came(&who[static_cast<std::size_t>(i)], [&dropped, i] { dropped.push_back(i); });
  EXPECT_EQ(dropped, std::vector<int>{0});
  strangers.went(&who[1]);
  strangers.went(&who[0]);
  strangers.came(&who[4], [&] { dropped.push_back(4); });
  EXPECT_EQ(dropped, std::vector<int>{0});
  strangers.came(&who[5], [&] { dropped.push_back(5); });
  EXPECT_EQ(dropped, (std::vector<int>{0, 2}));
  EXPECT_EQ(strangers.size(), 3u);
}

// A hundred lines that say nothing, or half a request, and never go: whoever has the token comes in beside them.
TEST_F(ViewAttack, SilentStrangersKeepNobodyOut) {
  ViewClient before(port(), query());
  ASSERT_EQ(before.status(), 101);
  std::vector<std::unique_ptr<Line>> silent;
  for (int i = 0; i < 100; ++i) {
    silent.push_back(std::make_unique<Line>(port()));
    if (i % 2 == 0) silent.back()->send("GET / HTTP/1.1\r\nHost: ");
  }
  std::this_thread::sleep_for(200ms);  // all of them are in
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(test::get(port(), "/?" + query(), host()).status, 200);
  ViewClient visitor(port(), query());
  EXPECT_EQ(visitor.status(), 101);
  EXPECT_FALSE(visitor.wait_for_binary(2).empty());
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s) << "not when their time was over";
  EXPECT_FALSE(before.wait_for_binary(2).empty());
}

// The limit is on standstill: page and recording reach a line that takes several times as long in all.
TEST_F(ViewAttack, ASlowLineGetsAllOfItsAnswer) {
  wait_for_recording();
  for (const auto& [path, bytes] : {std::pair<std::string, std::size_t>{"/", page_.size()}, {"/recording", kArchive}}) {
    Line line(port());
    line.small_buffer(65536);
    ask(line, path);
    EXPECT_THAT(line.read_until("\r\n\r\n"), HasSubstr("HTTP/1.1 200"));
    const auto start = std::chrono::steady_clock::now();
    EXPECT_GE(read_slowly(line, bytes / 40, 50ms), bytes) << path;
    EXPECT_GT(std::chrono::steady_clock::now() - start, 1500ms) << "longer than a standstill may last";
  }
}

TEST_F(ViewAttack, ALineThatStandsStillIsCutOff) {
  wait_for_recording();
  Line line(port());
  line.small_buffer(65536);
  ask(line, "/recording");
  line.read_until("\r\n\r\n");
  std::this_thread::sleep_for(2500ms);
  EXPECT_LT(read_slowly(line, 65536, 0ms), kArchive);
  const Answer next = test::get(port(), "/recording?" + query(), host());
  EXPECT_EQ(next.status, 200) << "and the next one has its turn";
  EXPECT_GT(next.text.size(), kArchive);
}

// Archives are made one at a time, and none by the thread that serves frames; who comes when too many wait is told so.
TEST_F(ViewAttack, RecordingsGoOutOneAtATime) {
  wait_for_recording();
  std::vector<std::unique_ptr<Line>> lines;
  for (int i = 0; i < 12; ++i) {
    lines.push_back(std::make_unique<Line>(port()));
    ask(*lines.back(), "/recording");
  }
  ViewClient viewer(port(), query());
  for (int i = 0; i < 20; ++i) ASSERT_FALSE(viewer.wait_for_binary(2).empty());
  std::size_t whole = 0, told = 0;
  for (const auto& line : lines) {
    const std::string head = line->read_until("\r\n\r\n");
    whole += head.find("200 OK") != std::string::npos && read_slowly(*line, 65536, 0ms) > kArchive ? 1 : 0;
    told += head.find("HTTP/1.1 503") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(whole, 9u) << "the one that is sent, and eight that wait";
  EXPECT_EQ(told, 3u);
  EXPECT_EQ(most_at_work_, 1);
}

TEST_F(ViewAttack, StopsWhileARecordingGoesOut) {
  wait_for_recording();
  Line line(port()), waiting(port());
  line.small_buffer(65536);
  ask(line, "/recording");
  line.read_until("\r\n\r\n");
  ask(waiting, "/recording");
  const auto start = std::chrono::steady_clock::now();
  server_->stop();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 2s);
}

// A header that decides stands there once; a handshake has a key of 16 bytes.
TEST_F(ViewAttack, HeadersStandOnce) {
  const std::string own = "Origin: http://" + host() + "\r\n";
  EXPECT_EQ(test::get(port(), "/?" + query(), host(), own).status, 200);
  EXPECT_EQ(test::get(port(), "/?" + query(), host(), own + "Origin: http://evil.example\r\n").status, 400);
  EXPECT_EQ(test::get(port(), "/?" + query(), host(), "Host: evil.example\r\n").status, 400);
  EXPECT_EQ(ViewClient(port(), query(), "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n").status(), 400);
  const auto shake = [&](const std::string& key) {
    Line line(port());
    line.send("GET /stream?" + query() + " HTTP/1.1\r\nHost: " + host() +
              "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: " +
              key + "\r\n\r\n");
    return line.read_until("\r\n\r\n").substr(0, 12);
  };
  EXPECT_EQ(shake("dGhlIHNhbXBsZSBub25jZQ=="), "HTTP/1.1 101");
  for (const char* none :
       {"x", "dGhlIHNhbXBsZSBub25jZQ", "dGhlIHNhbXBsZSBub25jZQ=!", "dGhlIHNhbXBsZSBub25jZQdGhlIHNhbX=="})
    EXPECT_EQ(shake(none), "HTTP/1.1 400") << none;
}

// Fragments without content are no messages, but they are bytes, and those have a limit, too.
TEST_F(ViewAttack, EmptyFragmentsEnd) {
  ViewClient calm(port(), query()), flood(port(), query());
  ASSERT_EQ(flood.status(), 101);
  std::string fragments("\x02\x80\0\0\0\0", 6);  // begins a message, without an end
  for (int i = 0; i < 2000; ++i) fragments += std::string("\x00\x80\0\0\0\0", 6);
  bool ended = false;
  for (int i = 0; i < 300 && !ended; ++i) ended = !flood.line().send(fragments);
  for (int i = 0; i < 5000 && !ended; ++i) ended = !flood.hear().has_value();
  EXPECT_TRUE(ended);
  EXPECT_FALSE(calm.wait_for_binary(2).empty());
}

// Codes beyond 4999 are none: the line ends without the handshake that a code is answered with.
TEST_F(ViewAttack, CloseCodesAreThoseOfTheProtocol) {
  const auto answer = [&](unsigned code) {
    ViewClient viewer(port(), query());
    EXPECT_EQ(viewer.status(), 101);
    viewer.send_frame(8, {static_cast<char>(code >> 8), static_cast<char>(code & 255u)});
    return viewer.wait_for_close().close_code;
  };
  EXPECT_EQ(answer(1000), 1000);
  EXPECT_EQ(answer(4999), 4999);
  EXPECT_EQ(answer(999), 1002);
  for (const unsigned none : {5000u, 65535u}) EXPECT_EQ(answer(none), 0) << none;
}

// What is thrown in the server's thread is told, and frames go on.
TEST_F(ViewAttack, AFaultOfTheServersThreadIsSurvived) {
  ViewClient viewer(port(), query());
  ASSERT_FALSE(viewer.wait_for_binary(2).empty());
  source_.breaks = true;
  std::string told;
  for (int i = 0; i < 100 && told.empty(); ++i) told = viewer.wait_for("notice")["text"].get<std::string>();
  EXPECT_EQ(told, "the server continues after an internal error: no such thing as caf\xef\xbf\xbd");
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(viewer.wait_for_binary(2).empty());
  ViewClient later(port(), query());
  EXPECT_FALSE(later.wait_for_binary(2).empty());
}

}  // namespace
}  // namespace glisson::view
