// write_nifti.cpp — NIfTI-1: a header of 348 bytes, a table of labels, the voxels. Fields at fixed places, least byte first.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>
#include <vector>

#include "base/text.h"
#include "glisson/image/read_image.h"
#include "glisson/image/write_image.h"

namespace glisson {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::size_t kHeader = 348;
constexpr double kMostAlong = 32767.0;
constexpr double kRightAngle = 1e-5;  ///< cosine between axes below which a quaternion stands for them
constexpr int kCaret = 30;            ///< the code of extensions with a table of labels
constexpr std::size_t kChunk = std::size_t{1} << 20;

enum class NiftiType : std::int16_t { u8 = 2, f32 = 16, u16 = 512 };

template <class T>
void set(Bytes& bytes, std::size_t place, T value) {
  auto raw = std::bit_cast<std::array<unsigned char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  std::copy(raw.begin(), raw.end(), bytes.begin() + static_cast<std::ptrdiff_t>(place));
}

/// (b, c, d) of the unit quaternion of a rotation, the first component of which is not negative.
Vec3d quaternion_of(const Mat3d& r) {
  const std::array<double, 4> four{1.0 + r(0, 0) + r(1, 1) + r(2, 2), 1.0 + r(0, 0) - r(1, 1) - r(2, 2),
                                   1.0 - r(0, 0) + r(1, 1) - r(2, 2), 1.0 - r(0, 0) - r(1, 1) + r(2, 2)};
  const auto largest = static_cast<std::size_t>(std::max_element(four.begin(), four.end()) - four.begin());
  const double s = 0.5 / std::sqrt(four[largest]), x = r(2, 1) - r(1, 2), y = r(0, 2) - r(2, 0), z = r(1, 0) - r(0, 1),
               xy = r(0, 1) + r(1, 0), yz = r(1, 2) + r(2, 1), zx = r(2, 0) + r(0, 2);
  const std::array<std::array<double, 4>, 4> rows{{{four[0] * s, x * s, y * s, z * s},
                                                   {x * s, four[1] * s, xy * s, zx * s},
                                                   {y * s, xy * s, four[2] * s, yz * s},
                                                   {z * s, zx * s, yz * s, four[3] * s}}};
  const std::array<double, 4>& q = rows[largest];
  const double sign = q[0] < 0.0 ? -1.0 : 1.0;
  return {sign * q[1], sign * q[2], sign * q[3]};
}

/// sform of any grid; qform where its axes are at right angles.
void set_grid(const ImageGrid& grid, Bytes& bytes) {
  const Vec3d spacing = grid.spacing();
  Mat3d turn;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      turn(r, c) = grid.axes(r, c) / spacing[c];
      set(bytes, 280 + 4 * (4 * r + c), static_cast<float>(1e3 * grid.axes(r, c)));
    }
    set(bytes, 280 + 4 * (4 * r + 3), static_cast<float>(1e3 * grid.origin[r]));
    set(bytes, 80 + 4 * r, static_cast<float>(1e3 * spacing[r]));
  }
  set<std::int16_t>(bytes, 254, 1);
  const double side = determinant(turn) < 0.0 ? -1.0 : 1.0;
  set(bytes, 76, static_cast<float>(side));
  const auto column = [&](std::size_t c) { return Vec3d{turn(0, c), turn(1, c), turn(2, c)}; };
  const bool square = std::abs(dot(column(0), column(1))) < kRightAngle &&
                      std::abs(dot(column(1), column(2))) < kRightAngle &&
                      std::abs(dot(column(2), column(0))) < kRightAngle;
  if (!square) return;
  for (std::size_t r = 0; r < 3; ++r) turn(r, 2) *= side;
  const Vec3d q = quaternion_of(turn);
  set<std::int16_t>(bytes, 252, 1);
  for (std::size_t a = 0; a < 3; ++a) {
    set(bytes, 256 + 4 * a, static_cast<float>(q[a]));
    set(bytes, 268 + 4 * a, static_cast<float>(1e3 * grid.origin[a]));
  }
}

