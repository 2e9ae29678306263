// request.h — one connection until it is a viewer or has had its answer.
#pragma once

#include "view/server_impl.h"

namespace glisson::view {

struct Request : std::enable_shared_from_this<Request> {
  Request(tcp::socket socket, Server::Impl& server);
  ~Request();
  void read();
  void decide();
  void answer_recording();
  void become_viewer();
  /// @param owner  of the text, where that does not outlive the server
  void answer(http::status status, std::string_view text, const char* type = "text/plain; charset=utf-8",
              std::shared_ptr<const std::string> owner = {});

  beast::tcp_stream stream_;
  Server::Impl& server_;
  beast::flat_buffer in_;
  http::request_parser<http::string_body> parser_;
};

}  // namespace glisson::view
