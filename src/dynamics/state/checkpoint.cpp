#include "dynamics/state/checkpoint.h"

#include <istream>
#include <iterator>
#include <ostream>
#include <stdexcept>

namespace glisson {
namespace {

constexpr std::string_view kMagic = "GLISCHK1";
constexpr std::uint32_t kVersion = 5;
constexpr std::size_t kHead = 8 + sizeof(std::uint32_t) + sizeof(std::uint64_t);

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes.data() + at, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

std::uint64_t hash_text(const std::string& text) { return hash_bytes(std::as_bytes(std::span(text))); }

}  // namespace

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t hash) {
  for (const std::byte b : bytes) hash = (hash ^ static_cast<std::uint64_t>(b)) * 1099511628211ULL;
  return hash;
}

void CheckpointWriter::write(std::ostream& out) const {
  CheckpointWriter head, tail;
  head.put(kVersion);
  head.put(static_cast<std::uint64_t>(bytes_.size()));
  tail.put(hash_text(bytes_));
  out << kMagic << head.bytes_ << bytes_ << tail.bytes_;
  if (!out.flush()) throw std::runtime_error("checkpoint: it could not be written; is there room on the disk?");
}

CheckpointReader::CheckpointReader(std::istream& in) {
  std::string all{std::istreambuf_iterator<char>(in), {}};
  if (all.size() < kHead || all.compare(0, kMagic.size(), kMagic) != 0) {
    throw std::runtime_error("checkpoint: this is none; it does not begin with " + std::string(kMagic));
  }
  if (const auto version = number_at<std::uint32_t>(all, 8); version != kVersion) {
    throw std::runtime_error("checkpoint: version " + std::to_string(version) + " is not known, this program reads " +
                             std::to_string(kVersion) + "; load it with the program that wrote it");
  }
  const auto size = number_at<std::uint64_t>(all, 12);
  if (all.size() - kHead < sizeof(std::uint64_t) || size != all.size() - kHead - sizeof(std::uint64_t)) {
    throw std::runtime_error("checkpoint: " + std::to_string(all.size()) + " bytes are there of " +
                             std::to_string(size + kHead + sizeof(std::uint64_t)) + "; it is cut or has grown");
  }
  const auto sum = number_at<std::uint64_t>(all, kHead + size);
  bytes_ = all.substr(kHead, size);
  if (hash_text(bytes_) != sum) {
    throw std::runtime_error("checkpoint: its checksum is wrong, bytes have changed since it was written");
  }
}

void CheckpointReader::fail() {
  throw std::runtime_error(
      "checkpoint: its contents do not fit this simulation; make it with the same mesh, tissues, "
      "options, constraints and loads as the one that was saved");
}

const char* CheckpointReader::take(std::size_t n) {
  if (n > left()) fail();
  at_ += n;
  return bytes_.data() + at_ - n;
}

}  // namespace glisson
