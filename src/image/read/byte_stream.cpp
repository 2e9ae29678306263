// byte_stream.cpp — see byte_stream.h.
#include "image/read/byte_stream.h"

#include <algorithm>
#include <cstring>

#include "glisson/image/read_image.h"

namespace glisson::image {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 18;
constexpr int kAnyWrapping = 15 + 32;  ///< the largest window, and gzip or zlib by what the stream begins with

}  // namespace

ByteStream::ByteStream(const ByteSource& source, Packing packing, std::uint64_t skip)
    : name_(source.file.string()), packing_(packing) {
  if (source.memory) {
    memory_ = *source.memory;
    if (skip > memory_.size()) fail("ends before byte " + std::to_string(skip) + ", where the voxels should begin");
    memory_.remove_prefix(static_cast<std::size_t>(skip));
  } else {
    std::error_code none;
    if (!std::filesystem::exists(source.file, none)) fail("there is no such file; see to the path");
    if (!std::filesystem::is_regular_file(source.file, none)) fail("is no regular file; name an image file");
    file_.reset(std::fopen(source.file.c_str(), "rb"));
    if (!file_) fail("cannot be opened; see to its permissions");
    if (skip > std::filesystem::file_size(source.file, none))
      fail("ends before byte " + std::to_string(skip) + ", where the voxels should begin");
    if (skip > 0 && std::fseek(file_.get(), static_cast<long>(skip), SEEK_SET) != 0) fail("cannot be read");
  }
  if (packing_ == Packing::none) return;
  in_.resize(kChunk);
  if (inflateInit2(&z_, kAnyWrapping) != Z_OK) fail("zlib cannot be started for want of memory");
}

ByteStream::~ByteStream() {
  if (packing_ != Packing::none) inflateEnd(&z_);
}

void ByteStream::fail(const std::string& what) const { throw ImageError(name_ + ": " + what); }

std::size_t ByteStream::raw(void* to, std::size_t size) {
  if (file_) return std::fread(to, 1, size, file_.get());
  const std::size_t count = std::min(size, memory_.size());
  if (count > 0) std::memcpy(to, memory_.data(), count);
  memory_.remove_prefix(count);
  return count;
}

std::size_t ByteStream::unpack(unsigned char* to, std::size_t size) {
  std::size_t done = 0;
  while (done < size && !ended_) {
    if (z_.avail_in == 0) {
      z_.next_in = in_.data();
      z_.avail_in = static_cast<unsigned>(raw(in_.data(), in_.size()));
      if (z_.avail_in == 0)
        fail("is truncated: its packed data end after " + std::to_string(position_ + done) +
             " unpacked bytes, before their check sum; copy or fetch the file again");
    }
    const std::size_t wanted = std::min(size - done, kChunk);
    z_.next_out = to + done;
    z_.avail_out = static_cast<unsigned>(wanted);
    const int result = inflate(&z_, Z_NO_FLUSH);
    done += wanted - z_.avail_out;
    if (result == Z_STREAM_END) {
      // A further member may follow, as pigz and bgzip write them; anything else behind the end is no data.
      if (z_.avail_in == 0) {
        z_.next_in = in_.data();
        z_.avail_in = static_cast<unsigned>(raw(in_.data(), in_.size()));
      }
      ended_ = z_.avail_in == 0 || *z_.next_in != 0x1f;
      if (!ended_) inflateReset2(&z_, kAnyWrapping);
    } else if (result != Z_OK && result != Z_BUF_ERROR) {
      fail("cannot be unpacked after " + std::to_string(position_ + done) + " bytes (zlib: " +
           (z_.msg != nullptr ? z_.msg : "no packed data") + "); it is damaged, or not packed as it says");
    }
  }
  return done;
}

std::size_t ByteStream::read(void* to, std::size_t size) {
  const std::size_t count = packing_ == Packing::none ? raw(to, size) : unpack(static_cast<unsigned char*>(to), size);
  position_ += count;
  return count;
}

std::uint64_t ByteStream::rest(std::uint64_t most) {
  std::vector<char> scratch(kChunk);
  std::uint64_t left = 0;
  while (left < most) {
    const std::size_t count = read(scratch.data(), scratch.size());
    left += count;
    if (count < scratch.size()) break;
  }
  return left;
}

}  // namespace glisson::image
