// server.cpp — see server.h. The only file that knows Boost.Beast.
//
//   Listener ─▶ Request (reads one HTTP request, checks it) ─┬─▶ answer, close
//                                                            └─▶ Viewer (WebSocket) ◀─ Impl::tick
#include "view/server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <set>
#include <stdexcept>
#include <thread>

#include "view/access.h"
#include "view/lead.h"

namespace glisson::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using Message = std::shared_ptr<const std::string>;

constexpr auto kTick = std::chrono::milliseconds(16);
constexpr auto kAcceptAgain = std::chrono::milliseconds(100);
constexpr auto kNewsEvery = std::chrono::milliseconds(100);
constexpr auto kPatience = std::chrono::seconds(10);  // for a request, and for a handshake
constexpr auto kStuck = std::chrono::seconds(20);     // of a viewer that takes nothing
constexpr std::size_t kLongestRequest = 8192;
constexpr std::size_t kHistory = 20000;  // forces kept for viewers that come later
constexpr std::size_t kMostTexts = 64;   // that may wait for a viewer
constexpr int kSendBuffer = 256 * 1024;  // or the kernel keeps seconds of frames for a slow viewer
constexpr std::size_t kShortestToken = 16;

Message message(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

}  // namespace

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

  websocket::stream<beast::tcp_stream> stream_;
  Server::Impl& server_;
  std::string session_;
  Pacer pacer_;
  beast::flat_buffer in_;
  std::deque<std::pair<Message, bool>> out_;
  std::uint32_t keyframe_ = 0;      ///< the last one it was sent
  Field field_ = Field::intensity;  ///< that it is shown
  std::uint64_t samples_seen_ = 0;  ///< of all there ever were
  bool open_ = false, closing_ = false;
  Clock::time_point writing_since_{};
};

struct Server::Impl {
  Impl(Source& source, SceneFacts facts, std::string_view page, const ServerOptions& options);
  void listen();
  void accept();
  void accept_later();
  void tick();
  void look();
  void rest_unwatched(Clock::time_point now);
  void keep_samples();
  Message archive() const;
  void send_news(const Snapshot& state, Clock::time_point now);
  void send_frame(Viewer& viewer);
  const Message& frame_with(Field field);
  void ask_for_fields();
  void send_roles();
  void came(const std::shared_ptr<Viewer>& viewer);
  void went(const std::shared_ptr<Viewer>& viewer);
  void obey(Viewer& viewer, Command command);
  void say_goodbye();

  Source& source_;
  SceneFacts facts_;
  std::string_view page_;
  ServerOptions options_;
  Place place_;
  std::size_t connections_ = 0;  // before the context, whose handlers count it down when they go
  asio::io_context context_{1};
  tcp::acceptor acceptor_{context_};
  asio::steady_timer timer_{context_}, wait_{context_};
  std::thread thread_;
  std::set<std::shared_ptr<Viewer>> viewers_;
  Lead lead_;

  std::uint32_t shape_number_ = 0;
  std::unique_ptr<Surface> surface_;
  Message keyframe_, state_, notice_;
  const Snapshot* shown_ = nullptr;      ///< the newest state
  std::array<Message, kFields> frames_;  ///< of it, as far as someone wants them
  std::uint64_t frame_number_ = 0;
  std::deque<ForceSample> history_;
  Recording recording_;
  std::vector<double> parameters_;  ///< of the newest state
  std::uint64_t samples_ = 0;       ///< all there ever were
  std::atomic<std::uint64_t> sent_{0}, missed_{0};
  bool stopping_ = false, led_ = false;
  bool resting_ = false;  ///< held because nobody watches
  Clock::time_point watched_ = Clock::now();
  Clock::time_point news_{}, due_{};
};

namespace {

/// One connection until it is a viewer or has had its answer.
struct Request : std::enable_shared_from_this<Request> {
  Request(tcp::socket socket, Server::Impl& server) : stream_(std::move(socket)), server_(server) {
    ++server_.connections_;
    parser_.header_limit(kLongestRequest);
    parser_.body_limit(0);
  }
  ~Request() { --server_.connections_; }

  void read() {
    stream_.expires_after(kPatience);
    http::async_read(stream_, in_, parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (!error) self->decide();
    });
  }

