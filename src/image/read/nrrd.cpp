// nrrd.cpp — the header of NRRD: lines `field: value`, and `key:=value` of other programs, as 3D Slicer's segments.
#include <charconv>
#include <cmath>

#include "base/text.h"
#include "image/read/image_header.h"

namespace glisson::image {
namespace {

using NrrdWords = std::map<std::string, std::string>;

struct NrrdLines {
  NrrdWords fields, keys;
};

NrrdLines nrrd_lines(const ByteSource& source, const TextHeader& text) {
  if (text.lines.empty() || !text.lines.front().starts_with("NRRD000"))
    fail(source, "is no NRRD file: it does not begin with NRRD0001 to NRRD0005");
  NrrdLines lines;
  for (std::size_t i = 1; i < text.lines.size(); ++i) {
    const std::string& line = text.lines[i];
    if (line.starts_with("#")) continue;
    const std::size_t key = line.find(":="), field = line.find(": ");
    if (key != line.npos && (field == line.npos || key < field)) {
      lines.keys[line.substr(0, key)] = line.substr(key + 2);
    } else if (const std::size_t colon = line.find(':'); colon != line.npos) {
      lines.fields[detail::lower_case(detail::trimmed(line.substr(0, colon)))] =
          detail::trimmed(std::string_view(line).substr(colon + 1));
    } else {
      fail(source, "line " + std::to_string(i + 1) + " of its header is neither `field: value` nor `key:=value`");
    }
  }
  return lines;
}

const std::string& required(const ByteSource& source, const NrrdWords& fields, const std::string& name) {
  const auto it = fields.find(name);
  if (it == fields.end()) fail(source, "its header has no \"" + name + "\"; the file is no complete NRRD file");
  return it->second;
}

std::string optional_field(const NrrdWords& fields, const std::string& name) {
  const auto it = fields.find(name);
  return it == fields.end() ? std::string() : it->second;
}

VoxelType nrrd_type(const ByteSource& source, const std::string& name) {
  static const std::map<std::string, VoxelType> known{{"signed char", VoxelType::i8},
                                                      {"int8", VoxelType::i8},
                                                      {"int8_t", VoxelType::i8},
                                                      {"uchar", VoxelType::u8},
                                                      {"unsigned char", VoxelType::u8},
                                                      {"uint8", VoxelType::u8},
                                                      {"uint8_t", VoxelType::u8},
                                                      {"short", VoxelType::i16},
                                                      {"short int", VoxelType::i16},
                                                      {"signed short", VoxelType::i16},
                                                      {"signed short int", VoxelType::i16},
                                                      {"int16", VoxelType::i16},
                                                      {"int16_t", VoxelType::i16},
                                                      {"ushort", VoxelType::u16},
                                                      {"unsigned short", VoxelType::u16},
                                                      {"unsigned short int", VoxelType::u16},
                                                      {"uint16", VoxelType::u16},
                                                      {"uint16_t", VoxelType::u16},
                                                      {"int", VoxelType::i32},
                                                      {"signed int", VoxelType::i32},
                                                      {"int32", VoxelType::i32},
                                                      {"int32_t", VoxelType::i32},
                                                      {"uint", VoxelType::u32},
                                                      {"unsigned int", VoxelType::u32},
                                                      {"uint32", VoxelType::u32},
                                                      {"uint32_t", VoxelType::u32},
                                                      {"longlong", VoxelType::i64},
                                                      {"long long", VoxelType::i64},
                                                      {"long long int", VoxelType::i64},
                                                      {"signed long long", VoxelType::i64},
                                                      {"signed long long int", VoxelType::i64},
                                                      {"int64", VoxelType::i64},
                                                      {"int64_t", VoxelType::i64},
                                                      {"ulonglong", VoxelType::u64},
                                                      {"unsigned long long", VoxelType::u64},
                                                      {"unsigned long long int", VoxelType::u64},
                                                      {"uint64", VoxelType::u64},
                                                      {"uint64_t", VoxelType::u64},
                                                      {"float", VoxelType::f32},
                                                      {"double", VoxelType::f64}};
  const auto it = known.find(name);
  if (it == known.end())
    fail(source, "its type is \"" + name + "\"; known: whole numbers of 8 to 64 bits, float and double");
  return it->second;
}

std::array<std::int64_t, 3> nrrd_sizes(const ByteSource& source, const NrrdWords& fields) {
  const std::vector<double> sizes = numbers_in(source, required(source, fields, "sizes"), "`sizes`");
  const std::vector<double> dimension = numbers_in(source, required(source, fields, "dimension"), "`dimension`");
  if (dimension.size() != 1 || dimension[0] != static_cast<double>(sizes.size()))
    fail(source, "its `sizes` are " + std::to_string(sizes.size()) + " numbers and do not fit its `dimension`");
  if (sizes.size() == 4)
    fail(source,
         "has 4 dimensions: segments that overlap are in layers, or the voxels are vectors; a body needs one volume "
         "(in 3D Slicer: export the segmentation as a label map)");
  if (sizes.size() != 3) fail(source, "has " + std::to_string(sizes.size()) + " dimensions; a body needs 3");
  std::array<std::int64_t, 3> out{};
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(sizes[a] >= 1.0 && sizes[a] < 1e12 && sizes[a] == std::floor(sizes[a])))
      fail(source, "its `sizes` has " + detail::show(sizes[a]) + "; allowed: whole numbers from 1");
    out[a] = static_cast<std::int64_t>(sizes[a]);
  }
  return out;
}

