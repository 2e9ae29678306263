#include "forged_file.h"

#include <array>
#include <cstring>
#include <limits>
#include <sstream>

#include "dynamics/state/checkpoint.h"
#include "support.h"

namespace glisson::fuzz {
namespace {

constexpr std::size_t kHead = 16, kTail = 8;  // checkpoint.h
constexpr std::size_t kMostEdits = 64;

/// Numbers that an edit can name: of counts, places, times and forces those that break a careless reader.
constexpr std::array kValues{0.0,
                             1.0,
                             -1.0,
                             0.5,
                             3.0,
                             7.0,
                             255.0,
                             4294967295.0,
                             1e-300,
                             1e300,
                             std::numeric_limits<double>::max(),
                             std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()};

void edit(std::string& content, Numbers& numbers) {
  const auto place = numbers.take<std::uint16_t>();
  const auto kind = numbers.take<std::uint8_t>();
  const auto raw = numbers.take<std::array<char, 8>>();
  const std::size_t at = content.empty() ? 0 : place % content.size(), left = content.size() - at;
  const double chosen = kValues[static_cast<unsigned char>(raw[0]) % kValues.size()];
  std::array<char, 8> value = raw;
  if (kind % 6 < 2) std::memcpy(value.data(), &chosen, sizeof(chosen));
  switch (kind % 6) {
    case 0:
    case 2:
      return static_cast<void>(content.replace(at, std::min<std::size_t>(8, left), value.data(), 8));
    case 1:
    case 3:
      return static_cast<void>(content.insert(at, value.data(), 8));
    case 4:
      return static_cast<void>(content.replace(at, std::min<std::size_t>(4, left), value.data(), 4));
    default:
      return static_cast<void>(content.erase(at, static_cast<unsigned char>(raw[0])));
  }
}

}  // namespace

std::string content_of(const std::string& file) { return file.substr(kHead, file.size() - kHead - kTail); }

std::string forged_content(const std::string& sound, std::uint8_t mode, std::string_view rest) {
  if (mode % 2 == 0) return std::string(rest);
  std::string content = sound;
  Numbers numbers(rest);
  for (std::size_t n = 0; n < kMostEdits && !numbers.empty(); ++n) edit(content, numbers);
  return content;
}

std::string file_of(std::string_view content) {
  std::ostringstream file;
  write_checkpoint(Archive(std::string(content)), file);
  return file.str();
}

}  // namespace glisson::fuzz
