// read_image.cpp — voxels, row by row: checked, scaled, and cropped where that is asked for, in two passes over the file.
#include "image/read/read_image.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "base/available_memory.h"
#include "base/text.h"
#include "image/labels_of_body.h"
#include "image/read/image_header.h"

namespace glisson::image {
namespace {

using Place = std::array<std::size_t, 3>;

constexpr double kMostLabel = 65535.0;
constexpr std::uint64_t kMostRest = std::uint64_t{1} << 20;  ///< bytes behind the voxels that are looked at
constexpr double kMostPacked = 1040.0;                       ///< bytes that deflate makes of one, at most 1032
constexpr double kMemoryShare = 0.8;                         ///< of what is available: a mesh comes after it

std::string ending_of(const std::filesystem::path& file) {
  const std::string name = detail::lower_case(file.filename().string());
  for (const char* ending : {".nii", ".nii.gz", ".nrrd", ".nhdr", ".mha", ".mhd"}) {
    if (name.ends_with(ending)) return ending;
  }
  return {};
}

/// Refuses a file that is too short for the voxels of its header, before memory is taken for them; finds voxels that end with the file.
void require_bytes(ImageHeader& header) {
  std::error_code none;
  if (!header.data.memory && !std::filesystem::is_regular_file(header.data.file, none))
    fail(header.data, "the file of the voxels is not there; keep it beside its header");
  const double all = static_cast<double>(header.data.memory ? header.data.memory->size()
                                                            : std::filesystem::file_size(header.data.file, none));
  const double wanted = static_cast<double>(header.grid.voxels()) * static_cast<double>(bytes_of(header.type));
  const double least = header.packed ? wanted / kMostPacked : wanted;
  if (least > all)
    fail(header.data, "is truncated, or its header is wrong: it has " + detail::number_text(all, 12) +
                          " bytes, and the voxels that its header gives take " + detail::number_text(wanted, 12) +
                          (header.packed ? " unpacked" : ""));
  if (header.from_end) header.before = static_cast<std::uint64_t>(all - wanted);
}

ImageHeader header_of(const ByteSource& source) {
  const std::string ending = ending_of(source.file);
  if (ending.empty())
    fail(source, "its ending is none of an image; known: .nii, .nii.gz, .nrrd, .nhdr, .seg.nrrd, .mha, .mhd");
  ImageHeader header = ending.starts_with(".nii") ? read_nifti(source)
                       : ending.starts_with(".n") ? read_nrrd(source)
                                                  : read_metaimage(source);
  require_bytes(header);
  return header;
}

template <class T>
double number_at(const unsigned char* bytes, bool swapped) {
  std::array<unsigned char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (swapped) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<T>(raw));
}

template <class T>
void convert(const std::vector<unsigned char>& bytes, bool swapped, double slope, double intercept,
             std::vector<double>& row) {
  for (std::size_t i = 0; i < row.size(); ++i)
    row[i] = slope * number_at<T>(bytes.data() + i * sizeof(T), swapped) + intercept;
}

/// The rows of an image in the order of its file.
class Rows {
 public:
  explicit Rows(const ImageHeader& header)
      : header_(header),
        stream_(header.data, header.packed ? ByteStream::Packing::gzip : ByteStream::Packing::none, header.before) {
    std::vector<char> skipped(4096);
    for (std::uint64_t left = header.skip; left > 0;) {
      const std::size_t step = static_cast<std::size_t>(std::min<std::uint64_t>(left, skipped.size()));
      if (stream_.read(skipped.data(), step) < step) stream_.fail("ends before its voxels begin");
      left -= step;
    }
    bytes_.resize(header.grid.size[0] * bytes_of(header.type));
    row_.resize(header.grid.size[0]);
  }

