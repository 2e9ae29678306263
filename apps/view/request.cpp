// request.cpp — see request.h.
#include "view/request.h"

namespace glisson::view {
namespace {

constexpr std::size_t kLongestRequest = 8192;

}  // namespace

Request::Request(tcp::socket socket, Server::Impl& server)
    : stream_(std::move(socket)), server_(server), in_(2 * kLongestRequest) {
  ++server_.connections_;
  parser_.header_limit(kLongestRequest);
  parser_.body_limit(0);
}
Request::~Request() { --server_.connections_; }

void Request::read() {
  stream_.expires_after(kPatience);
  http::async_read(stream_, in_, parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (!error) self->decide();
  });
}

void Request::decide() {
  const http::request<http::string_body>& request = parser_.get();
  const std::string host(request[http::field::host]), origin(request[http::field::origin]);
  const std::string target(request.target());
  if (!host_allowed(host, server_.place_)) return answer(http::status::misdirected_request, "This is no such host.");
  if (!origin_allowed(origin, host)) return answer(http::status::forbidden, "Another page may not use this one.");
  const std::string path = target.substr(0, target.find('?'));
  if (path != "/" && path != "/stream" && path != "/recording")
    return answer(http::status::not_found, "There is nothing here.");
  if (!same_secret(query_value(target, "token"), server_.options_.token))
    return answer(http::status::forbidden, "The token is wrong: open the whole address that glisson view printed.");
  if (path == "/stream") return become_viewer();
  if (request.method() != http::verb::get) return answer(http::status::method_not_allowed, "Only GET.");
  if (path == "/recording") return answer_recording();
  answer(http::status::ok, server_.page_, "text/html; charset=utf-8");
}

void Request::answer_recording() {
  const std::shared_ptr<const std::string> archive = server_.archive();
  if (!archive) return answer(http::status::not_found, "Nothing has been recorded.");
  answer(http::status::ok, *archive, "application/zip", archive);
}

void Request::become_viewer() {
  if (!websocket::is_upgrade(parser_.get())) return answer(http::status::upgrade_required, "This is a WebSocket.");
  if (server_.viewers_.size() >= server_.options_.most_viewers)
    return answer(http::status::service_unavailable, "There are too many viewers.");
  std::string session = query_value(std::string(parser_.get().target()), "session");
  if (!is_key(session)) session = random_key();
  stream_.expires_never();
  std::make_shared<Viewer>(stream_.release_socket(), server_, std::move(session), server_.options_.messages_per_second)
      ->accept(parser_.get());
}

void Request::answer(http::status status, std::string_view text, const char* type,
                     std::shared_ptr<const std::string> owner) {
  using Body = http::span_body<const char>;
  auto response = std::make_shared<http::response<Body>>(status, 11);
  response->set(http::field::content_type, type);
  response->set(http::field::cache_control, "no-store");
  response->set("Referrer-Policy", "no-referrer");
  response->set("X-Content-Type-Options", "nosniff");
  response->set("Content-Security-Policy",
                "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; font-src data:; "
                "img-src data: blob:; connect-src 'self' ws:; base-uri 'none'; form-action 'none'; "
                "frame-ancestors 'none'");
  if (owner) response->set(http::field::content_disposition, "attachment; filename=\"recording.zip\"");
  response->body() = {text.data(), text.size()};
  response->keep_alive(false);
  response->prepare_payload();
  stream_.expires_after(kPatience);
  http::async_write(stream_, *response, [self = shared_from_this(), response, owner](beast::error_code, std::size_t) {
    beast::error_code ignored;
    self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  });
}

}  // namespace glisson::view
