// access.cpp — see access.h.
#include "view/server/access.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <random>

namespace glisson::view {

std::string random_key() {
  std::random_device source;
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string key;
  for (int word = 0; word < 4; ++word) {
    std::uint32_t bits = source();
    for (int i = 0; i < 8; ++i, bits >>= 4) key.push_back(kDigits[bits & 15u]);
  }
  return key;
}

bool is_key(std::string_view text) {
  return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_handshake_key(std::string_view text) {
  constexpr std::size_t kDigits = 22;
  constexpr std::string_view kBase64 = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  return text.size() == kDigits + 2 && text.substr(kDigits) == "==" &&
         text.substr(0, kDigits).find_first_not_of(kBase64) == std::string_view::npos;
}

bool same_secret(std::string_view a, std::string_view b) {
  unsigned differ = a.size() == b.size() ? 0u : 1u;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char other = b.empty() ? '\0' : b[i % b.size()];
    differ |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(other));
  }
  return differ == 0 && !a.empty();
}

std::string query_value(std::string_view target, std::string_view key) {
  std::size_t at = target.find('?');
  while (at != std::string_view::npos) {
    const std::size_t end = target.find('&', at + 1);
    const std::string_view pair = target.substr(at + 1, end == std::string_view::npos ? end : end - at - 1);
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos && pair.substr(0, equals) == key) return std::string(pair.substr(equals + 1));
    at = end;
  }
  return {};
}

namespace {

bool is_address(std::string_view name) {
  if (name.size() > 2 && name.front() == '[' && name.back() == ']') {
    return std::all_of(name.begin() + 1, name.end() - 1,
                       [](unsigned char c) { return std::isxdigit(c) || c == ':' || c == '.'; });
  }
  return !name.empty() && std::count(name.begin(), name.end(), '.') == 3 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) || c == '.'; });
}

}  // namespace

bool host_allowed(std::string_view host, const Place& place) {
  const std::string port = ":" + std::to_string(place.port);
  std::string_view name = host;
  if (name.size() > port.size() && name.substr(name.size() - port.size()) == port)
    name.remove_suffix(port.size());
  else if (place.port != 80)
    return false;
  constexpr std::array<std::string_view, 3> kLoopback{"127.0.0.1", "localhost", "[::1]"};
  if (std::find(kLoopback.begin(), kLoopback.end(), name) != kLoopback.end()) return true;
  return !place.loopback && (name == place.host || is_address(name));
}

bool origin_allowed(std::string_view origin, std::string_view host) {
  return origin.empty() || origin == "http://" + std::string(host);
}

bool Pacer::take(Clock::time_point now, double count) {
  left_ = std::min(most_, left_ + rate_ * std::chrono::duration<double>(now - last_).count());
  last_ = now;
  if (left_ < count) return false;
  left_ -= count;
  return true;
}

}  // namespace glisson::view