  /// Values of the next row. @throws ImageError where the file ends before it
  const std::vector<double>& next() {
    if (stream_.read(bytes_.data(), bytes_.size()) < bytes_.size())
      stream_.fail("is truncated: it ends in row " + std::to_string(read_ + 1) + " of the " +
                   std::to_string(header_.grid.size[1] * header_.grid.size[2]) + " that its header gives");
    ++read_;
    const bool swapped = header_.big_endian != (std::endian::native == std::endian::big);
    const double a = header_.slope, b = header_.intercept;
    switch (header_.type) {
      case VoxelType::i8:
        convert<std::int8_t>(bytes_, swapped, a, b, row_);
        break;
      case VoxelType::u8:
        convert<std::uint8_t>(bytes_, swapped, a, b, row_);
        break;
      case VoxelType::i16:
        convert<std::int16_t>(bytes_, swapped, a, b, row_);
        break;
      case VoxelType::u16:
        convert<std::uint16_t>(bytes_, swapped, a, b, row_);
        break;
      case VoxelType::i32:
        convert<std::int32_t>(bytes_, swapped, a, b, row_);
        break;
      case VoxelType::u32:
        convert<std::uint32_t>(bytes_, swapped, a, b, row_);
        break;
      case VoxelType::i64:
        convert<std::int64_t>(bytes_, swapped, a, b, row_);
        break;
      case VoxelType::u64:
        convert<std::uint64_t>(bytes_, swapped, a, b, row_);
        break;
      case VoxelType::f32:
        convert<float>(bytes_, swapped, a, b, row_);
        break;
      case VoxelType::f64:
        convert<double>(bytes_, swapped, a, b, row_);
        break;
    }
    return row_;
  }

  /// Reads the check sum of packed voxels; says where there is more than the header gives.
  void finish(std::vector<std::string>& notes) {
    if (stream_.rest(kMostRest) > 0)
      notes.emplace_back("the file has more bytes than its header gives voxels: these were left out");
  }

 private:
  const ImageHeader& header_;
  ByteStream stream_;
  std::vector<unsigned char> bytes_;
  std::vector<double> row_;
  std::size_t read_ = 0;
};

void require_memory(const std::string& file, const ImageGrid& grid, double bytes_each, const ReadImageOptions& options,
                    const char* way_out) {
  const double needed = static_cast<double>(grid.voxels()) * bytes_each;
  std::optional<double> memory = options.memory;
  if (!memory) {
    memory = detail::available_memory();
    if (memory) *memory *= kMemoryShare;
  }
  if (!memory || needed <= *memory) return;
  throw ImageError(file + ": its " + detail::number_text(static_cast<double>(grid.voxels()), 4) + " voxels need " +
                   detail::number_text(needed / 1e6, 4) + " MB, and " + detail::number_text(*memory / 1e6, 4) +
                   " MB may be taken; " + way_out);
}

std::uint16_t label_of(const ImageHeader& header, double value, std::size_t i, std::size_t row) {
  if (value >= 0.0 && value <= kMostLabel && value == std::floor(value)) return static_cast<std::uint16_t>(value);
  const std::size_t j = row % header.grid.size[1], k = row / header.grid.size[1];
  throw NotLabels(header.data.file.string() + ": voxel (" + std::to_string(i) + ", " + std::to_string(j) + ", " +
                  std::to_string(k) + ") is " + detail::show(value) +
                  ", which is no label; allowed: whole numbers from 0 to 65535. A grey image or a map of probabilities "
                  "has to be segmented first");
}

/// Voxels kept: [low, low + size).
struct Window {
  Place low{}, size{};
};

/// The box around some labels with a margin, in a first pass.
Window box_of_labels(const ImageHeader& header, const ReadImageOptions& options) {
  const Place& n = header.grid.size;
  const std::set<int> wanted(options.crop_to.begin(), options.crop_to.end());
  std::set<int> found;
  Place low = n, high{};
  Rows rows(header);
  for (std::size_t row = 0; row < n[1] * n[2]; ++row) {
    const std::vector<double>& values = rows.next();
    for (std::size_t i = 0; i < n[0]; ++i) {
      const int label = label_of(header, values[i], i, row);
      if (label == 0) continue;
      found.insert(label);
      if (!wanted.contains(label)) continue;
      const Place at{i, row % n[1], row / n[1]};
      for (std::size_t a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], at[a]);
        high[a] = std::max(high[a], at[a] + 1);
      }
    }
  }
  for (const int label : wanted) {
    if (!found.contains(label))
      fail_without_label(header.data.file.string(), label, header.names, std::vector<int>(found.begin(), found.end()));
  }
  Window window;
  for (std::size_t a = 0; a < 3; ++a) {
    window.low[a] = low[a] - std::min(low[a], options.margin);
    window.size[a] = std::min(n[a], high[a] + options.margin) - window.low[a];
  }
  return window;
}