  void decide() {
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

  void answer_recording() {
    const std::shared_ptr<const std::string> archive = server_.archive();
    if (!archive) return answer(http::status::not_found, "Nothing has been recorded.");
    answer(http::status::ok, *archive, "application/zip", archive);
  }

  void become_viewer() {
    if (!websocket::is_upgrade(parser_.get())) return answer(http::status::upgrade_required, "This is a WebSocket.");
    if (server_.viewers_.size() >= server_.options_.most_viewers)
      return answer(http::status::service_unavailable, "There are too many viewers.");
    std::string session = query_value(std::string(parser_.get().target()), "session");
    if (!is_key(session)) session = random_key();
    stream_.expires_never();
    std::make_shared<Viewer>(stream_.release_socket(), server_, std::move(session),
                             server_.options_.messages_per_second)
        ->accept(parser_.get());
  }

  /// @param owner  of the text, where that does not outlive the server
  void answer(http::status status, std::string_view text, const char* type = "text/plain; charset=utf-8",
              std::shared_ptr<const std::string> owner = {}) {
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

  beast::tcp_stream stream_;
  Server::Impl& server_;
  beast::flat_buffer in_{2 * kLongestRequest};
  http::request_parser<http::string_body> parser_;
};

}  // namespace

Viewer::Viewer(tcp::socket socket, Server::Impl& server, std::string session, double rate)
    : stream_(std::move(socket)), server_(server), session_(std::move(session)), pacer_(rate, rate, Clock::now()) {
  beast::error_code ignored;
  beast::get_lowest_layer(stream_).socket().set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true), ignored);
  stream_.read_message_max(kLongestCommand);
  stream_.auto_fragment(false);
  stream_.control_callback([this](websocket::frame_type, beast::string_view) {  // pings are messages, too
    if (!pacer_.take(Clock::now())) beast::get_lowest_layer(stream_).close();
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
  const std::variant<Command, std::string> command = decode_command({data, bytes});
  if (const auto* trouble = std::get_if<std::string>(&command))
    return close(websocket::close_code::protocol_error, trouble->c_str());
  server_.obey(*this, std::get<Command>(command));
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

Server::Impl::Impl(Source& source, SceneFacts facts, std::string_view page, const ServerOptions& options)
    : source_(source), facts_(std::move(facts)), page_(page), options_(options),
      lead_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.lead_kept_s))),
      recording_(source.tools().size()) {
  if (options_.host == "localhost") options_.host = "127.0.0.1";
  beast::error_code error;
  const asio::ip::address address = asio::ip::make_address(options_.host, error);
  if (error) throw std::invalid_argument("--host " + options.host + ": expected an address in digits or localhost");
  place_.loopback = address.is_loopback();
  if (!place_.loopback && options_.token.size() < kShortestToken) {
    throw std::invalid_argument(
        "--host " + options.host +
        ": others could reach this server; give a --token TEXT of 16 characters or more that only "
        "those who may steer it know, or leave --host out");
  }
  if (options_.token.empty()) options_.token = random_key();
  place_.host = address.is_v6() ? "[" + address.to_string() + "]" : address.to_string();
  const tcp::endpoint at(address, options_.port);
  acceptor_.open(at.protocol());
  acceptor_.set_option(asio::socket_base::reuse_address(true));
  if (acceptor_.bind(at, error) || acceptor_.listen(asio::socket_base::max_listen_connections, error))
    throw std::invalid_argument("--port " + std::to_string(options_.port) + ": " + error.message() +
                                "; give another, or 0 for one that is free");
  place_.port = acceptor_.local_endpoint().port();
}

/// The system may have no room for another line; asking again at once would only spin.
void Server::Impl::accept_later() {
  wait_.expires_after(kAcceptAgain);
  wait_.async_wait([this](beast::error_code error) {
    if (!error && !stopping_) accept();
  });
}

void Server::Impl::accept() {
  acceptor_.async_accept(context_, [this](beast::error_code error, tcp::socket socket) {
    if (stopping_ || error == asio::error::operation_aborted) return;
    if (error) return accept_later();
    if (connections_ < 2 * options_.most_viewers) std::make_shared<Request>(std::move(socket), *this)->read();
    accept();
  });
}

