// request.cpp — see request.h.
#include "view/server/request.h"

#include "view/server/answer_head.h"

namespace glisson::view {
namespace {

constexpr std::size_t kLongestRequest = 8192;

using Text = http::response<http::span_body<const char>>;

/// An answer on its way out: each piece that the line takes gives it time for the next.
struct Answer : std::enable_shared_from_this<Answer> {
  Answer(std::shared_ptr<Request> request, http::status status) : of(std::move(request)), response(status, 11) {}

  void write() {
    of->stream_.expires_after(of->server_.standstill());
    http::async_write_some(of->stream_, serializer, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (!error && !self->serializer.is_done()) return self->write();
      beast::error_code ignored;
      self->of->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  std::shared_ptr<Request> of;
  Text response;
  http::response_serializer<http::span_body<const char>> serializer{response};
};

}  // namespace

Request::Request(tcp::socket socket, Server::Impl& server)
    : stream_(std::move(socket)), server_(server), in_(2 * kLongestRequest) {
  parser_.header_limit(kLongestRequest);
  parser_.body_limit(0);
}

Request::~Request() {
  if (known_) {
    --server_.answers_;
  } else {
    server_.strangers_.went(this);
  }
}

void Request::drop() { stream_.close(); }

void Request::read() {
  server_.strangers_.came(this, [weak = weak_from_this()] {
    if (const std::shared_ptr<Request> self = weak.lock()) self->drop();
  });
  stream_.expires_after(kPatience);
  http::async_read(stream_, in_, parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (!error) self->decide();
  });
}

bool Request::refused() {
  const http::request<http::string_body>& request = parser_.get();
  for (const http::field once : {http::field::host, http::field::origin, http::field::sec_websocket_key}) {
    if (request.count(once) > 1) return answer(http::status::bad_request, "A header occurs twice."), true;
  }
  const std::string host(request[http::field::host]), origin(request[http::field::origin]);
  if (!host_allowed(host, server_.place_)) return answer(http::status::misdirected_request, "Unknown host."), true;
  if (!origin_allowed(origin, host))
    return answer(http::status::forbidden, "Requests from another page are refused."), true;
  return false;
}

void Request::decide() {
  if (refused()) return;
  const std::string target(parser_.get().target());
  const std::string path = target.substr(0, target.find('?'));
  if (path != "/" && path != "/stream" && path != "/recording") return answer(http::status::not_found, "Not found.");
  if (!same_secret(query_value(target, "token"), server_.options_.token))
    return answer(http::status::forbidden, "The token is wrong: open the whole address that glisson view printed.");
  if (server_.answers_ >= server_.most_connections()) return drop();
  server_.strangers_.went(this);
  known_ = true;
  ++server_.answers_;
  if (path == "/stream") return become_viewer();
  if (parser_.get().method() != http::verb::get) return answer(http::status::method_not_allowed, "Only GET.");
  if (path == "/recording") return answer_recording();
  answer(http::status::ok, server_.page_, "text/html; charset=utf-8");
}

void Request::answer_recording() {
  if (!server_.has_recording()) return answer(http::status::not_found, "Nothing has been recorded.");
  if (server_.archives_.full())
    return answer(http::status::service_unavailable, "Other viewers are saving the recording; try again in a moment.");
  stream_.expires_never();
  server_.archives_.take(stream_.release_socket());
}

void Request::become_viewer() {
  const http::request<http::string_body>& request = parser_.get();
  if (!websocket::is_upgrade(request)) return answer(http::status::upgrade_required, "This address is a WebSocket.");
  if (!is_handshake_key(std::string(request[http::field::sec_websocket_key])))
    return answer(http::status::bad_request, "Sec-WebSocket-Key is 16 bytes in base64.");
  if (server_.viewers_.size() >= server_.options_.most_viewers)
    return answer(http::status::service_unavailable, "There are too many viewers.");
  std::string session = query_value(std::string(request.target()), "session");
  if (!is_key(session)) session = random_key();
  stream_.expires_never();
  std::make_shared<Viewer>(stream_.release_socket(), server_, std::move(session), server_.options_.messages_per_second)
      ->accept(request);
}

void Request::answer(http::status status, std::string_view text, const char* type) {
  const auto answer = std::make_shared<Answer>(shared_from_this(), status);
  put_head(answer->response, type);
  answer->response.body() = {text.data(), text.size()};
  answer->response.prepare_payload();
  answer->write();
}

}  // namespace glisson::view
