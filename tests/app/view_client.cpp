// view_client.cpp — see view_client.h.
#include "app/view_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cstdlib>

namespace glisson::test {

Line::Line(unsigned short port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  const timeval patience{.tv_sec = 10, .tv_usec = 0};
  setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&at), sizeof(at)) != 0) close();
}

Line::~Line() { close(); }

void Line::close() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

void Line::small_buffer(int bytes) { setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes)); }

bool Line::send(const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t n = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) return false;
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

std::string Line::read(std::size_t count) {
  std::string bytes(count, '\0');
  std::size_t got = 0;
  while (got < count) {
    const ssize_t n = ::recv(socket_, bytes.data() + got, count - got, 0);
    if (n <= 0) break;
    got += static_cast<std::size_t>(n);
  }
  bytes.resize(got);
  return bytes;
}

std::string Line::read_until(const std::string& end) {
  std::string text;
  while (text.size() < end.size() || text.compare(text.size() - end.size(), end.size(), end) != 0) {
    const std::string next = read(1);
    if (next.empty()) break;
    text += next;
  }
  return text;
}

namespace {

int status_of(const std::string& text) { return text.rfind("HTTP/1.1 ", 0) == 0 ? std::atoi(text.c_str() + 9) : 0; }

}  // namespace

Answer get(unsigned short port, const std::string& target, const std::string& host, const std::string& more) {
  Line line(port);
  line.send("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "\r\n");
  std::string text;
  for (std::string part = line.read(65536); !part.empty(); part = line.read(65536)) text += part;
  return {status_of(text), text};
}

ViewClient::ViewClient(unsigned short port, const std::string& query, const std::string& more) : line_(port) {
  line_.send("GET /stream?" + query + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
             "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
             "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
             more + "\r\n");
  status_ = status_of(line_.read_until("\r\n\r\n"));
}

void ViewClient::send_frame(int code, const std::string& payload) {
  std::string bytes{static_cast<char>(0x80 | code)};
  if (payload.size() < 126) {
    bytes.push_back(static_cast<char>(0x80 | payload.size()));
  } else {
    bytes.push_back(static_cast<char>(0x80 | 127));
    for (int shift = 56; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(payload.size() >> shift & 255u));
  }
  bytes += std::string(4, '\0');  // a mask of zeros: the payload as it is
  line_.send(bytes + payload);
}

std::optional<Heard> ViewClient::hear() {
  const std::string head = line_.read(2);
  if (head.size() < 2) return {};
  std::uint64_t length = static_cast<unsigned char>(head[1]) & 127u;
  const std::size_t more = length == 126 ? 2 : length == 127 ? 8 : 0;
  if (more > 0) {
    length = 0;
    for (const char c : line_.read(more)) length = length << 8 | static_cast<unsigned char>(c);
  }
  Heard heard{.code = head[0] & 15, .text = line_.read(length)};
  if (heard.text.size() < length) return {};
  if (heard.code == 8 && heard.text.size() >= 2) {
    heard.close_code = static_cast<unsigned char>(heard.text[0]) << 8 | static_cast<unsigned char>(heard.text[1]);
    heard.text.erase(0, 2);
  }
  return heard;
}

nlohmann::json ViewClient::wait_for(const std::string& type) {
  while (const std::optional<Heard> heard = hear()) {
    if (heard->code != 1) continue;
    nlohmann::json json = nlohmann::json::parse(heard->text);
    if (json["type"] == type) return json;
  }
  return nullptr;
}

std::string ViewClient::wait_for_binary(int kind) {
  while (const std::optional<Heard> heard = hear()) {
    if (heard->code == 2 && !heard->text.empty() && heard->text[0] == kind) return heard->text;
  }
  return {};
}

Heard ViewClient::wait_for_close() {
  while (const std::optional<Heard> heard = hear()) {
    if (heard->code == 8) return *heard;
  }
  return {};
}

}  // namespace glisson::test
