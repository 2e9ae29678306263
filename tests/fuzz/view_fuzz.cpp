// view_fuzz.cpp — any bytes as a message of a viewer: a command whose bytes they are, or a reason; and as a request's target.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "view/protocol/command_bytes.h"
#include "view/server/access.h"

namespace {

void require(bool kept, const char* promise) {
  if (kept) return;
  std::fprintf(stderr, "the live view broke its promise: %s\n", promise);
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glisson::view;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto got = decode_command({data, size});
  if (const auto* command = std::get_if<Command>(&got)) {
    require(encode_command(*command) == text, "a command has one way to be written");
    for (const float x : command->values) require(std::isfinite(x), "numbers are finite");
  } else if (const auto* place = std::get_if<BadPlace>(&got)) {
    require(!place->why.empty(), "a place that is rejected has a reason");
  } else {
    require(!std::get<std::string>(got).empty(), "what is refused has a reason");
  }
  require(query_value(text, "token").size() <= text.size(), "a value is a part of its target");
  require(!same_secret(text, "a-token-of-a-test") || text == "a-token-of-a-test", "only the token opens");
  host_allowed(text, {"127.0.0.1", 8080, true});
  return 0;
}
