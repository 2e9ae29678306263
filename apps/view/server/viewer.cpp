// viewer.cpp — see viewer.h.
#include "view/server/viewer.h"

#include "view/server/server_impl.h"

namespace glisson::view {
namespace {

constexpr std::size_t kMostTexts = 64;                    // that may wait for a viewer
constexpr double kLongestFrame = kLongestCommand + 14.0;  // with the head of a frame [bytes]
constexpr std::uint16_t kNoCloseCode = 5000;  // from here on RFC 6455 §7.4.2 has no codes, but beast takes them
constexpr int kSendBuffer = 256 * 1024;       // or the kernel keeps seconds of frames for a slow viewer

}  // namespace

Viewer::Viewer(tcp::socket socket, Server::Impl& server, std::string session, double rate)
    : stream_(ReadPace(rate * kLongestFrame), std::move(socket)), server_(server), session_(std::move(session)),
      pacer_(rate, rate, Clock::now()) {
  beast::error_code ignored;
  beast::get_lowest_layer(stream_).socket().set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true), ignored);
  stream_.read_message_max(kLongestCommand);
  stream_.auto_fragment(false);
  stream_.control_callback([this](websocket::frame_type kind, beast::string_view) {  // pings are messages, too
    const bool no_code = kind == websocket::frame_type::close && stream_.reason().code >= kNoCloseCode;
    if (no_code || !pacer_.take(Clock::now())) beast::get_lowest_layer(stream_).close();
  });
  stream_.set_option(websocket::stream_base::timeout{kPatience, std::chrono::seconds(30), true});
}

void Viewer::accept(const http::request<http::string_body>& request) {
  stream_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (error || self->server_.stopping_) return;
    self->open_ = true;
    self->server_.came(self);
    self->read();
  });
}

void Viewer::read() {
  stream_.async_read(in_, [self = shared_from_this()](beast::error_code error, std::size_t bytes) {
    if (error) return self->gone();
    self->handle(bytes, self->stream_.got_binary());
  });
}

void Viewer::handle(std::size_t bytes, bool binary) {
  if (!pacer_.take(Clock::now())) return close(websocket::close_code::policy_error, "too many messages");
  if (!binary) return close(websocket::close_code::unknown_data, "messages are binary");
  const auto* data = static_cast<const std::uint8_t*>(in_.data().data());
  const auto command = decode_command({data, bytes});
  if (const auto* trouble = std::get_if<std::string>(&command))
    return close(websocket::close_code::protocol_error, trouble->c_str());
  if (const auto* place = std::get_if<BadPlace>(&command)) {
    server_.reject(*this, *place);
  } else {
    server_.obey(*this, std::get<Command>(command));
  }
  in_.consume(bytes);
  read();
}

void Viewer::send(Message text, bool binary) {
  if (!open_ || closing_) return;
  if (out_.size() >= kMostTexts) return close(websocket::close_code::try_again_later, "too slow");
  out_.emplace_back(std::move(text), binary);
  if (out_.size() == 1) write();
}

void Viewer::write() {
  writing_since_ = Clock::now();
  stream_.binary(out_.front().second);
  stream_.async_write(asio::buffer(*out_.front().first),
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                        if (error) return self->gone();
                        self->out_.pop_front();
                        if (!self->out_.empty()) self->write();
                      });
}

void Viewer::close(websocket::close_code code, const char* reason) {
  if (closing_ || !open_) return;
  closing_ = true;
  stream_.async_close({code, reason}, [self = shared_from_this()](beast::error_code) { self->gone(); });
}

void Viewer::gone() {
  if (!open_) return;
  open_ = false;
  beast::error_code ignored;
  beast::get_lowest_layer(stream_).socket().close(ignored);
  server_.went(shared_from_this());
}

}  // namespace glisson::view