/// The table of labels as Connectome Workbench writes it; empty where there are no names.
std::string label_table(const std::map<int, std::string>& names) {
  if (names.empty()) return {};
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<CaretExtension>\n<VolumeInformation Index=\"0\">\n<LabelTable>\n";
  for (const auto& [label, name] : names) {
    std::string plain = name;
    for (std::size_t at; (at = plain.find("]]>")) != plain.npos;) plain.erase(at, 3);
    const double hue = 0.61803398875 * label;
    const auto colour = [&](double shift) { return std::to_string(0.5 + 0.5 * std::cos(6.2831853 * (hue + shift))); };
    text += "<Label Key=\"" + std::to_string(label) + "\" Red=\"" + colour(0.0) + "\" Green=\"" + colour(1.0 / 3.0) +
            "\" Blue=\"" + colour(2.0 / 3.0) + "\" Alpha=\"1\"><![CDATA[" + plain + "]]></Label>\n";
  }
  text += "</LabelTable>\n<VolumeType><![CDATA[Label]]></VolumeType>\n</VolumeInformation>\n</CaretExtension>\n";
  return text;
}

struct NiftiContent {
  const ImageGrid& grid;
  NiftiType type = NiftiType::f32;
  std::size_t components = 1;
  std::int16_t intent = 0;
  std::string name{}, description{};  ///< of the intent; of the image
};

/// Header and table, up to the first voxel. @throws ImageError
Bytes head_of(const std::filesystem::path& file, const NiftiContent& content, const std::string& table) {
  Bytes bytes(kHeader + 4, 0);
  set<std::int32_t>(bytes, 0, kHeader);
  bytes[38] = 'r';
  const bool several = content.components > 1;
  const std::array<std::size_t, 8> dim{
      several ? 5U : 3U, content.grid.size[0], content.grid.size[1], content.grid.size[2], 1, content.components, 1, 1};
  for (std::size_t a = 0; a < dim.size(); ++a) {
    if (static_cast<double>(dim[a]) > kMostAlong)
      throw ImageError(file.string() + ": " + std::to_string(dim[a]) + " voxels along an axis; NIfTI-1 has at most " +
                       detail::number_text(kMostAlong));
    set(bytes, 40 + 2 * a, static_cast<std::int16_t>(dim[a]));
    if (a > 3) set(bytes, 76 + 4 * a, 1.0F);
  }
  set(bytes, 68, content.intent);
  set(bytes, 70, static_cast<std::int16_t>(content.type));
  const int bits = content.type == NiftiType::f32 ? 32 : content.type == NiftiType::u16 ? 16 : 8;
  set(bytes, 72, static_cast<std::int16_t>(bits));
  set(bytes, 112, 1.0F);
  bytes[123] = 2;  // mm
  std::memcpy(bytes.data() + 148, content.description.data(), std::min<std::size_t>(content.description.size(), 79));
  std::memcpy(bytes.data() + 328, content.name.data(), std::min<std::size_t>(content.name.size(), 15));
  std::memcpy(bytes.data() + 344, "n+1", 4);
  set_grid(content.grid, bytes);
  if (!table.empty()) {
    const std::size_t size = (table.size() + 8 + 15) / 16 * 16;
    bytes[kHeader] = 1;
    bytes.resize(kHeader + 4 + size, 0);
    set(bytes, kHeader + 4, static_cast<std::int32_t>(size));
    set<std::int32_t>(bytes, kHeader + 8, kCaret);
    std::copy(table.begin(), table.end(), bytes.begin() + kHeader + 12);
  }
  set(bytes, 108, static_cast<float>(bytes.size()));
  return bytes;
}

