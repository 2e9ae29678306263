#include "base/input_file.h"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace glisson::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPiece = std::size_t{1} << 20;

std::string size_text(std::uintmax_t bytes) {
  return bytes >> 30 > 0 ? std::to_string(bytes >> 30) + " GiB" : std::to_string(bytes >> 20) + " MiB";
}

/// What keeps a file from being opened; empty: nothing.
std::string obstacle(const fs::path& file, const InputKind& kind) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  const std::string named = std::string("; name ") + kind.name;
  if (fs::is_directory(status)) return "is a folder" + named;
  if (fs::exists(status) && !fs::is_regular_file(status)) return "is a device, a pipe or a socket" + named;
  return {};
}

/// Piece by piece: the size that the system tells may be wrong, or grow meanwhile. False where it is above the limit.
bool take_all(std::istream& stream, std::uintmax_t most, std::string& bytes) {
  std::string piece(kPiece, '\0');
  while (stream.read(piece.data(), static_cast<std::streamsize>(piece.size())) || stream.gcount() > 0) {
    const auto count = static_cast<std::size_t>(stream.gcount());
    if (count > most - bytes.size()) return false;
    bytes.append(piece, 0, count);
  }
  return true;
}

}  // namespace

InputFile read_input(const fs::path& file, const InputKind& kind) {
  const auto refused = [&](const std::string& why) { return InputFile{{}, file.string() + ": " + why}; };
  if (const std::string why = obstacle(file, kind); !why.empty()) return refused(why);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return refused("cannot be read; check the path and that you may read it");
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  const std::string too_large =
      "is larger than " + size_text(kind.most) + ", the most that is read of " + kind.name + "; " + kind.if_too_large;
  if (!error && size > kind.most) return refused(too_large);
  InputFile input;
  if (!error) input.bytes.reserve(static_cast<std::size_t>(size));
  if (!take_all(stream, kind.most, input.bytes)) return refused(too_large);
  if (stream.bad()) return refused("cannot be read to its end");
  return input;
}

}  // namespace glisson::detail
