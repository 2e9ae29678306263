// read_image_test.cpp — images of files: grids as other programs read them, to the last digit, and messages about files that are wrong.
#include "glisson/image/read_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "image/read/read_image.h"
#include "support/places.h"

namespace glisson {
namespace {

using testing::HasSubstr;

std::filesystem::path data(const std::string& name) { return test::shipped("tests/image/data") / name; }

std::string bytes_of(const std::string& name) {
  std::ifstream file(data(name), std::ios::binary);
  std::stringstream all;
  all << file.rdbuf();
  return all.str();
}

/// What reading these bytes as that file says.
std::string refusal(const std::string& name, const std::string& bytes, const ReadImageOptions& options = {}) {
  try {
    image::read_labels({name, bytes}, options);
  } catch (const ImageError& error) {
    return error.what();
  }
  return "was read";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

int expected_label(std::size_t i, std::size_t j, std::size_t k) { return static_cast<int>((i + 3 * j + 7 * k) % 11); }

struct Reference {
  std::string file, reader;
  std::array<std::size_t, 3> size{};
  double numbers[12]{};
};

std::vector<Reference> references() {
  std::vector<Reference> all;
  std::ifstream file(data("references.txt"));
  for (Reference r; file >> r.file >> r.size[0] >> r.size[1] >> r.size[2];) {
    for (double& x : r.numbers) file >> x;
    file >> r.reader;
    all.push_back(r);
  }
  return all;
}

// Turned, sheared, flipped and left-handed grids of all formats, in either byte order, are those that nibabel and SimpleITK read, to the
// rounding of double precision (1e-13 of the numbers; the change from mm to m costs one rounding).
TEST(ReadImage, GridsAreThoseOfOtherReaders) {
  const std::vector<Reference> all = references();
  ASSERT_GE(all.size(), 17u);
  for (const Reference& r : all) {
    const LabelImage image = read_label_image(data(r.file));
    EXPECT_EQ(image.grid.size, r.size) << r.file;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t c = 0; c < 4; ++c) {
        const double expected = r.numbers[4 * row + c],
                     got = 1e3 * (c < 3 ? image.grid.axes(row, c) : image.grid.origin[row]);
        EXPECT_NEAR(got, expected, 1e-13 * (4.0 + std::abs(expected)))
            << r.file << " (" << r.reader << ") row " << row << " column " << c;
      }
    }
  }
}

// Every voxel of every file has the label that was written, whatever the type of its numbers, their order and packing.
TEST(ReadImage, VoxelsAreThoseThatWereWritten) {
  for (const Reference& r : references()) {
    const LabelImage image = read_label_image(data(r.file));
    for (std::size_t v = 0; v < image.voxels.size(); ++v) {
      const auto [i, j, k] = image.grid.place(v);
      ASSERT_EQ(image.voxels[v], expected_label(i, j, k)) << r.file << " at " << i << " " << j << " " << k;
    }
  }
}

// World and index undo each other on a sheared grid.
TEST(ReadImage, IndexIsTheInverseOfWorld) {
  const ImageGrid grid = read_label_image(data("sform_sheared.nii.gz")).grid;
  const Vec3d there = grid.world({1.5, -2.0, 7.25}), back = grid.index(there);
  EXPECT_NEAR(norm(back - Vec3d{1.5, -2.0, 7.25}), 0.0, 1e-12);
  EXPECT_NEAR(grid.voxel_volume(), 0.7e-3 * 1.25e-3 * 3.1e-3,
              1e-15);  // a shear keeps the volume; 1e-6 of it, single precision
}

// Segments of 3D Slicer have their names.
TEST(ReadImage, SegmentsHaveNames) {
  const LabelImage image = read_label_image(data("segments.seg.nrrd"));
  EXPECT_THAT(image.names, testing::ElementsAre(testing::Pair(5, "liver"), testing::Pair(7, "portal vein")));
  EXPECT_EQ(image.name_of(5), "liver");
  EXPECT_EQ(image.name_of(6), "label 6");
  EXPECT_EQ(read_label_names(data("segments.seg.nrrd")), image.names);
}

// A label table in an extension of a NIfTI file gives the names.
TEST(ReadImage, LabelTableOfNiftiGivesNames) {
  std::string bytes = bytes_of("sform.nii");
  const std::string table =
      "<LabelTable><Label Key=\"3\" Red=\"1\"><![CDATA[ spleen ]]></Label>\n<Label "
      "Key=\"10\"><![CDATA[liver]]></Label></LabelTable>";
  std::string extension(8, '\0');
  const auto length = static_cast<std::uint32_t>(8 + table.size());
  std::memcpy(extension.data(), &length, 4);
  const float begin = static_cast<float>(352 + length);
  std::memcpy(bytes.data() + 108, &begin, 4);
  bytes.insert(352, extension + table);
  const LabelImage image = image::read_labels({"with_names.nii", bytes}, {});
  EXPECT_THAT(image.names, testing::ElementsAre(testing::Pair(3, "spleen"), testing::Pair(10, "liver")));
  EXPECT_EQ(image.voxels[1], 1);
}

// Cropping as the file is read gives the voxels and places that cropping the whole image would.
TEST(ReadImage, CroppedImageIsPartOfTheWhole) {
  std::string bytes = bytes_of("turned_raw.mha");
  const std::size_t first = bytes.size() - 60;
  bytes[first + 2 + 5 * (1 + 4 * 1)] = bytes[first + 3 + 5 * (2 + 4 * 1)] = 77;
  const LabelImage whole = image::read_labels({"a.mha", bytes}, {});
  const LabelImage part = image::read_labels({"a.mha", bytes}, {.crop_to = {77}, .margin = 1});
  EXPECT_EQ(part.grid.size, (std::array<std::size_t, 3>{4, 4, 3}));
  EXPECT_EQ(part.crop_low, (std::array<std::size_t, 3>{1, 0, 0}));
  EXPECT_EQ(part.whole, whole.grid.size);
  std::size_t found = 0;
  for (std::size_t v = 0; v < part.voxels.size(); ++v) {
    auto at = part.grid.place(v);
    for (std::size_t a = 0; a < 3; ++a) at[a] += part.crop_low[a];
    EXPECT_EQ(part.voxels[v], whole.voxels[whole.grid.at(at[0], at[1], at[2])]);
    const auto here = part.grid.place(v);
    const Vec3d p =
        part.grid.world({static_cast<double>(here[0]), static_cast<double>(here[1]), static_cast<double>(here[2])});
    const Vec3d q =
        whole.grid.world({static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
    EXPECT_NEAR(norm(p - q), 0.0, 1e-15);
    found += part.voxels[v] == 77;
  }
  EXPECT_EQ(found, 2u);
}

// Values of a grey image are scaled as the file says, and files without a unit or an orientation say what was assumed.
TEST(ReadImage, GreyValuesAreScaled) {
  std::string bytes = bytes_of("big_endian.nii");  // 32 bits, big-endian
  const auto put = [&](std::size_t at, std::uint32_t bits) {
    for (std::size_t b = 0; b < 4; ++b) bytes[at + b] = static_cast<char>(bits >> (24 - 8 * b));
  };
  put(112, 0x40200000);  // 2.5
  put(116, 0xC0400000);  // −3
  bytes[123] = 0;
  bytes[253] = bytes[255] = 0;  // neither qform nor sform
  const GreyImage image = image::read_grey({"scaled.nii", bytes}, {});
  EXPECT_EQ(image.voxels[1], 2.5f * 1.0f - 3.0f);
  EXPECT_EQ(image.voxels[5], 2.5f * 3.0f - 3.0f);
  ASSERT_EQ(image.notes.size(), 2u);
  EXPECT_THAT(image.notes[0], HasSubstr("no orientation"));
  EXPECT_THAT(image.notes[1], HasSubstr("millimetres"));
  EXPECT_DOUBLE_EQ(image.grid.axes(2, 2), 1e-3);
}

// A file that ends early is refused, packed or not, also where only the check sum is missing.
TEST(ReadImage, TruncatedFilesAreRefused) {
  for (const std::string name : {"sform.nii", "sform_sheared.nii.gz", "turned.nrrd", "turned.mha", "turned_raw.mha"}) {
    const std::string whole = bytes_of(name);
    for (const std::size_t lost : {std::size_t{1}, std::size_t{4}, std::size_t{9}, std::size_t{30}}) {
      const std::string said = refusal(name, whole.substr(0, whole.size() - lost));
      EXPECT_THAT(said, testing::AllOf(HasSubstr(name + ": "), HasSubstr("truncated"))) << lost;
    }
  }
}

// A byte that is damaged in packed voxels is found by zlib's check sum.
TEST(ReadImage, DamagedFilesAreRefused) {
  std::string bytes = bytes_of("sform_sheared.nii.gz");
  bytes[bytes.size() - 6] = static_cast<char>(bytes[bytes.size() - 6] ^ 0x10);  // of the check sum itself
  EXPECT_THAT(refusal("damaged.nii.gz", bytes), HasSubstr("cannot be unpacked"));
}

// Headers that lie: sizes, offsets, directions, dimensions, types. Each message names the file and what is wrong.
TEST(ReadImage, HeadersThatLieAreRefused) {
  const std::string nifti = bytes_of("sform.nii"), nrrd = bytes_of("turned.nrrd"), meta = bytes_of("turned.mha");
  const auto with = [&](std::size_t at, const std::string& raw) {
    return std::string(nifti).replace(at, raw.size(), raw);
  };
  EXPECT_THAT(refusal("a.nii", with(42, {"\xff\x7f", 2})), HasSubstr("header is wrong"));
  EXPECT_THAT(refusal("a.nii", with(42, {"\0\0", 2})), HasSubstr("0 voxels along axis 1; allowed: 1 or more"));
  EXPECT_THAT(refusal("a.nii", with(42, {"\xff\xff", 2})), HasSubstr("-1 voxels"));
  EXPECT_THAT(refusal("a.nii", with(40, {"\4\0\5\0\4\0\3\0\2\0", 10})), HasSubstr("has 4 dimensions, 2 values"));
  EXPECT_THAT(refusal("a.nii", with(70, {"\x80\0", 2})), HasSubstr("NIfTI's type 128"));
  EXPECT_THAT(refusal("a.nii", with(108, {"\0\0\x80\x3f", 4})),
              HasSubstr("should begin at byte 1; allowed: 352 or more"));
  EXPECT_THAT(refusal("a.nii", with(280, std::string(48, '\0'))), HasSubstr("span no volume"));
  EXPECT_THAT(refusal("a.nii", with(280, {"\0\0\xc0\x7f", 4})), HasSubstr("not finite"));
  EXPECT_THAT(refusal("a.nii", with(344, {"ni1", 3})), HasSubstr("pair (.hdr, .img)"));
  EXPECT_THAT(refusal("a.nii", with(0, {"\1", 1})), HasSubstr("is no NIfTI file"));
  EXPECT_THAT(refusal("a.nii", "short"), HasSubstr("shorter than the header"));
  EXPECT_THAT(refusal("a.nrrd", replaced(nrrd, "sizes: 5 4 3", "sizes: 5 4 9000")),
              HasSubstr("truncated: it ends in row 13 of the 36000"));
  EXPECT_THAT(refusal("a.nrrd", replaced(nrrd, "sizes: 5 4 3", "sizes: 5 4")), HasSubstr("do not fit its `dimension`"));
  EXPECT_THAT(refusal("a.nrrd", replaced(nrrd, "encoding: gzip", "encoding: hex")), HasSubstr("known: raw and gzip"));
  EXPECT_THAT(refusal("a.nrrd", replaced(nrrd, "left-posterior", "left-inferior")), HasSubstr("its space is"));
  EXPECT_THAT(refusal("a.nrrd", replaced(nrrd, "dimension: 3", "dimension: x")), HasSubstr("no number"));
  EXPECT_THAT(refusal("a.nrrd", "NRRD0004\ntype: uchar\n\n"), HasSubstr("has no \"sizes\""));
  EXPECT_THAT(refusal("a.mha", replaced(meta, "NDims = 3", "NDims = 4")), HasSubstr("NDims is 4"));
  EXPECT_THAT(refusal("a.mha", replaced(meta, "DimSize = 5 4 3", "DimSize = 5 4 -3")),
              HasSubstr("allowed: whole numbers from 1"));
  EXPECT_THAT(refusal("a.mha", replaced(meta, "MET_UCHAR", "MET_STRING")), HasSubstr("its ElementType is"));
  EXPECT_THAT(refusal("a.mhd", replaced(meta, "LOCAL", "other.raw")), HasSubstr("other.raw"));
  EXPECT_THAT(refusal("a.png", "x"), HasSubstr("known: .nii"));
  EXPECT_THAT(refusal("a.mha", "x"), HasSubstr("is no MetaImage"));
}

// A packed file whose header asks for far more than it can hold is refused before any memory is taken.
TEST(ReadImage, NoMemoryIsTakenForAHeaderThatLies) {
  const std::string nrrd = replaced(bytes_of("turned.nrrd"), "sizes: 5 4 3", "sizes: 10000 10000 1000");
  EXPECT_THAT(refusal("a.nrrd", nrrd), testing::AllOf(HasSubstr("header is wrong"), HasSubstr("100000000000")));
}

// Numbers that are no labels are refused with their voxel; a float image of whole numbers is one of labels.
TEST(ReadImage, NumbersThatAreNoLabelsAreRefused) {
  std::string bytes = bytes_of("second_version_big.nii");
  bytes[bytes.size() - 2] = 1;  // 64 bits, big-endian: 256 more in the last voxel
  EXPECT_EQ(image::read_labels({"a.nii", bytes}, {}).voxels.back(), 256 + expected_label(4, 3, 2));
  bytes[bytes.size() - 8] = static_cast<char>(0xff);
  EXPECT_THAT(refusal("a.nii", bytes), testing::AllOf(HasSubstr("voxel (4, 3, 2) is -"), HasSubstr("no label")));
  std::string half =
      replaced(bytes_of("turned_raw.mha"), "MET_UCHAR", "MET_UCHAR\nElementToIntensityFunctionSlope = 0.5");
  EXPECT_THAT(refusal("a.mha", half), HasSubstr("voxel (1, 0, 0) is 0.5"));
}

// Labels to crop to that are not there are named, with those that are.
TEST(ReadImage, LabelsThatAreNotThereAreNamed) {
  EXPECT_THAT(refusal("turned.nrrd", bytes_of("turned.nrrd"), {.crop_to = {3, 12}}),
              HasSubstr("no voxel has the label 12; there are: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10"));
}

// An image of more voxels than memory is refused with what it needs, and read where it is cropped to what is wanted.
TEST(ReadImage, TooLargeIsRefusedOrCropped) {
  const std::string bytes = bytes_of("turned.nrrd");
  EXPECT_THAT(refusal("turned.nrrd", bytes, {.memory = 100.0}),
              HasSubstr("60 voxels need 0.00012 MB, and 0.0001 MB may be taken; choose labels"));
  std::string one(60, '\0');
  one[27] = 1;
  const std::string meta = bytes_of("turned_raw.mha");
  const LabelImage image =
      image::read_labels({"one.mha", meta.substr(0, meta.size() - 60) + one}, {.crop_to = {1}, .memory = 2.0});
  EXPECT_EQ(image.grid.voxels(), 1u);
  EXPECT_EQ(image.crop_low, (std::array<std::size_t, 3>{2, 1, 1}));
}

// A file that is not there, or is a folder, is a message.
TEST(ReadImage, MissingFileIsAMessage) {
  EXPECT_THAT([] { read_label_image("/nowhere/a.nii"); },
              testing::ThrowsMessage<ImageError>(HasSubstr("/nowhere/a.nii: there is no such file")));
  EXPECT_TRUE(is_image_file("x/Y.SEG.NRRD"));
  EXPECT_FALSE(is_image_file("x.vtu"));
}

}  // namespace
}  // namespace glisson
