// implant.cpp — see implant.h.
#include "image/implant.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/text.h"
#include "glisson/image/read_image.h"
#include "image/label_fields.h"

namespace glisson::image {
namespace {

/// A number with or without `mm` behind it [m].
double length_of(std::string_view text, const std::string& word) {
  text = detail::trimmed(text);
  if (text.ends_with("mm")) text = detail::trimmed(text.substr(0, text.size() - 2));
  double x = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(x) <= 1e7))
    throw std::invalid_argument("implant \"" + word + "\": \"" + std::string(text) + "\" is no length in mm");
  return 1e-3 * x;
}

[[noreturn]] void refuse_word(const std::string& word, const std::string& what) {
  throw std::invalid_argument(
      "implant \"" + word + "\": " + what +
      "; write NAME=ball:X,Y,Z,DIAMETERmm, NAME=ellipsoid:X,Y,Z,A,B,Cmm or NAME=labels:FILE:LABELS");
}

void read_shape(std::string_view rest, const std::string& word, ImplantWord& implant) {
  for (;;) {
    const std::size_t comma = rest.find(',');
    implant.numbers.push_back(length_of(rest.substr(0, comma), word));
    if (comma == rest.npos) break;
    rest.remove_prefix(comma + 1);
  }
  const std::size_t wanted = implant.kind == "ball" ? 4 : 6;
  if (implant.numbers.size() != wanted)
    refuse_word(word,
                "has " + std::to_string(implant.numbers.size()) + " numbers in place of " + std::to_string(wanted));
  for (std::size_t i = 3; i < wanted; ++i) {
    if (!(implant.numbers[i] > 0.0)) refuse_word(word, "has a size that is not above 0");
  }
}

void read_place(std::string_view rest, const std::string& word, ImplantWord& implant) {
  const std::size_t colon = rest.rfind(':');
  const bool chosen = !is_image_file(std::filesystem::path(rest)) && colon != rest.npos;
  implant.file = std::filesystem::path(chosen ? rest.substr(0, colon) : rest);
  if (chosen) implant.labels = detail::trimmed(rest.substr(colon + 1));
  if (!is_image_file(implant.file)) refuse_word(word, "names no image file (.nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd)");
}

/// One group of the labels that a word names, or of all that the file has.
LabelGroup group_of_word(const ImplantWord& word) {
  if (!word.labels.empty())
    return label_groups(std::vector{word.name + "=" + word.labels}, read_label_names(word.file)).front();
  LabelGroup group{word.name, {}};
  for (const LabelFigures& f : label_figures(read_label_image(word.file))) group.labels.push_back(f.label);
  if (group.labels.empty())
    throw std::invalid_argument("implant \"" + word.name + "\": all voxels of " + word.file.string() + " are 0");
  return group;
}

Implant implant_of_labels(const ImplantWord& word, const CleanLabels& cleaning, int smoothing) {
  const LabelGroup group = group_of_word(word);
  const LabelImage image = read_label_image(word.file, {.crop_to = group.labels, .margin = 2});
  const auto labels = std::make_shared<GroupImage>(clean_labels(image, {group}, cleaning));
  const LabelFields fields = smooth_fields(*labels, {smoothing});
  Implant implant;
  implant.name = word.name;
  implant.labels = labels;
  implant.region = field_region(word.name, fields.fields.front(), fields.bounds.front());
  const Bounds& box = implant.region.bounds;
  implant.center = (box.min + box.max) * 0.5;
  implant.semi_axes = (box.max - box.min) * 0.5;
  std::vector<std::string> lines = image.notes;
  lines.insert(lines.end(), labels->report.begin(), labels->report.end());
  for (const std::string& line : lines) implant.notes.push_back("implant \"" + word.name + "\": " + line);
  return implant;
}

}  // namespace

std::string ImplantWord::text() const {
  return name + "=labels:" + file.string() + (labels.empty() ? "" : ":" + labels);
}

ImplantWord implant_word(const std::string& word) {
  const std::size_t equals = word.find('='), colon = word.find(':');
  if (equals == word.npos || colon == word.npos || colon < equals) refuse_word(word, "has no name or no kind");
  ImplantWord implant;
  implant.name = detail::trimmed(word.substr(0, equals));
  if (implant.name.empty()) refuse_word(word, "has no name");
  implant.kind = detail::trimmed(std::string_view(word).substr(equals + 1, colon - equals - 1));
  const std::string_view rest = std::string_view(word).substr(colon + 1);
  if (implant.kind == "labels") {
    read_place(detail::trimmed(rest), word, implant);
  } else if (implant.kind == "ball" || implant.kind == "ellipsoid") {
    read_shape(rest, word, implant);
  } else {
    refuse_word(word, "is of the kind \"" + implant.kind + "\"");
  }
  return implant;
}

double Implant::volume() const {
  if (labels) return labels->volumes().front();
  return 4.0 / 3.0 * std::numbers::pi * semi_axes.x * semi_axes.y * semi_axes.z;
}

bool Implant::contains(const Vec3d& p) const {
  if (!labels) {
    const Vec3d d = p - center;
    const Vec3d q{d.x / semi_axes.x, d.y / semi_axes.y, d.z / semi_axes.z};
    return dot(q, q) < 1.0;
  }
  const ImageGrid& grid = labels->grid;
  const Vec3d index = grid.index(p);
  std::array<std::size_t, 3> nearest{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double x = std::round(index[a]);
    if (!(x >= 0.0 && x <= static_cast<double>(grid.size[a] - 1))) return false;
    nearest[a] = static_cast<std::size_t>(x);
  }
  return labels->voxels[grid.at(nearest[0], nearest[1], nearest[2])] != 0;
}

double Implant::radius() const { return labels ? norm(semi_axes) : std::max({semi_axes.x, semi_axes.y, semi_axes.z}); }

Implant implant_of(const std::string& text, const CleanLabels& cleaning, int smoothing) {
  const ImplantWord word = implant_word(text);
  if (word.kind == "labels") return implant_of_labels(word, cleaning, smoothing);
  const std::vector<double>& n = word.numbers;
  Implant implant;
  implant.name = word.name;
  implant.center = {n[0], n[1], n[2]};
  const bool ball = word.kind == "ball";
  implant.semi_axes = ball ? Vec3d{0.5 * n[3], 0.5 * n[3], 0.5 * n[3]} : Vec3d{n[3], n[4], n[5]};
  const Vec3d& s = implant.semi_axes;
  implant.region = s.x == s.y && s.y == s.z ? region_of(word.name, Solid(BallShape{implant.center, s.x}))
                                            : region_of(word.name, Solid(EllipsoidShape{implant.center, s, 2.0, 2.0}));
  return implant;
}

}  // namespace glisson::image
