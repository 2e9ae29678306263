// nifti.cpp — the header of NIfTI-1 and NIfTI-2: fields at fixed places, in either byte order.
//
//   a sform:   x = S (i, j, k, 1)ᵀ, rows srow_x, srow_y, srow_z
//   a qform:   x = R(b, c, d) diag(1, 1, qfac) diag(spacing) (i, j, k)ᵀ + offset,  R of the quaternion (√(1 − b² − c² − d²), b, c, d)
//   neither:   x = diag(spacing) (i, j, k)ᵀ
// The first that the file has counts, as the standard and its libraries have it.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/text.h"
#include "image/read/image_header.h"

namespace glisson::image {
namespace {

constexpr std::size_t kBytes1 = 348, kBytes2 = 540;
constexpr std::uint64_t kMostExtensions = std::uint64_t{4} << 20;

bool is_packed(const ByteSource& source) {
  ByteStream stream(source, ByteStream::Packing::none);
  unsigned char magic[2] = {};
  return stream.read(magic, 2) == 2 && magic[0] == 0x1f && magic[1] == 0x8b;
}

/// Fields of the header by their places.
class Fields {
 public:
  Fields(const std::vector<unsigned char>& bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}

  template <class T>
  T at(std::size_t place) const {
    std::array<unsigned char, sizeof(T)> raw{};
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(place), sizeof(T), raw.begin());
    if (swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

 private:
  const std::vector<unsigned char>& bytes_;
  bool swapped_;
};

/// What both versions have, in one form.
struct Nifti {
  std::array<std::int64_t, 8> dim{};
  std::array<double, 8> pixdim{};
  int type = 0, sform = 0, qform = 0, units = 0;
  double slope = 0.0, intercept = 0.0, vox_offset = 0.0;
  std::array<double, 3> quaternion{}, offset{};
  std::array<std::array<double, 4>, 3> rows{};
};

template <class Real, class Size>
void read_arrays(const Fields& f, std::size_t dim, std::size_t pixdim, std::size_t quaternion, std::size_t rows,
                 Nifti& n) {
  for (std::size_t i = 0; i < 8; ++i) {
    n.dim[i] = f.at<Size>(dim + i * sizeof(Size));
    n.pixdim[i] = f.at<Real>(pixdim + i * sizeof(Real));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    n.quaternion[i] = f.at<Real>(quaternion + i * sizeof(Real));
    n.offset[i] = f.at<Real>(quaternion + (i + 3) * sizeof(Real));
    for (std::size_t j = 0; j < 4; ++j) n.rows[i][j] = f.at<Real>(rows + (4 * i + j) * sizeof(Real));
  }
}

Nifti first_version(const Fields& f) {
  Nifti n;
  read_arrays<float, std::int16_t>(f, 40, 76, 256, 280, n);
  n.type = f.at<std::int16_t>(70);
  n.vox_offset = f.at<float>(108);
  n.slope = f.at<float>(112);
  n.intercept = f.at<float>(116);
  n.units = f.at<std::uint8_t>(123);
  n.qform = f.at<std::int16_t>(252);
  n.sform = f.at<std::int16_t>(254);
  return n;
}

Nifti second_version(const Fields& f) {
  Nifti n;
  read_arrays<double, std::int64_t>(f, 16, 104, 352, 400, n);
  n.type = f.at<std::int16_t>(12);
  n.vox_offset = static_cast<double>(f.at<std::int64_t>(168));
  n.slope = f.at<double>(176);
  n.intercept = f.at<double>(184);
  n.qform = f.at<std::int32_t>(344);
  n.sform = f.at<std::int32_t>(348);
  n.units = f.at<std::int32_t>(500);
  return n;
}

VoxelType nifti_type(const ByteSource& source, int code) {
  switch (code) {
    case 2:
      return VoxelType::u8;
    case 4:
      return VoxelType::i16;
    case 8:
      return VoxelType::i32;
    case 16:
      return VoxelType::f32;
    case 64:
      return VoxelType::f64;
    case 256:
      return VoxelType::i8;
    case 512:
      return VoxelType::u16;
    case 768:
      return VoxelType::u32;
    case 1024:
      return VoxelType::i64;
    case 1280:
      return VoxelType::u64;
    default:
      fail(source,
           "its voxels are of NIfTI's type " + std::to_string(code) +
               "; known: whole numbers of 8 to 64 bits, float and double (2, 4, 8, 16, 64, 256, 512, 768, 1024, 1280)");
  }
}

/// Columns and origin by the quaternion, in the file's unit.
std::pair<Mat3d, Vec3d> by_quaternion(const ByteSource& source, const Nifti& n) {
  auto [b, c, d] = n.quaternion;
  double a = 1.0 - (b * b + c * c + d * d);
  if (!(a > -1e-3)) fail(source, "the quaternion of its qform is longer than 1; write the image again");
  if (a < 1e-7) {  // a turn by 180°: of single precision, b, c, d alone
    const double length = std::sqrt(b * b + c * c + d * d);
    b /= length, c /= length, d /= length;
    a = 0.0;
  } else {
    a = std::sqrt(a);
  }
  const Mat3d turn{{{{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                     {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
                     {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - c * c - b * b}}}};
  const double side = n.pixdim[0] < 0.0 ? -1.0 : 1.0;
  Mat3d columns;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) columns(r, k) = turn(r, k) * n.pixdim[k + 1] * (k == 2 ? side : 1.0);
  }
  return {columns, {n.offset[0], n.offset[1], n.offset[2]}};
}

double metres_of(const ByteSource& source, int units, std::vector<std::string>& notes) {
  switch (units & 7) {
    case 1:
      return 1.0;
    case 2:
      return 1e-3;
    case 3:
      return 1e-6;
    case 0:
      notes.emplace_back("the file gives no unit of length: millimetres are assumed");
      return 1e-3;
    default:
      fail(source, "its unit of length is " + std::to_string(units & 7) + "; known: 1 m, 2 mm, 3 µm");
  }
}

ImageGrid nifti_grid(const ByteSource& source, const Nifti& n, std::vector<std::string>& notes) {
  Mat3d columns;
  Vec3d origin{};
  if (n.sform > 0) {
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) columns(r, c) = n.rows[r][c];
      origin[r] = n.rows[r][3];
    }
  } else if (n.qform > 0) {
    std::tie(columns, origin) = by_quaternion(source, n);
  } else {
    for (std::size_t a = 0; a < 3; ++a) columns(a, a) = n.pixdim[a + 1];
    notes.emplace_back(
        "the file gives no orientation: i, j, k are assumed to run to the right, the front and the head, from 0");
  }
  const double metres = metres_of(source, n.units, notes);
  return checked_grid(source.file.string(), {n.dim[1], n.dim[2], n.dim[3]}, columns, origin, {1.0, 1.0, 1.0}, metres);
}

void require_three_dimensions(const ByteSource& source, Nifti& n) {
  if (n.dim[0] < 2 || n.dim[0] > 7)
    fail(source, "its header gives " + std::to_string(n.dim[0]) + " dimensions; allowed: 2 to 7");
  if (n.dim[0] == 2) n.dim[3] = 1;
  for (std::size_t i = 4; i <= static_cast<std::size_t>(n.dim[0]); ++i) {
    if (n.dim[i] > 1)
      fail(source, "has " + std::to_string(n.dim[0]) + " dimensions, " + std::to_string(n.dim[i]) +
                       " values along that of number " + std::to_string(i) +
                       "; a body needs one volume: write the one that is meant");
  }
}

/// `<Label Key="5" …><![CDATA[liver]]></Label>` of Connectome Workbench and programs that write as it does.
void read_label_table(std::string_view text, std::map<int, std::string>& names) {
  constexpr std::string_view kLabel = "<Label ", kKey = "Key=\"", kOpen = "<![CDATA[", kClose = "]]>";
  for (std::size_t at = text.find(kLabel); at != text.npos; at = text.find(kLabel, at + 1)) {
    const std::size_t next = text.find(kLabel, at + 1);
    const std::string_view entry = text.substr(at, next == text.npos ? text.npos : next - at);
    const std::size_t key = entry.find(kKey), open = entry.find(kOpen);
    const std::size_t close = open == entry.npos ? entry.npos : entry.find(kClose, open);
    if (key == entry.npos || close == entry.npos) continue;
    int number = 0;
    for (std::size_t i = key + kKey.size(); i < entry.size() && entry[i] >= '0' && entry[i] <= '9' && number < 65536;
         ++i)
      number = 10 * number + (entry[i] - '0');
    const std::string_view name = detail::trimmed(entry.substr(open + kOpen.size(), close - open - kOpen.size()));
    if (number > 0 && number < 65536 && !name.empty()) names[number] = name;
  }
}

/// Reads what lies between header and voxels.
void read_extensions(ByteStream& stream, std::uint64_t end, ImageHeader& header) {
  if (end <= stream.position() || end - stream.position() > kMostExtensions) return;
  std::string text(static_cast<std::size_t>(end - stream.position()), '\0');
  text.resize(stream.read(text.data(), text.size()));
  read_label_table(text, header.names);
}

}  // namespace

