// view_client.h — the other end of the live view, by hand: bytes on a loopback socket, so that a test can also send what no
// browser would.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "view/protocol/command_bytes.h"

namespace glisson::test {

/// A TCP connection to 127.0.0.1. Every wait ends after ten seconds.
class Line {
 public:
  explicit Line(unsigned short port);
  ~Line();
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  bool send(const std::string& bytes);
  /// Reads `count` bytes; fewer where the other end closes or nothing comes.
  std::string read(std::size_t count);
  /// Reads up to and with a text.
  std::string read_until(const std::string& end);
  void close();
  /// Takes no more than this into the system's buffer.
  void small_buffer(int bytes);

 private:
  int socket_ = -1;
};

/// The answer to a GET: its status, or 0 where there was none; its text with head.
struct Answer {
  int status = 0;
  std::string text;
};
Answer get(unsigned short port, const std::string& target, const std::string& host, const std::string& more = "");

/// A message of the server. Code 8 is a close, its text that of the reason.
struct Heard {
  int code = 0;  ///< of a frame: 1 text, 2 binary, 8 close
  int close_code = 0;
  std::string text;
};

class ViewClient {
 public:
  /// Shakes hands; `status` is 101 where it worked.
  ViewClient(unsigned short port, const std::string& query, const std::string& more = "");
  int status() const { return status_; }

  void send(const view::Command& command) { send_frame(2, view::encode_command(command)); }
  void send_frame(int code, const std::string& payload);
  void send_raw(const std::string& bytes) { line_.send(bytes); }
  std::optional<Heard> hear();
  /// Passes over messages until a text of this type comes; null where the line ends first.
  nlohmann::json wait_for(const std::string& type);
  /// Until a binary message of this kind comes.
  std::string wait_for_binary(int kind);
  /// Until the server closes; code 0 where the line just ended.
  Heard wait_for_close();
  void drop() { line_.close(); }
  Line& line() { return line_; }

 private:
  Line line_;
  int status_ = 0;
};

}  // namespace glisson::test
