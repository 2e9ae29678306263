// request.h — one connection until it is a viewer or has had its answer.
#pragma once

#include "view/server/server_impl.h"

namespace glisson::view {

struct Request : std::enable_shared_from_this<Request> {
  Request(tcp::socket socket, Server::Impl& server);
  ~Request();
  void read();
  void decide();
  /// What is wrong with its headers, answered; else false.
  bool refused();
  void answer_recording();
  void become_viewer();
  /// @param text  outlives the server
  void answer(http::status status, std::string_view text, const char* type = "text/plain; charset=utf-8");
  void drop();

  beast::tcp_stream stream_;
  Server::Impl& server_;
  beast::flat_buffer in_;
  http::request_parser<http::string_body> parser_;
  bool known_ = false;  ///< it has shown the token
};

}  // namespace glisson::view
