// server.cpp — see server.h.
//
//   Listener ─▶ Request (reads one HTTP request, checks it) ─┬─▶ answer, close
//                                                            └─▶ Viewer (WebSocket) ◀─ Impl::tick
#include "view/server/server.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "view/server/request.h"

namespace glisson::view {
namespace {

/// In the number of a keyframe: it has the whole body.
constexpr std::uint32_t kWhole = 1u << 31;
constexpr auto kTick = std::chrono::milliseconds(16);
constexpr auto kTickAtRest = std::chrono::milliseconds(500);
constexpr auto kAcceptAgain = std::chrono::milliseconds(100);
constexpr auto kNewsEvery = std::chrono::milliseconds(100);
constexpr auto kStuck = std::chrono::seconds(20);  // of a viewer that takes nothing
constexpr std::size_t kHistory = 20000;            // forces kept for viewers that come later
constexpr std::size_t kShortestToken = 16;

constexpr const char* kStray = "A loose piece has left the view and is drawn at its edge; Reset makes the body whole.";

Message message(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

}  // namespace

Server::Impl::Impl(Source& source, SceneFacts facts, std::string_view page, const ServerOptions& options)
    : source_(source), facts_(std::move(facts)), page_(page), options_(options), strangers_(2 * options.most_viewers),
      lead_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.lead_kept_s))),
      recording_(source.tools().size()),
      archives_(
          context_, [this] { return facts_.recorder(recording_.snapshot(), parameters_); }, standstill()) {
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
    std::make_shared<Request>(std::move(socket), *this)->read();
    accept();
  });
}

/// Every 16 ms, whatever the last one took of them; while nobody looks, seldom.
void Server::Impl::tick() {
  due_ = std::max(due_ + (resting_ ? kTickAtRest : kTick), Clock::now());
  timer_.expires_at(due_);
  timer_.async_wait([this](beast::error_code error) {
    if (error || stopping_) return;
    try {
      look();
    } catch (const std::exception& trouble) {
      survive(trouble);
    }
    tick();
  });
}

/// Whatever a handler throws, the next one has its turn.
void Server::Impl::serve() {
  for (bool over = false; !over;) {
    try {
      context_.run();
      over = true;
    } catch (const std::exception& trouble) {
      survive(trouble);
    }
  }
}

void Server::Impl::survive(const std::exception& error) {
  const std::string text = std::string("the server continues after an internal error: ") + error.what();
  if (text == survived_) return;
  survived_ = text;
  std::fprintf(stderr, "glisson: %s\n", text.c_str());
  notice_ = message(notice_message(text));  // send_news keeps it
  const auto watching = viewers_;
  for (const std::shared_ptr<Viewer>& viewer : watching) viewer->send(notice_, false);
}

Clock::duration Server::Impl::standstill() const {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options_.standstill_s));
}

void Server::Impl::keep_samples() {
  for (ForceSample sample; source_.next_sample(sample); ++samples_) {
    history_.push_back(sample);
    if (facts_.recorder) recording_.add(sample);
  }
  while (history_.size() > kHistory) history_.pop_front();
}

/// Takes the newest state, packs it once and hands it to those who are ready.
void Server::Impl::look() {
  const Clock::time_point now = Clock::now();
  keep_samples();
  cut_off_floods();
  rest_unwatched(now);
  if (led_ != lead_.led(now)) send_roles();
  const Snapshot* state = source_.latest();
  if (state == nullptr) return;
  parameters_ = state->parameters;
  if (state->shape_number != shape_number_) {
    shape_number_ = state->shape_number;
    skin_ = {};
    whole_ = {};
    skin_.surface = std::make_unique<Surface>(state->shape);
    skin_.number = shape_number_;
    skin_.keyframe = message(keyframe_message(*skin_.surface, skin_.number));
  }
  shown_ = state;
  skin_.frames = whole_.frames = {};
  if (now - news_ >= kNewsEvery) send_news(*state, now);
  if (viewers_.empty()) return;
  const auto watching = viewers_;
  for (const std::shared_ptr<Viewer>& viewer : watching) {
    if (!viewer->busy()) {
      if (viewer->seen_) send_frame(*viewer);
      continue;
    }
    if (now - viewer->writing_since_ > kStuck) viewer->gone();
  }
}

void Server::Impl::cut_off_floods() {
  const auto watching = viewers_;
  for (const std::shared_ptr<Viewer>& viewer : watching) {
    if (viewer->floods()) viewer->gone();
  }
}

bool Server::Impl::is_watched() const {
  return std::any_of(viewers_.begin(), viewers_.end(), [](const auto& viewer) { return viewer->seen_; });
}

