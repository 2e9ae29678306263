// archive_sender.h — hands out the recording, one line after the other, from a thread that serves no frames.
//
//   server's thread   take(line) ─▶ waiting: 8 at most ─▶ its turn: snapshot of the recording ──┐        ┌─▶ next
//   sender's thread                                     measures it, writes it in pieces of 64 KiB ─────┘ done
//
// A piece goes out when the line has taken the one before it: memory does not grow with the recording or with the lines. A line
// may be as slow as it is; one that takes nothing for a while is cut off.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <deque>
#include <functional>
#include <thread>
#include <vector>

#include "view/state/zip.h"

namespace glisson::view {

class ArchiveSender {
 public:
  using Line = boost::asio::ip::tcp::socket;
  using Files = std::function<std::vector<ZipFile>()>;

  /// @param home       whose thread calls take() and `files` @param files  of the recording as it is when a line's turn comes
  /// @param standstill  after which a line that takes nothing is cut off
  ArchiveSender(boost::asio::io_context& home, Files files, std::chrono::steady_clock::duration standstill);
  ~ArchiveSender();

  bool full() const;  ///< so many wait that take() cuts a line off
  void take(Line line);
  /// Cuts off what is being sent; of the home's thread, or when that has ended.
  void stop();

 private:
  void next();
  void send(Line line, std::vector<ZipFile> files) const;

  boost::asio::io_context& home_;
  Files files_;
  std::chrono::steady_clock::duration standstill_;
  std::deque<Line> waiting_;
  std::atomic<bool> stop_{false};
  std::thread worker_;
};

}  // namespace glisson::view
