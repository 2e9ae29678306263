// access.h — who may talk to the server: token, host, origin, pace. Pure decisions, tested without a network.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace glisson::view {

/// 128 random bits as 32 hexadecimal digits, from the system's source.
std::string random_key();

/// Whether a text could be such a key: what a viewer sends as one goes into answers.
bool is_key(std::string_view text);

/// Whether a text is a key of a WebSocket's handshake: 16 bytes in base64.
bool is_handshake_key(std::string_view text);

/// Whether two texts are equal, in a time that depends on their lengths only.
bool same_secret(std::string_view a, std::string_view b);

/// Value of a key in the query of a request's target; empty where there is none. Keys and values here need no escapes.
std::string query_value(std::string_view target, std::string_view key);

/// Where the server listens, as it bears on what a request may say of it.
struct Place {
  std::string host = "127.0.0.1";  ///< as given
  unsigned short port = 0;
  bool loopback = true;  ///< bound to this machine only
};
/// Whether a Host header names this server. A name that an attacker's DNS may point here is none: only loopback names,
/// addresses in digits (where bound beyond loopback) and the host as given are.
bool host_allowed(std::string_view host, const Place& place);
/// Whether an Origin header is that of the page served here under that Host; none is given by programs, which no page can
/// make one of: they are let in by their token alone.
bool origin_allowed(std::string_view origin, std::string_view host);

/// A bucket of messages, or of bytes, that fills at a rate.
class Pacer {
 public:
  using Clock = std::chrono::steady_clock;
  Pacer(double per_second, double most, Clock::time_point now)
      : rate_(per_second), most_(most), left_(most), last_(now) {}
  /// Takes some out. @return false where there are not as many
  bool take(Clock::time_point now, double count = 1.0);

 private:
  double rate_, most_, left_;
  Clock::time_point last_;
};

}  // namespace glisson::view
