// archive_sender.cpp — see archive_sender.h.
#include "view/server/archive_sender.h"

#include <boost/asio/post.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <cstdio>
#include <sstream>
#include <string>

#include "view/server/answer_head.h"

namespace glisson::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using Line = ArchiveSender::Line;

constexpr std::size_t kMostWaiting = 8;
constexpr std::size_t kPiece = 64 * 1024;
constexpr int kArchiveSendBuffer = 256 * 1024;                // or the kernel keeps megabytes for a slow line
constexpr auto kLookForStop = std::chrono::milliseconds(50);  // while a line stands still

/// A line that is written to by a thread that waits for it.
class SlowLine {
 public:
  SlowLine(Line line, std::chrono::steady_clock::duration standstill, const std::atomic<bool>& stop)
      : stream_(own_), standstill_(standstill), stop_(stop) {
    const auto protocol = line.local_endpoint().protocol();
    stream_.socket().assign(protocol, line.release());
    beast::error_code ignored;
    stream_.socket().set_option(asio::socket_base::send_buffer_size(kArchiveSendBuffer), ignored);
  }

  /// @return false where it stood still, was closed, or the program ends
  bool write(std::string_view bytes) {
    for (std::size_t taken = 0; !bytes.empty(); bytes.remove_prefix(taken)) {
      taken = write_some(bytes);
      if (taken == 0) return false;
    }
    return true;
  }
  void finish() {
    beast::error_code ignored;
    stream_.socket().shutdown(Line::shutdown_send, ignored);
  }

 private:
  std::size_t write_some(std::string_view bytes) {
    std::size_t taken = 0;
    bool over = false;
    stream_.expires_after(standstill_);
    stream_.async_write_some(asio::buffer(bytes), [&](beast::error_code error, std::size_t n) {
      taken = error ? 0 : n;
      over = true;
    });
    for (own_.restart(); !over;) {
      own_.run_one_for(kLookForStop);
      if (stop_ && !over) stream_.close();
    }
    return taken;
  }

  asio::io_context own_{1};
  beast::tcp_stream stream_;
  std::chrono::steady_clock::duration standstill_;
  const std::atomic<bool>& stop_;
};

std::string head_of(const ZipArchive& archive) {
  http::response_header<> head;
  head.version(11);
  head.result(http::status::ok);
  put_head(head, "application/zip");
  head.set(http::field::content_disposition, "attachment; filename=\"recording.zip\"");
  head.set(http::field::content_length, std::to_string(archive.bytes()));
  std::ostringstream text;
  text << head;
  return text.str();
}

}  // namespace

ArchiveSender::ArchiveSender(asio::io_context& home, Files files, std::chrono::steady_clock::duration standstill)
    : home_(home), files_(std::move(files)), standstill_(standstill) {}

ArchiveSender::~ArchiveSender() { stop(); }

bool ArchiveSender::full() const { return stop_ || waiting_.size() >= kMostWaiting; }

void ArchiveSender::take(Line line) {
  if (full()) return;
  waiting_.push_back(std::move(line));
  next();
}

void ArchiveSender::stop() {
  stop_ = true;
  waiting_.clear();
  if (worker_.joinable()) worker_.join();
}

void ArchiveSender::next() {
  if (stop_ || waiting_.empty() || worker_.joinable()) return;
  Line line = std::move(waiting_.front());
  waiting_.pop_front();
  worker_ = std::thread([this, line = std::move(line), files = files_()]() mutable {
    try {
      send(std::move(line), std::move(files));
    } catch (const std::exception& error) {
      std::fprintf(stderr, "glisson: the recording could not be sent: %s\n", error.what());
    }
    asio::post(home_, [this] {
      if (stop_) return;
      worker_.join();
      next();
    });
  });
}

void ArchiveSender::send(Line line, std::vector<ZipFile> files) const {
  SlowLine out(std::move(line), standstill_, stop_);
  const ZipArchive archive(std::move(files), [this] { return !stop_.load(); });
  if (!archive.whole()) return;
  std::string waiting = head_of(archive);
  waiting.reserve(2 * kPiece);
  const bool taken = archive.write([&](std::string_view piece) {
    waiting += piece;
    if (waiting.size() < kPiece) return true;
    const bool went = out.write(waiting);
    waiting.clear();
    return went;
  });
  if (taken && out.write(waiting)) out.finish();
}

}  // namespace glisson::view