/// Every 16 ms, whatever the last one took of them.
void Server::Impl::tick() {
  due_ = std::max(due_ + kTick, Clock::now());
  timer_.expires_at(due_);
  timer_.async_wait([this](beast::error_code error) {
    if (error || stopping_) return;
    look();
    tick();
  });
}

void Server::Impl::keep_samples() {
  for (ForceSample sample; source_.next_sample(sample); ++samples_) {
    history_.push_back(sample);
    if (facts_.recorder) recording_.add(sample);
  }
  while (history_.size() > kHistory) history_.pop_front();
}

/// Null where there is nothing to save. @throws nothing: a scene that was opened can be written again
Message Server::Impl::archive() const {
  if (!facts_.recorder || recording_.frames() < 2) return nullptr;
  return message(facts_.recorder(recording_, parameters_));
}

/// Takes the newest state, packs it once and hands it to those who are ready.
void Server::Impl::look() {
  const Clock::time_point now = Clock::now();
  keep_samples();
  rest_unwatched(now);
  if (led_ != lead_.led(now)) send_roles();
  const Snapshot* state = source_.latest();
  if (state == nullptr) return;
  parameters_ = state->parameters;
  if (state->shape_number != shape_number_) {
    shape_number_ = state->shape_number;
    surface_ = std::make_unique<Surface>(state->shape);
    keyframe_ = message(keyframe_message(*surface_, shape_number_));
  }
  shown_ = state;
  frames_ = {};
  if (now - news_ >= kNewsEvery) send_news(*state, now);
  if (viewers_.empty()) return;
  const auto watching = viewers_;
  for (const std::shared_ptr<Viewer>& viewer : watching) {
    if (!viewer->busy()) {
      send_frame(*viewer);
      continue;
    }
    ++missed_;
    if (now - viewer->writing_since_ > kStuck) viewer->gone();
  }
}

/// A body that nobody looks at takes no cores: the clock is held, and goes on when somebody comes.
void Server::Impl::rest_unwatched(Clock::time_point now) {
  if (!viewers_.empty()) watched_ = now;
  const std::chrono::duration<double> alone = now - watched_;
  if (resting_ || shown_ == nullptr || shown_->paused || alone.count() < options_.rest_after_s) return;
  resting_ = source_.post({.kind = CommandKind::pause, .index = 1});
}

/// What changes seldom goes as text, and only when it has changed.
void Server::Impl::send_news(const Snapshot& state, Clock::time_point now) {
  news_ = now;
  std::string text = state_message(state, surface_->pieces());
  std::string notice = notice_message(state.notice);
  const bool new_state = !state_ || *state_ != text, new_notice = !notice_ || *notice_ != notice;
  if (new_state) state_ = message(std::move(text));
  if (new_notice) notice_ = message(std::move(notice));
  const auto watching = viewers_;
  for (const std::shared_ptr<Viewer>& viewer : watching) {
    if (new_state) viewer->send(state_, false);
    if (new_notice) viewer->send(notice_, false);
  }
}

void Server::Impl::send_frame(Viewer& viewer) {
  if (viewer.keyframe_ != shape_number_) {
    viewer.keyframe_ = shape_number_;
    viewer.send(keyframe_, true);
  }
  if (viewer.samples_seen_ < samples_) {
    const std::uint64_t first = samples_ - history_.size();
    const std::uint64_t from = std::max(viewer.samples_seen_, first);
    viewer.send(message(samples_message(history_, static_cast<std::size_t>(from - first), source_.tools().size())),
                true);
    viewer.samples_seen_ = samples_;
  }
  viewer.send(frame_with(viewer.field_), true);
  ++sent_;
}

/// The newest state with a field, packed for the first viewer that wants it.
const Message& Server::Impl::frame_with(Field field) {
  const auto frame_of = [this](Field f) -> Message& { return frames_[static_cast<std::size_t>(f)]; };
  if (!frame_of(Field::none)) frame_of(Field::none) = message(frame_message(*shown_, *surface_, shape_number_));
  Message& frame = frame_of(field);
  if (!frame) frame = message(with_field(*frame_of(Field::none), field, surface_->field(field, *shown_)));
  return frame;
}

void Server::Impl::ask_for_fields() {
  source_.want_velocity(std::any_of(viewers_.begin(), viewers_.end(),
                                    [](const auto& viewer) { return viewer->field_ == Field::pressure; }));
}

