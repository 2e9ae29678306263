// lead.h — who of the viewers leads: the first that comes, whom it is given to, who takes it when it is free.
//
// A viewer is known by its session key. One that is cut off keeps the lead for a while, and has it again when it comes back.
#pragma once

#include <chrono>
#include <string>

namespace glisson::view {

class Lead {
 public:
  using Clock = std::chrono::steady_clock;
  /// @param kept  how long one that is cut off keeps it
  explicit Lead(Clock::duration kept) : kept_(kept) {}

  void came(const std::string& session, Clock::time_point now) {
    forget_late(now);
    if (session_.empty()) session_ = session;
    if (session == session_) gone_ = false;
  }
  void went(const std::string& session, Clock::time_point now) {
    if (session != session_) return;
    gone_ = true;
    since_ = now;
  }
  /// Takes it where it is free. @return whether the session leads now
  bool take(const std::string& session, Clock::time_point now) {
    forget_late(now);
    if (session_.empty()) session_ = session;
    return leads(session);
  }
  void give(const std::string& session) {
    if (session == session_) session_.clear();
  }
  bool leads(const std::string& session) const { return !session_.empty() && session == session_; }
  /// Whether anyone leads; one that is late has lost it.
  bool led(Clock::time_point now) {
    forget_late(now);
    return !session_.empty();
  }

 private:
  void forget_late(Clock::time_point now) {
    if (!gone_ || now - since_ < kept_) return;
    session_.clear();
    gone_ = false;
  }
  Clock::duration kept_;
  std::string session_;
  bool gone_ = false;
  Clock::time_point since_{};
};

}  // namespace glisson::view