/// −1 where an axis of a space points against RAS.
Vec3d flips_of(const ByteSource& source, const std::string& space, std::vector<std::string>& notes) {
  const std::string name = detail::lower_case(space);
  const auto is = [&](std::string_view full, std::string_view brief) { return name == full || name == brief; };
  if (is("left-posterior-superior", "lps")) return {-1.0, -1.0, 1.0};
  if (is("right-anterior-superior", "ras")) return {1.0, 1.0, 1.0};
  if (is("left-anterior-superior", "las")) return {-1.0, 1.0, 1.0};
  if (name.empty() || is("3d-right-handed", "3d-right-handed") || is("scanner-xyz", "scanner-xyz")) {
    notes.emplace_back("the file names no anatomical space: LPS is assumed, as most programs do");
    return {-1.0, -1.0, 1.0};
  }
  fail(source, "its space is \"" + space +
                   "\"; known: left-posterior-superior, right-anterior-superior, "
                   "left-anterior-superior, also as LPS, RAS, LAS");
}

void read_nrrd_grid(const ByteSource& source, const NrrdWords& fields, ImageHeader& header) {
  const std::array<std::int64_t, 3> size = nrrd_sizes(source, fields);
  const Vec3d flip = flips_of(source, optional_field(fields, "space"), header.notes);
  Mat3d columns = identity<double>();
  Vec3d origin{};
  if (const std::string directions = optional_field(fields, "space directions"); !directions.empty()) {
    if (directions.find("none") != directions.npos)
      fail(source, "an axis of it has no direction; a body needs three in space");
    const std::vector<double> d = numbers_in(source, directions, "`space directions`");
    if (d.size() != 9)
      fail(source, "its `space directions` are " + std::to_string(d.size()) + " numbers in place of 9");
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t r = 0; r < 3; ++r) columns(r, c) = d[3 * c + r];
    }
  } else if (const std::string spacings = optional_field(fields, "spacings"); !spacings.empty()) {
    const std::vector<double> s = numbers_in(source, spacings, "`spacings`");
    if (s.size() != 3) fail(source, "its `spacings` are " + std::to_string(s.size()) + " numbers in place of 3");
    for (std::size_t a = 0; a < 3; ++a) columns(a, a) = s[a];
  } else {
    header.notes.emplace_back("the file gives no spacing: 1 mm is assumed");
  }
  if (const std::string given = optional_field(fields, "space origin"); !given.empty()) {
    const std::vector<double> o = numbers_in(source, given, "`space origin`");
    if (o.size() != 3) fail(source, "its `space origin` is " + std::to_string(o.size()) + " numbers in place of 3");
    origin = {o[0], o[1], o[2]};
  }
  const std::string units = optional_field(fields, "space units");
  double metres = 1e-3;
  if (!units.empty() && units.find("\"mm\"") == units.npos) {
    if (units.find("\"m\"") != units.npos)
      metres = 1.0;
    else if (units.find("um") != units.npos)
      metres = 1e-6;
    else
      fail(source, "its `space units` are " + units + "; known: \"mm\", \"m\", \"um\"");
  }
  header.grid = checked_grid(source.file.string(), size, columns, origin, flip, metres);
}

