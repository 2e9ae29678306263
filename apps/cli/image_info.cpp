// image_info.cpp — grid, labels, volumes, pieces and extents of an image, as lines or as JSON.
#include "cli/image_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "glisson/image/clean_labels.h"
#include "glisson/image/read_image.h"
#include "program/exit_code.h"
#include "program/standard_streams.h"
#include "report/json_text.h"

namespace glisson::app {
namespace {

using Json = nlohmann::ordered_json;

struct WorldBox {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
};

/// The box in space around voxels from one to another, with their halves [m].
WorldBox box_of_voxels(const ImageGrid& grid, const std::array<std::size_t, 3>& low,
                       const std::array<std::size_t, 3>& high) {
  WorldBox box;
  for (std::size_t c = 0; c < 8; ++c) {
    Vec3d index{};
    for (std::size_t a = 0; a < 3; ++a)
      index[a] = (c >> a) & 1 ? static_cast<double>(high[a]) + 0.5 : static_cast<double>(low[a]) - 0.5;
    const Vec3d p = grid.world(index);
    for (std::size_t d = 0; d < 3; ++d) {
      box.low[d] = std::min(box.low[d], p[d]);
      box.high[d] = std::max(box.high[d], p[d]);
    }
  }
  return box;
}

WorldBox whole_box(const ImageGrid& grid) {
  return box_of_voxels(grid, {0, 0, 0}, {grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1});
}

Json in_mm(const Vec3d& v) { return {1e3 * v.x, 1e3 * v.y, 1e3 * v.z}; }

Json frame_json(const std::string& file, const ImageFrame& image, const char* kind) {
  Json json;
  json["file"] = file;
  json["kind"] = kind;
  json["size"] = image.grid.size;
  json["spacing_mm"] = in_mm(image.grid.spacing());
  json["axes"] = "RAS";
  Json rows = Json::array();
  for (std::size_t r = 0; r < 3; ++r)
    rows.push_back({1e3 * image.grid.axes(r, 0), 1e3 * image.grid.axes(r, 1), 1e3 * image.grid.axes(r, 2),
                    1e3 * image.grid.origin[r]});
  json["index_to_mm"] = rows;
  json["notes"] = image.notes;
  return json;
}

void say_frame(const std::string& file, const ImageFrame& image, const char* kind) {
  const ImageGrid& g = image.grid;
  const Vec3d s = g.spacing() * 1e3;
  const WorldBox box = whole_box(g);
  say("{}: {} image, {} × {} × {} voxels of {:.6g} × {:.6g} × {:.6g} mm\n", file, kind, g.size[0], g.size[1], g.size[2],
      s.x, s.y, s.z);
  say("  axes RAS (x right, y front, z head): {:.1f} to {:.1f}, {:.1f} to {:.1f}, {:.1f} to {:.1f} mm\n",
      1e3 * box.low.x, 1e3 * box.high.x, 1e3 * box.low.y, 1e3 * box.high.y, 1e3 * box.low.z, 1e3 * box.high.z);
  for (const std::string& note : image.notes) say("  note: {}\n", note);
}

void say_labels(const LabelImage& image, const std::vector<LabelFigures>& labels) {
  if (labels.empty()) return say("  no labels: all voxels are 0\n");
  std::size_t widest = 4;
  for (const LabelFigures& f : labels) widest = std::max(widest, f.name.size());
  say("  {:>5}  {:<{}}  {:>10}  {:>6}  extent in mm (x, y, z)\n", "label", "name", widest, "volume/mL", "pieces");
  bool cut = false;
  for (const LabelFigures& f : labels) {
    const WorldBox box = box_of_voxels(image.grid, f.low, f.high);
    say("  {:>5}  {:<{}}  {:>10.4g}  {:>6}  {:.0f} to {:.0f}, {:.0f} to {:.0f}, {:.0f} to {:.0f}{}\n", f.label, f.name,
        widest, 1e6 * f.volume, f.pieces, 1e3 * box.low.x, 1e3 * box.high.x, 1e3 * box.low.y, 1e3 * box.high.y,
        1e3 * box.low.z, 1e3 * box.high.z, f.at_border ? "  *" : "");
    cut = cut || f.at_border;
  }
  if (cut) say("  * reaches the border of the image, which may cut it\n");
}

Json labels_json(const LabelImage& image, const std::vector<LabelFigures>& labels) {
  Json list = Json::array();
  for (const LabelFigures& f : labels) {
    const WorldBox box = box_of_voxels(image.grid, f.low, f.high);
    list.push_back({{"label", f.label},
                    {"name", f.name},
                    {"voxels", f.voxels},
                    {"volume_ml", 1e6 * f.volume},
                    {"pieces", f.pieces},
                    {"largest_piece_ml", 1e6 * f.largest_piece},
                    {"first_voxel", f.low},
                    {"last_voxel", f.high},
                    {"box_min_mm", in_mm(box.low)},
                    {"box_max_mm", in_mm(box.high)},
                    {"at_border", f.at_border}});
  }
  return list;
}

/// @param why  it is none of labels
int grey_info(const std::string& file, bool as_json, const std::string& why) {
  const GreyImage image = read_grey_image(file, {.gaps = true});
  std::vector<float> values = image.voxels;
  std::erase_if(values, [](float v) { return std::isnan(v); });
  const std::size_t without = image.voxels.size() - values.size();
  if (values.empty()) values.push_back(std::numeric_limits<float>::quiet_NaN());
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  if (as_json) {
    Json json = frame_json(file, image, "grey");
    json["least"] = *low, json["largest"] = *high, json["mean"] = mean, json["voxels_without_value"] = without;
    json["no_labels_because"] = why;
    say("{}\n", json_text(json, 2));
    return kDone;
  }
  say_frame(file, image, "grey");
  say("  values {:.6g} to {:.6g}, mean {:.6g}\n", *low, *high, mean);
  if (without > 0) say("  {} of {} voxels have no value (NaN)\n", without, image.voxels.size());
  say("  no image of labels: {}\n", why);
  return kDone;
}

}  // namespace

int image_info(const std::string& file, bool as_json) {
  LabelImage image;
  try {
    image = read_label_image(file);
  } catch (const NotLabels& error) {
    return grey_info(file, as_json, error.what());
  }
  const std::vector<LabelFigures> labels = label_figures(image);
  if (as_json) {
    Json json = frame_json(file, image, "labels");
    json["labels"] = labels_json(image, labels);
    say("{}\n", json_text(json, 2));
    return kDone;
  }
  say_frame(file, image, "label");
  say_labels(image, labels);
  return kDone;
}

}  // namespace glisson::app
