// server_impl.h — the state of the server, and what its parts (request.h, viewer.h) ask of it; one thread's.
#pragma once

#include <array>
#include <atomic>
#include <boost/asio/steady_timer.hpp>
#include <set>
#include <thread>
#include <vector>

#include "view/server/archive_sender.h"
#include "view/server/lead.h"
#include "view/server/strangers.h"
#include "view/server/viewer.h"

namespace glisson::view {

struct Server::Impl {
  Impl(Source& source, SceneFacts facts, std::string_view page, const ServerOptions& options);
  void accept();
  void accept_later();
  void serve();
  void tick();
  void look();
  void cut_off_floods();
  void rest_unwatched(Clock::time_point now);
  bool is_watched() const;
  void wake();
  void keep_samples();
  /// Says on stderr and to viewers what went wrong here and now, once each; the thread goes on.
  void survive(const std::exception& error);
  bool has_recording() const { return facts_.recorder && recording_.frames() >= 2; }
  std::size_t most_connections() const { return 2 * options_.most_viewers; }
  Clock::duration standstill() const;
  void send_news(const Snapshot& state, Clock::time_point now);
  void send_frame(Viewer& viewer);
  /// What is sent to those who see the surfaces of the body, or to those who see all of it.
  struct Picture {
    std::unique_ptr<Surface> surface;
    std::uint32_t number = 0;  ///< of its keyframe
    Message keyframe;
    std::array<Message, kFields> frames;  ///< of the newest state, as far as someone wants them
  };
  Picture& picture_for(const Viewer& viewer);
  const Message& frame_with(Picture& picture, Field field);
  void ask_for_fields();
  void send_roles();
  void came(const std::shared_ptr<Viewer>& viewer);
  void went(const std::shared_ptr<Viewer>& viewer);
  void obey(Viewer& viewer, Command command);
  void reject(const Viewer& viewer, const BadPlace& place);
  void say_goodbye();

  Source& source_;
  SceneFacts facts_;
  std::string_view page_;
  ServerOptions options_;
  Place place_;
  std::size_t answers_ = 0;  // strangers and these before the context, whose handlers count them down when they go
  Strangers strangers_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_{context_};
  asio::steady_timer timer_{context_}, wait_{context_};
  std::thread thread_;
  std::set<std::shared_ptr<Viewer>> viewers_;
  Lead lead_;

  std::uint32_t shape_number_ = 0;
  Picture skin_, whole_;
  Message state_, notice_;
  const Snapshot* shown_ = nullptr;  ///< the newest state
  std::uint64_t frame_number_ = 0;
  std::deque<ForceSample> history_;
  Recording recording_;
  ArchiveSender archives_;
  std::string survived_;            ///< the last trouble told
  std::uint64_t rejected_ = 0;      ///< places that made no sense, of those who lead
  std::string why_rejected_;        ///< the last of them
  std::vector<double> parameters_;  ///< of the newest state
  std::uint64_t samples_ = 0;       ///< all there ever were
  bool stopping_ = false, led_ = false;
  bool resting_ = false;  ///< the source is held because nobody looks
  Clock::time_point watched_ = Clock::now();
  Clock::time_point news_{}, due_{};
};

}  // namespace glisson::view
