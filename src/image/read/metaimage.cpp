// metaimage.cpp — the header of MetaImage: lines `Key = value` up to ElementDataFile, before the voxels (.mha) or beside them (.mhd).
#include <cmath>

#include "base/text.h"
#include "image/read/image_header.h"

namespace glisson::image {
namespace {

using MetaWords = std::map<std::string, std::string>;

MetaWords meta_words(const ByteSource& source, const TextHeader& text) {
  MetaWords words;
  for (const std::string& line : text.lines) {
    const std::size_t equals = line.find('=');
    if (equals == line.npos) {
      if (detail::trimmed(line).empty()) continue;
      fail(source, "is no MetaImage: its line \"" + line.substr(0, 40) + "\" is not `Key = value`");
    }
    words[std::string(detail::trimmed(line.substr(0, equals)))] =
        detail::trimmed(std::string_view(line).substr(equals + 1));
  }
  if (!words.contains("ElementDataFile")) fail(source, "is no MetaImage: it has no ElementDataFile");
  return words;
}

/// The first of some keys that a header has, or empty.
std::string first_key(const MetaWords& words, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (const auto it = words.find(key); it != words.end()) return it->second;
  }
  return {};
}

std::vector<double> numbers_of(const ByteSource& source, const MetaWords& words,
                               std::initializer_list<const char*> keys, std::size_t count,
                               std::vector<double> otherwise) {
  const std::string text = first_key(words, keys);
  if (text.empty()) return otherwise;
  std::vector<double> numbers = numbers_in(source, text, *keys.begin());
  if (numbers.size() != count)
    fail(source, std::string(*keys.begin()) + " has " + std::to_string(numbers.size()) + " numbers in place of " +
                     std::to_string(count));
  return numbers;
}

bool is_true(const std::string& word) {
  const std::string lower = detail::lower_case(word);
  return lower == "true" || lower == "t" || lower == "1" || lower == "yes";
}

VoxelType meta_type(const ByteSource& source, const std::string& name) {
  static const std::map<std::string, VoxelType> known{
      {"MET_CHAR", VoxelType::i8},    {"MET_UCHAR", VoxelType::u8},       {"MET_SHORT", VoxelType::i16},
      {"MET_USHORT", VoxelType::u16}, {"MET_INT", VoxelType::i32},        {"MET_UINT", VoxelType::u32},
      {"MET_LONG", VoxelType::i32},   {"MET_ULONG", VoxelType::u32},      {"MET_LONG_LONG", VoxelType::i64},
      {"MET_FLOAT", VoxelType::f32},  {"MET_ULONG_LONG", VoxelType::u64}, {"MET_DOUBLE", VoxelType::f64}};
  const auto it = known.find(name);
  if (it == known.end())
    fail(source, "its ElementType is \"" + name + "\"; known: MET_CHAR to MET_ULONG_LONG, MET_FLOAT, MET_DOUBLE");
  return it->second;
}

void read_meta_grid(const ByteSource& source, const MetaWords& words, ImageHeader& header) {
  const std::vector<double> dimensions = numbers_of(source, words, {"NDims"}, 1, {0.0});
  if (dimensions[0] != 3.0)
    fail(source, "NDims is " + detail::show(dimensions[0]) + "; a body needs 3: write the one volume that is meant");
  const std::vector<double> sizes = numbers_of(source, words, {"DimSize"}, 3, {0.0, 0.0, 0.0});
  std::array<std::int64_t, 3> size{};
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(sizes[a] >= 1.0 && sizes[a] < 1e12 && sizes[a] == std::floor(sizes[a])))
      fail(source, "its DimSize has " + detail::show(sizes[a]) + "; allowed: whole numbers from 1");
    size[a] = static_cast<std::int64_t>(sizes[a]);
  }
  const std::vector<double> spacing = numbers_of(source, words, {"ElementSpacing", "ElementSize"}, 3, {1.0, 1.0, 1.0});
  const std::vector<double> origin = numbers_of(source, words, {"Offset", "Position", "Origin"}, 3, {0.0, 0.0, 0.0});
  const std::vector<double> turn =
      numbers_of(source, words, {"TransformMatrix", "Orientation", "Rotation", "Direction"}, 9,
                 {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
  Mat3d columns;
  for (std::size_t c = 0; c < 3; ++c) {  // three numbers an axis
    for (std::size_t r = 0; r < 3; ++r) columns(r, c) = turn[3 * c + r] * spacing[c];
  }
  header.grid =
      checked_grid(source.file.string(), size, columns, {origin[0], origin[1], origin[2]}, {-1.0, -1.0, 1.0}, 1e-3);
}

void read_meta_place(const ByteSource& source, const MetaWords& words, const TextHeader& text, ImageHeader& header) {
  header.packed = is_true(first_key(words, {"CompressedData"}));
  const std::string file = first_key(words, {"ElementDataFile"});
  if (file.starts_with("LIST") || file.find('%') != file.npos)
    fail(source, "its voxels are in several files; write it as one .mha file");
  const bool local = detail::lower_case(file) == "local";
  header.data = local ? source : beside(source, file);
  header.before = local ? text.bytes : 0;
  const std::vector<double> skip = numbers_of(source, words, {"HeaderSize"}, 1, {0.0});
  if (skip[0] < -1.0 || skip[0] > 1e15 || skip[0] != std::floor(skip[0]) || (skip[0] < 0.0 && header.packed))
    fail(source,
         "its HeaderSize is " + detail::show(skip[0]) + "; allowed: 0 or more, and -1 where the voxels are not packed");
  if (skip[0] < 0.0)
    header.from_end = true;
  else
    header.before += static_cast<std::uint64_t>(skip[0]);
}

}  // namespace

ImageHeader read_metaimage(const ByteSource& source) {
  const TextHeader text = read_text_header(source, "ElementDataFile");
  const MetaWords words = meta_words(source, text);
  if (first_key(words, {"BinaryData"}).empty() ? false : !is_true(first_key(words, {"BinaryData"})))
    fail(source, "its voxels are text (BinaryData = False); write them as bytes");
  ImageHeader header;
  read_meta_grid(source, words, header);
  header.type = meta_type(source, first_key(words, {"ElementType"}));
  const std::vector<double> channels = numbers_of(source, words, {"ElementNumberOfChannels"}, 1, {1.0});
  if (channels[0] != 1.0)
    fail(source, "ElementNumberOfChannels is " + detail::show(channels[0]) + "; a body needs one number a voxel");
  header.big_endian = is_true(first_key(words, {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}));
  const std::vector<double> slope = numbers_of(source, words, {"ElementToIntensityFunctionSlope"}, 1, {1.0});
  const std::vector<double> offset = numbers_of(source, words, {"ElementToIntensityFunctionOffset"}, 1, {0.0});
  header.slope = slope[0], header.intercept = offset[0];
  read_meta_place(source, words, text, header);
  return header;
}

}  // namespace glisson::image
