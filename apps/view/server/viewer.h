// viewer.h — a page that is connected: one WebSocket, what waits to go out to it, what it has been sent.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <memory>
#include <string>

#include "view/protocol/command_bytes.h"
#include "view/protocol/messages.h"
#include "view/server/access.h"
#include "view/server/read_pace.h"
#include "view/server/server.h"

namespace glisson::view {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using Message = std::shared_ptr<const std::string>;

inline constexpr auto kPatience = std::chrono::seconds(10);  // for a request, and for a handshake

/// A page that is connected.
struct Viewer : std::enable_shared_from_this<Viewer> {
  Viewer(tcp::socket socket, Server::Impl& server, std::string session, double rate);
  void accept(const http::request<http::string_body>& request);
  void read();
  void handle(std::size_t bytes, bool binary);
  void send(Message text, bool binary);
  void write();
  void close(websocket::close_code code, const char* reason);
  void gone();
  bool busy() const { return !out_.empty(); }
  /// Whether it sends more bytes than the messages it may send have.
  bool floods() const { return beast::get_lowest_layer(stream_).rate_policy().exceeded(); }

  websocket::stream<beast::basic_stream<tcp, asio::any_io_executor, ReadPace>> stream_;
  Server::Impl& server_;
  std::string session_;
  Pacer pacer_;
  beast::flat_buffer in_;
  std::deque<std::pair<Message, bool>> out_;
  std::uint32_t keyframe_ = 0;      ///< the last one it was sent
  Field field_ = Field::intensity;  ///< that it is shown
  std::uint64_t samples_seen_ = 0;  ///< of all there ever were
  bool open_ = false, closing_ = false;
  bool seen_ = true;     ///< its page is not hidden
  bool inside_ = false;  ///< it is sent the whole body, not its surfaces alone
  Clock::time_point writing_since_{};
};

}  // namespace glisson::view
