// server.h — the live view on a port: one page, one WebSocket, nothing else.
//
//   GET /?token=T         the page                      anything else: 404; a wrong token: 403; a strange Host: 421
//   GET /stream?token=T   WebSocket; &session=K goes on as the viewer that was cut off
//   GET /recording?token=T  what hands did since the body was at rest, as an archive (recording.h)
//
// One thread serves everyone: each 16 ms it takes the newest state from its source, packs it once, and hands it to the viewers
// that are ready; one that is still busy with the last frame misses this one. Recordings go out from another thread
// (archive_sender.h).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "view/protocol/messages.h"
#include "view/state/recording.h"
#include "view/state/source.h"

namespace glisson::view {

struct ServerOptions {
  std::string host = "127.0.0.1";  ///< an address in digits, or localhost
  unsigned short port = 0;         ///< 0: one that is free
  std::string token{};             ///< empty: a random one
  double messages_per_second = 400.0;
  std::size_t most_viewers = 32;
  double lead_kept_s = 10.0;   ///< how long a viewer that is cut off keeps the lead [s]
  double rest_after_s = 10.0;  ///< without a viewer that is seen for so long the clock is held until there is one [s]
  bool keep_running = false;   ///< it never is
  double standstill_s = 20.0;  ///< a line that takes nothing of its answer for so long is cut off [s]
};

class Server {
 public:
  /// Opens the port. @param page  served at `/`, alive as long as the server
  /// @throws std::invalid_argument where the port cannot be had or the host is beyond this machine without a token
  Server(Source& source, SceneFacts facts, std::string_view page, const ServerOptions& options);
  ~Server();

  void start();
  /// Says goodbye to all viewers and ends the thread.
  void stop();
  unsigned short port() const;
  std::string url() const;  ///< with its token

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace glisson::view