void Server::Impl::send_roles() {
  const bool led = led_ = lead_.led(Clock::now());
  const auto watching = viewers_;
  for (const std::shared_ptr<Viewer>& viewer : watching)
    viewer->send(message(role_message(lead_.leads(viewer->session_), led, viewers_.size())), false);
}

void Server::Impl::came(const std::shared_ptr<Viewer>& viewer) {
  const auto same = std::find_if(viewers_.begin(), viewers_.end(),
                                 [&](const auto& other) { return other->session_ == viewer->session_; });
  if (same != viewers_.end()) (*same)->close(websocket::close_code::going_away, "continued elsewhere");
  if (viewers_.size() >= options_.most_viewers && same == viewers_.end())  // several shook hands at once
    return viewer->close(websocket::close_code::try_again_later, "there are too many viewers");
  viewers_.insert(viewer);
  if (resting_) resting_ = !source_.post({.kind = CommandKind::pause, .index = 0});
  lead_.came(viewer->session_, Clock::now());
  viewer->send(message(hello_message(source_, facts_, viewer->session_)), false);
  if (state_) viewer->send(state_, false);
  if (notice_) viewer->send(notice_, false);
  send_roles();
  if (shown_ != nullptr) send_frame(*viewer);
}

void Server::Impl::went(const std::shared_ptr<Viewer>& viewer) {
  viewers_.erase(viewer);
  ask_for_fields();
  const bool goes_on = std::any_of(viewers_.begin(), viewers_.end(),
                                   [&](const auto& other) { return other->session_ == viewer->session_; });
  if (lead_.leads(viewer->session_) && !goes_on) {
    source_.post({.kind = CommandKind::let_go});
    lead_.went(viewer->session_, Clock::now());
  }
  if (!stopping_) send_roles();
}

void Server::Impl::obey(Viewer& viewer, Command command) {
  const Clock::time_point now = Clock::now();
  if (command.kind == CommandKind::take || command.kind == CommandKind::give) {
    if (command.kind == CommandKind::take) lead_.take(viewer.session_, now);
    if (command.kind == CommandKind::give) lead_.give(viewer.session_);
    return send_roles();
  }
  if (command.kind == CommandKind::colour) {
    viewer.field_ = static_cast<Field>(command.index);
    if (viewer.field_ == Field::pressure && !source_.has_stress()) viewer.field_ = Field::none;
    return ask_for_fields();
  }
  if (!lead_.leads(viewer.session_)) return;  // those who watch have been told so
  if (command.kind == CommandKind::grab) {
    if (!surface_ || command.index >= surface_->size()) return;
    command.index = surface_->mesh_vertex(command.index);
  }
  source_.post(command);
}

void Server::Impl::say_goodbye() {
  stopping_ = true;
  beast::error_code ignored;
  acceptor_.close(ignored);
  timer_.cancel();
  wait_.cancel();
  const auto watching = viewers_;
  for (const std::shared_ptr<Viewer>& viewer : watching)
    viewer->close(websocket::close_code::going_away, "glisson view has ended");
  timer_.expires_after(std::chrono::milliseconds(300));  // for those who do not answer
  timer_.async_wait([this](beast::error_code) { context_.stop(); });
}

Server::Server(Source& source, SceneFacts facts, std::string_view page, const ServerOptions& options)
    : impl_(std::make_unique<Impl>(source, std::move(facts), page, options)) {}

Server::~Server() { stop(); }

void Server::start() {
  impl_->accept();
  impl_->tick();
  impl_->thread_ = std::thread([this] { impl_->context_.run(); });
}

void Server::stop() {
  if (!impl_->thread_.joinable()) return;
  asio::post(impl_->context_, [this] { impl_->say_goodbye(); });
  impl_->thread_.join();
}

unsigned short Server::port() const { return impl_->place_.port; }

std::string Server::url() const {
  return "http://" + impl_->place_.host + ":" + std::to_string(port()) + "/?token=" + impl_->options_.token;
}

std::uint64_t Server::frames_sent() const { return impl_->sent_; }
std::uint64_t Server::frames_missed() const { return impl_->missed_; }

}  // namespace glisson::view