/// FILE.part, which becomes FILE once it is complete, and is gone where it does not.
class NewFile {
 public:
  explicit NewFile(std::filesystem::path file) : file_(std::move(file)), part_(file_) {
    const std::string name = detail::lower_case(file_.filename().string());
    const bool packed = name.ends_with(".nii.gz");
    if (!packed && !name.ends_with(".nii"))
      throw ImageError(file_.string() + ": images are written as NIfTI; give a name that ends in .nii or .nii.gz");
    std::error_code none;
    const std::filesystem::path folder = file_.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder, none))
      throw ImageError(file_.string() + ": its folder " + folder.string() + " does not exist; create it first");
    part_ += ".part";
    out_ = gzopen(part_.c_str(), packed ? "wb4" : "wbT");
    if (out_ == nullptr) refuse();
  }
  ~NewFile() {
    if (out_ != nullptr) gzclose(out_);
    std::error_code none;
    std::filesystem::remove(part_, none);
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void write(const void* bytes, std::size_t size) {
    const auto* at = static_cast<const unsigned char*>(bytes);
    for (; size > 0;) {
      const std::size_t step = std::min(size, kChunk);
      if (gzwrite(out_, at, static_cast<unsigned>(step)) != static_cast<int>(step)) refuse();
      at += step, size -= step;
    }
  }
  void finish() {
    const int closed = gzclose(out_);
    out_ = nullptr;
    if (closed != Z_OK) refuse();
    std::error_code error;
    std::filesystem::rename(part_, file_, error);
    if (error) throw ImageError(file_.string() + ": it cannot be written: " + error.message());
  }

 private:
  [[noreturn]] void refuse() const {
    throw ImageError(file_.string() + ": it cannot be written: " + (errno != 0 ? std::strerror(errno) : "zlib failed") +
                     "; check the folder, its permissions and the space left");
  }

  std::filesystem::path file_, part_;
  gzFile out_ = nullptr;
};

/// Numbers of the machine, least byte first.
template <class T>
void write_numbers(NewFile& out, const std::vector<T>& numbers) {
  if constexpr (std::endian::native == std::endian::little || sizeof(T) == 1) {
    out.write(numbers.data(), numbers.size() * sizeof(T));
  } else {
    Bytes bytes(sizeof(T));
    for (const T number : numbers) {
      set(bytes, 0, number);
      out.write(bytes.data(), bytes.size());
    }
  }
}

template <class T>
void write_file(const std::filesystem::path& file, const NiftiContent& content, const std::string& table,
                const std::vector<T>& numbers) {
  if (numbers.size() != content.grid.voxels() * content.components)
    throw std::invalid_argument(file.string() + ": " + std::to_string(numbers.size()) + " numbers for " +
                                std::to_string(content.grid.voxels()) + " voxels of " +
                                std::to_string(content.components));
  const Bytes head = head_of(file, content, table);
  NewFile out(file);
  out.write(head.data(), head.size());
  write_numbers(out, numbers);
  out.finish();
}

}  // namespace

void write_nifti(const std::filesystem::path& file, const ValueImage& image, VoxelValues kind,
                 const std::string& description) {
  struct Kind {
    int components;
    std::int16_t intent;
    const char* name;
  };
  const Kind of = kind == VoxelValues::vector         ? Kind{3, 1007, "vector"}
                  : kind == VoxelValues::displacement ? Kind{3, 1006, "displacement"}
                  : kind == VoxelValues::symmetric    ? Kind{6, 1007, "symmetric tensor"}
                                                      : Kind{0, 0, ""};
  if (of.components > 0 && image.components != of.components)
    throw ImageError(file.string() + ": a " + of.name + " has " + std::to_string(of.components) + " components, not " +
                     std::to_string(image.components));
  write_file(file,
             {image.grid, NiftiType::f32, static_cast<std::size_t>(image.components), of.intent, of.name, description},
             {}, image.values);
}

void write_nifti(const std::filesystem::path& file, const LabelImage& image, const std::string& description) {
  const std::string table = label_table(image.names);
  const bool bytes = std::all_of(image.voxels.begin(), image.voxels.end(), [](std::uint16_t v) { return v < 256; });
  const NiftiContent content{image.grid, bytes ? NiftiType::u8 : NiftiType::u16, 1, 1002, {}, description};
  if (!bytes) return write_file(file, content, table, image.voxels);
  std::vector<std::uint8_t> small(image.voxels.size());
  std::transform(image.voxels.begin(), image.voxels.end(), small.begin(),
                 [](std::uint16_t v) { return static_cast<std::uint8_t>(v); });
  write_file(file, content, table, small);
}

}  // namespace glisson