/// `Segment3_Name:=liver` and `Segment3_LabelValue:=5` of 3D Slicer.
void read_segments(const NrrdWords& keys, std::map<int, std::string>& names) {
  for (const auto& [key, value] : keys) {
    constexpr std::string_view kEnd = "_LabelValue";
    if (!key.starts_with("Segment") || !key.ends_with(kEnd)) continue;
    int number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    const auto name = keys.find(key.substr(0, key.size() - kEnd.size()) + "_Name");
    if (error == std::errc() && number > 0 && number < 65536 && name != keys.end()) names[number] = name->second;
  }
}

void read_nrrd_place(const ByteSource& source, const NrrdWords& fields, const TextHeader& text, ImageHeader& header) {
  const std::string encoding = detail::lower_case(required(source, fields, "encoding"));
  header.packed = encoding == "gzip" || encoding == "gz";
  if (!header.packed && encoding != "raw") fail(source, "its encoding is \"" + encoding + "\"; known: raw and gzip");
  std::string file = optional_field(fields, "data file");
  if (file.empty()) file = optional_field(fields, "datafile");
  if (file.starts_with("LIST") || file.find('%') != file.npos)
    fail(source, "its voxels are in several files; write it as one .nrrd file");
  header.data = file.empty() ? source : beside(source, file);
  header.before = file.empty() ? text.bytes : 0;
  const std::string lines = optional_field(fields, "line skip"), bytes = optional_field(fields, "byte skip");
  if (!lines.empty() && lines != "0") fail(source, "has a `line skip`, which is not known; use `byte skip`");
  if (bytes.empty()) return;
  const std::vector<double> skip = numbers_in(source, bytes, "`byte skip`");
  if (skip.size() != 1 || skip[0] < -1.0 || skip[0] > 1e15 || skip[0] != std::floor(skip[0]) ||
      (skip[0] < 0.0 && header.packed))
    fail(source, "its `byte skip` is " + bytes + "; allowed: 0 or more, and -1 where the encoding is raw");
  if (skip[0] < 0.0)
    header.from_end = true;
  else
    header.skip = static_cast<std::uint64_t>(skip[0]);
}

}  // namespace

ImageHeader read_nrrd(const ByteSource& source) {
  const TextHeader text = read_text_header(source, "");
  const NrrdLines lines = nrrd_lines(source, text);
  ImageHeader header;
  read_nrrd_grid(source, lines.fields, header);
  header.type = nrrd_type(source, detail::lower_case(required(source, lines.fields, "type")));
  const std::string endian = detail::lower_case(optional_field(lines.fields, "endian"));
  if (bytes_of(header.type) > 1 && endian != "little" && endian != "big")
    fail(source, "its endian is \"" + endian + "\"; known: little and big");
  header.big_endian = endian == "big";
  read_segments(lines.keys, header.names);
  read_nrrd_place(source, lines.fields, text, header);
  return header;
}

}  // namespace glisson::image