/// Reads a window of the voxels into an image.
template <class Image, class Value>
Image read_window(ImageHeader& header, const Window& window, Value value_of) {
  Image image;
  image.source = header.data.file.string();
  image.whole = header.grid.size;
  image.crop_low = window.low;
  image.grid = header.grid.part(window.low, window.size);
  image.voxels.resize(image.grid.voxels());
  const Place& n = header.grid.size;
  Rows rows(header);
  std::size_t at = 0;
  for (std::size_t row = 0; row < n[1] * n[2]; ++row) {
    const std::vector<double>& values = rows.next();
    const std::size_t j = row % n[1], k = row / n[1];
    if (j < window.low[1] || j >= window.low[1] + window.size[1] || k < window.low[2] ||
        k >= window.low[2] + window.size[2])
      continue;
    for (std::size_t i = window.low[0]; i < window.low[0] + window.size[0]; ++i)
      image.voxels[at++] = value_of(values[i], i, row);
  }
  rows.finish(header.notes);
  image.notes = header.notes;
  return image;
}

}  // namespace

LabelImage read_labels(const ByteSource& source, const ReadImageOptions& options) {
  ImageHeader header = header_of(source);
  Window window{{}, header.grid.size};
  if (!options.crop_to.empty()) window = box_of_labels(header, options);
  require_memory(source.file.string(), header.grid.part(window.low, window.size), 2.0, options,
                 options.crop_to.empty() ? "choose labels, so that the image is cropped to them as it is read"
                                         : "choose fewer labels, or write the image with larger voxels");
  LabelImage image = read_window<LabelImage>(
      header, window, [&](double value, std::size_t i, std::size_t row) { return label_of(header, value, i, row); });
  image.names = header.names;
  return image;
}

GreyImage read_grey(const ByteSource& source, const ReadImageOptions& options) {
  ImageHeader header = header_of(source);
  require_memory(source.file.string(), header.grid, 4.0, options,
                 "write the image with larger voxels, or a part of it");
  return read_window<GreyImage>(header, {{}, header.grid.size}, [&](double value, std::size_t i, std::size_t row) {
    if (std::abs(value) <= std::numeric_limits<float>::max()) return static_cast<float>(value);
    if (options.gaps && std::isnan(value)) return std::numeric_limits<float>::quiet_NaN();
    fail(header.data, "voxel " + std::to_string(i) + " of row " + std::to_string(row + 1) + " is " +
                          detail::show(value) + ", which is no finite number of single precision");
  });
}

}  // namespace glisson::image

namespace glisson {

bool is_image_file(const std::filesystem::path& file) { return !image::ending_of(file).empty(); }

LabelImage read_label_image(const std::filesystem::path& file, const ReadImageOptions& options) {
  return image::read_labels({file, {}}, options);
}

std::map<int, std::string> read_label_names(const std::filesystem::path& file) {
  return image::header_of({file, {}}).names;
}

ImageGrid read_image_grid(const std::filesystem::path& file) { return image::header_of({file, {}}).grid; }

GreyImage read_grey_image(const std::filesystem::path& file, const ReadImageOptions& options) {
  return image::read_grey({file, {}}, options);
}

Vec3d ImageGrid::spacing() const {
  Vec3d s{};
  for (std::size_t c = 0; c < 3; ++c) s[c] = std::hypot(axes(0, c), axes(1, c), axes(2, c));
  return s;
}

ImageGrid ImageGrid::part(const std::array<std::size_t, 3>& low, const std::array<std::size_t, 3>& part_size) const {
  ImageGrid g = *this;
  g.size = part_size;
  g.origin = world({static_cast<double>(low[0]), static_cast<double>(low[1]), static_cast<double>(low[2])});
  return g;
}

std::string LabelImage::name_of(int label) const {
  const auto it = names.find(label);
  return it == names.end() ? "label " + std::to_string(label) : it->second;
}

}  // namespace glisson