ImageHeader read_nifti(const ByteSource& source) {
  ImageHeader header;
  header.data = source;
  header.packed = is_packed(source);
  ByteStream stream(source, header.packed ? ByteStream::Packing::gzip : ByteStream::Packing::none);
  std::vector<unsigned char> bytes(kBytes1);
  if (stream.read(bytes.data(), kBytes1) < kBytes1)
    fail(source, "is shorter than the header of a NIfTI file (348 bytes)");
  std::int32_t length = 0;
  std::memcpy(&length, bytes.data(), 4);
  const std::int32_t reversed = Fields(bytes, true).at<std::int32_t>(0);
  const bool second = length == 540 || reversed == 540;
  if (!second && length != 348 && reversed != 348)
    fail(source, "is no NIfTI file: it begins with " + std::to_string(length) + " in place of 348 or 540");
  header.big_endian = length != 348 && length != 540;
  if (second) {
    bytes.resize(kBytes2);
    if (stream.read(bytes.data() + kBytes1, kBytes2 - kBytes1) < kBytes2 - kBytes1)
      fail(source, "is shorter than the header of a NIfTI-2 file (540 bytes)");
  }
  const char* magic = reinterpret_cast<const char*>(bytes.data()) + (second ? 4 : 344);
  if (std::memcmp(magic, second ? "n+2" : "n+1", 3) != 0)
    fail(source, std::memcmp(magic, "ni", 2) == 0 ? "is the header of a pair (.hdr, .img); write it as one .nii file"
                                                  : "is no NIfTI file of version 1 or 2 (an Analyze file?)");
  const Fields fields(bytes, header.big_endian);
  Nifti n = second ? second_version(fields) : first_version(fields);
  require_three_dimensions(source, n);
  header.type = nifti_type(source, n.type);
  header.grid = nifti_grid(source, n, header.notes);
  if (std::isfinite(n.slope) && n.slope != 0.0) {
    header.slope = n.slope;
    header.intercept = std::isfinite(n.intercept) ? n.intercept : 0.0;
  }
  const double least = second ? 544.0 : 352.0;
  if (!(n.vox_offset >= least - 4.0 && n.vox_offset < 1e9) && n.vox_offset != 0.0)
    fail(source, "its voxels should begin at byte " + detail::number_text(n.vox_offset, 12) +
                     "; allowed: " + detail::number_text(least) + " or more");
  header.skip = static_cast<std::uint64_t>(std::max(n.vox_offset, least));
  read_extensions(stream, header.skip, header);
  return header;
}

}  // namespace glisson::image