/// A body that nobody looks at takes no cores: the clock is held, and goes on when somebody does.
void Server::Impl::rest_unwatched(Clock::time_point now) {
  if (is_watched()) watched_ = now;
  const std::chrono::duration<double> alone = now - watched_;
  if (resting_ || options_.keep_running || alone.count() < options_.rest_after_s) return;
  resting_ = true;
  source_.set_watched(false);
}

/// Somebody looks.
void Server::Impl::wake() {
  if (!std::exchange(resting_, false)) return;
  source_.set_watched(true);
  due_ = {};
  tick();  // the seldom one that waits is cancelled
}

/// What changes seldom goes as text, and only when it has changed.
void Server::Impl::send_news(const Snapshot& state, Clock::time_point now) {
  news_ = now;
  std::string text = state_message(state, skin_.surface->pieces());
  const std::string stray = skin_.surface->strays(state) ? kStray : "";
  std::string told;
  for (const std::string& line : {state.notice, stray, survived_, why_rejected_})
    told += (told.empty() || line.empty() ? "" : "\n") + line;
  std::string notice = notice_message(told);
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
  Picture& picture = picture_for(viewer);
  if (viewer.keyframe_ != picture.number) {
    viewer.keyframe_ = picture.number;
    viewer.send(picture.keyframe, true);
  }
  if (viewer.samples_seen_ < samples_) {
    const std::uint64_t first = samples_ - history_.size();
    const std::uint64_t from = std::max(viewer.samples_seen_, first);
    viewer.send(message(samples_message(history_, static_cast<std::size_t>(from - first), source_.tools().size())),
                true);
    viewer.samples_seen_ = samples_;
  }
  viewer.send(frame_with(picture, viewer.field_), true);
}

/// The whole body is numbered for the first who wants it.
Server::Impl::Picture& Server::Impl::picture_for(const Viewer& viewer) {
  if (!viewer.inside_) return skin_;
  if (!whole_.surface) {
    whole_.surface = std::make_unique<Surface>(shown_->shape, true);
    whole_.number = shape_number_ | kWhole;
    whole_.keyframe = message(keyframe_message(*whole_.surface, whole_.number));
  }
  return whole_;
}

/// The newest state with a field, packed for the first viewer that wants it.
const Message& Server::Impl::frame_with(Picture& picture, Field field) {
  const auto frame_of = [&](Field f) -> Message& { return picture.frames[static_cast<std::size_t>(f)]; };
  if (!frame_of(Field::none)) frame_of(Field::none) = message(frame_message(*shown_, *picture.surface, picture.number));
  Message& frame = frame_of(field);
  if (!frame) frame = message(with_field(*frame_of(Field::none), field, picture.surface->field(field, *shown_)));
  return frame;
}

void Server::Impl::ask_for_fields() {
  const auto anyone = [&](auto wants) {
    return std::any_of(viewers_.begin(), viewers_.end(), [&](const auto& viewer) { return wants(viewer->field_); });
  };
  source_.want_fields(anyone(is_of_stress), anyone([](Field field) { return field == Field::contact_pressure; }));
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
  wake();
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
    const bool unknown = is_of_stress(viewer.field_) || viewer.field_ == Field::contact_pressure;
    if (unknown && !source_.has_stress()) viewer.field_ = Field::none;
    return ask_for_fields();
  }
  if (command.kind == CommandKind::inside) {
    viewer.inside_ = command.index == 1;
    return;
  }
  if (command.kind == CommandKind::visible) {
    viewer.seen_ = command.index == 1;
    return viewer.seen_ ? wake() : void();
  }
  if (!lead_.leads(viewer.session_)) return;  // those who watch have been told so
  if (command.kind == CommandKind::grab) {
    if (!skin_.surface || command.index >= skin_.surface->size()) return;
    command.index = skin_.surface->mesh_vertex(command.index);
  }
  source_.post(command);
}

void Server::Impl::reject(const Viewer& viewer, const BadPlace& place) {
  if (!lead_.leads(viewer.session_)) return;
  ++rejected_;
  why_rejected_ = std::to_string(rejected_) + (rejected_ == 1 ? " place" : " places") +
                  " for a tool or hand rejected (the last: " + place.why + "); the last good one stays.";
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
  impl_->source_.set_watched(true);
  impl_->accept();
  impl_->tick();
  impl_->thread_ = std::thread([this] { impl_->serve(); });
}

void Server::stop() {
  if (!impl_->thread_.joinable()) return;
  asio::post(impl_->context_, [this] { impl_->say_goodbye(); });
  impl_->thread_.join();
  impl_->archives_.stop();
}

unsigned short Server::port() const { return impl_->place_.port; }

std::string Server::url() const {
  return "http://" + impl_->place_.host + ":" + std::to_string(port()) + "/?token=" + impl_->options_.token;
}

}  // namespace glisson::view
