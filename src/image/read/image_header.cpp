// image_header.cpp — see image_header.h.
#include "image/read/image_header.h"

#include <charconv>
#include <cmath>

#include "base/text.h"
#include "glisson/image/read_image.h"

namespace glisson::image {
namespace {

constexpr double kMostVoxels = 1.0995e12;
constexpr std::size_t kLongestHeader = std::size_t{4} << 20;
constexpr double kLeastVolume = 1e-6;  ///< of the axes over the product of their lengths: below, they are flat

}  // namespace

void fail(const ByteSource& source, const std::string& what) { throw ImageError(source.file.string() + ": " + what); }

ImageGrid checked_grid(const std::string& file, const std::array<std::int64_t, 3>& size, const Mat3d& columns,
                       const Vec3d& origin, const Vec3d& flip, double metres) {
  ImageGrid grid;
  double voxels = 1.0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (size[a] < 1)
      throw ImageError(file + ": its header gives " + std::to_string(size[a]) + " voxels along axis " +
                       std::to_string(a + 1) + "; allowed: 1 or more");
    voxels *= static_cast<double>(size[a]);
    grid.size[a] = static_cast<std::size_t>(size[a]);
  }
  if (voxels > kMostVoxels)
    throw ImageError(file + ": its header gives " + detail::number_text(voxels, 4) +
                     " voxels, which no image has; the header is damaged");
  Vec3d lengths{};
  for (std::size_t r = 0; r < 3; ++r) {
    grid.origin[r] = origin[r] * flip[r] * metres;
    for (std::size_t c = 0; c < 3; ++c) {
      grid.axes(r, c) = columns(r, c) * flip[r] * metres;
      lengths[c] += grid.axes(r, c) * grid.axes(r, c);
    }
  }
  const double product = std::sqrt(lengths.x) * std::sqrt(lengths.y) * std::sqrt(lengths.z);
  const double volume = std::abs(determinant(grid.axes));
  if (!std::isfinite(norm(grid.origin)) || !std::isfinite(volume) || !std::isfinite(product))
    throw ImageError(file + ": the directions or the origin of its header are not finite");
  if (!(volume > kLeastVolume * product) || !(product > 1e-24))
    throw ImageError(file + ": the axes of its header span no volume (spacings " +
                     detail::number_text(1e3 * std::sqrt(lengths.x)) + ", " +
                     detail::number_text(1e3 * std::sqrt(lengths.y)) + ", " +
                     detail::number_text(1e3 * std::sqrt(lengths.z)) +
                     " mm); write the image again with its directions and spacings");
  return grid;
}

TextHeader read_text_header(const ByteSource& source, std::string_view last) {
  ByteStream stream(source, ByteStream::Packing::none);
  TextHeader header;
  std::string line;
  for (char c = 0; stream.read(&c, 1) == 1;) {
    if (stream.position() > kLongestHeader || c == '\0') fail(source, "its header has no end; the file is damaged");
    if (c != '\n') {
      line += c;
      continue;
    }
    if (!line.empty() && line.back() == '\r') line.pop_back();
    header.bytes = stream.position();
    if (line.empty() && last.empty()) return header;
    header.lines.push_back(line);
    if (!last.empty() && line.starts_with(last)) return header;
    line.clear();
  }
  if (!line.empty()) header.lines.push_back(line);
  header.bytes = stream.position();
  return header;
}

std::vector<double> numbers_in(const ByteSource& source, std::string_view text, const std::string& what) {
  std::vector<double> numbers;
  const auto separates = [](char c) { return c == ' ' || c == '\t' || c == ',' || c == '(' || c == ')'; };
  while (!text.empty()) {
    if (separates(text.front())) {
      text.remove_prefix(1);
      continue;
    }
    double x = 0.0;
    const std::string_view word = text.substr(0, text.find_first_of(" \t,()"));
    const char* from = word.data() + (word.front() == '+' ? 1 : 0);
    const auto [end, error] = std::from_chars(from, word.data() + word.size(), x);
    if (error != std::errc() || end != word.data() + word.size())
      fail(source, what + " has \"" + std::string(word.substr(0, 40)) + "\", which is no number");
    numbers.push_back(x);
    text.remove_prefix(word.size());
  }
  return numbers;
}

ByteSource beside(const ByteSource& header, const std::string& name) {
  if (header.memory) fail(header, "its voxels are in another file, \"" + name + "\"");
  return {header.file.parent_path() / name, {}};
}

}  // namespace glisson::image
