#include "dynamics/state/checkpoint.h"

#include <algorithm>
#include <cstring>
#include <istream>
#include <ostream>
#include <sstream>
#include <stdexcept>

namespace glisson {
namespace {

constexpr std::uint64_t kHashPrime = 1099511628211ULL;
constexpr std::string_view kMagic = "GLISSON1";
constexpr std::size_t kHead = kMagic.size() + sizeof(std::uint64_t), kTail = sizeof(std::uint64_t);

/// FNV-1a, eight bytes at a time; the last ones are filled up by zeros.
std::uint64_t checksum(const std::string& text) {
  std::uint64_t hash = kHashStart;
  for (std::size_t at = 0; at < text.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data() + at, std::min(sizeof(word), text.size() - at));
    hash = (hash ^ word) * kHashPrime;
  }
  return hash;
}

std::string bytes_of(std::uint64_t number) {
  Archive out;
  out(number);
  return out.bytes();
}

}  // namespace

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t hash) {
  for (const std::byte b : bytes) hash = (hash ^ static_cast<std::uint64_t>(b)) * kHashPrime;
  return hash;
}

void write_checkpoint(const Archive& contents, std::ostream& out) {
  const std::string& bytes = contents.bytes();
  out << kMagic << bytes_of(bytes.size()) << bytes << bytes_of(checksum(bytes));
  if (!out.flush()) throw std::runtime_error("checkpoint: it could not be written; is there room on the disk?");
}

Archive read_checkpoint(std::istream& in) {
  std::ostringstream file;
  file << in.rdbuf();
  const std::string all = std::move(file).str();
  if (all.size() < kHead || all.compare(0, kMagic.size(), kMagic) != 0) {
    throw std::runtime_error("checkpoint: this is not a checkpoint that this program reads; it does not begin with " +
                             std::string(kMagic) + ", as those of this version do");
  }
  std::uint64_t size = 0, sum = 0;
  Archive head(all.substr(kMagic.size(), sizeof(size)));
  head(size);
  if (all.size() - kHead < kTail || size != all.size() - kHead - kTail) {
    throw std::runtime_error("checkpoint: " + std::to_string(all.size()) + " bytes are there of " +
                             std::to_string(size + kHead + kTail) + "; it is cut or has grown");
  }
  Archive tail(all.substr(kHead + size));
  tail(sum);
  std::string contents = all.substr(kHead, size);
  if (checksum(contents) != sum) {
    throw std::runtime_error("checkpoint: its checksum is wrong, bytes have changed since it was written");
  }
  return Archive(std::move(contents));
}

}  // namespace glisson
