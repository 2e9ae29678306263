// image_body.cpp — from an image to regions, and to their mesh.
#include "glisson/image/image_body.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "base/nearest.h"
#include "base/require_fields.h"
#include "base/text.h"
#include "glisson/image/read_image.h"
#include "image/body_sets.h"
#include "image/distance_map.h"
#include "image/implant.h"
#include "image/label_fields.h"
#include "image/labels_of_body.h"
#include "image/mesh_pieces.h"
#include "image/size_grid.h"
#include "image/surface_distance.h"
#include "image/thin_parts.h"

namespace glisson {
namespace {

constexpr std::size_t kMargin = 2;  ///< voxels that are read around the labels
constexpr int kSub = 3;             ///< points a voxel's edge by which covered voxels are shared

/// All beyond the faces of the image that cut the body, as a hole: it closes the body flat.
BodyRegion border_region(const GroupImage& labels, const std::vector<Bounds>& boxes) {
  struct Plane {
    Vec3d normal;  ///< outward
    double at;
  };
  std::vector<Plane> planes;
  const Mat3d to_index = inverse(labels.grid.axes);
  for (std::size_t f = 0; f < 6; ++f) {
    if (!labels.cut[f]) continue;
    const std::size_t a = f / 2;
    Vec3d normal = unit(Vec3d{to_index(a, 0), to_index(a, 1), to_index(a, 2)});
    Vec3d index{};
    index[a] = f % 2 == 0 ? -0.5 : static_cast<double>(labels.grid.size[a]) - 0.5;
    if (f % 2 == 0) normal = -normal;
    planes.push_back({normal, dot(normal, labels.grid.world(index))});
  }
  Bounds all = boxes.front();
  for (const Bounds& box : boxes) {
    for (std::size_t d = 0; d < 3; ++d) {
      all.min[d] = std::min(all.min[d], box.min[d]);
      all.max[d] = std::max(all.max[d], box.max[d]);
    }
  }
  const auto distance = [planes](const Vec3d& p) {
    double most = -1e300;
    for (const Plane& plane : planes) most = std::max(most, dot(plane.normal, p) - plane.at);
    return -most;
  };
  return {"border of the image", distance, all, true};
}

CleanLabels cleaning_of(const ImageBody& body) {
  return {body.voxel, body.keep_pieces, body.smallest_piece_ml, body.largest_hole_ml};
}

/// Names of implants, each its own. @throws std::invalid_argument
std::vector<std::string> implant_names(const ImageBody& body, const std::vector<LabelGroup>& groups) {
  std::vector<std::string> taken, names;
  for (const LabelGroup& g : groups) taken.push_back(g.name);
  for (const std::string& text : body.implants) {
    const image::ImplantWord word = image::implant_word(text);
    if (word.kind == "labels" && !word.labels.empty())
      label_groups(std::vector{word.labels}, read_label_names(word.file));
    if (std::find(taken.begin(), taken.end(), word.name) != taken.end())
      throw std::invalid_argument("implant \"" + word.name + "\" has the name of another region; give it its own");
    taken.push_back(word.name);
    names.push_back(word.name);
  }
  return names;
}

std::vector<image::Implant> implants_of(const ImageBody& body) {
  std::vector<image::Implant> implants;
  for (const std::string& word : body.implants)
    implants.push_back(image::implant_of(word, cleaning_of(body), body.smoothing));
  return implants;
}

/// What implants cover: of each group [m³].
std::vector<double> covered(const GroupImage& labels, const std::vector<image::Implant>& implants,
                            std::vector<std::string>& notes) {
  const ImageGrid& grid = labels.grid;
  std::vector<double> by_group(labels.groups.size() + 1, 0.0);
  const double each = grid.voxel_volume() / (kSub * kSub * kSub);
  const double reach = norm(grid.axes * Vec3d{1.0, 1.0, 1.0}) + norm(grid.spacing());
  std::vector<double> inside(implants.size(), 0.0);
  for (std::size_t v = 0; v < labels.voxels.size(); ++v) {
    const auto at = grid.place(v);
    const Vec3d index{static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
    const Vec3d centre = grid.world(index);
    for (std::size_t m = 0; m < implants.size(); ++m) {
      if (norm(centre - implants[m].center) > reach + implants[m].radius()) continue;
      for (int p = 0; p < kSub * kSub * kSub; ++p) {
        const int i = p % kSub, j = p / kSub % kSub, k = p / (kSub * kSub);
        const Vec3d sub{(i + 0.5) / kSub - 0.5, (j + 0.5) / kSub - 0.5, (k + 0.5) / kSub - 0.5};
        const Vec3d point = grid.world(index + sub);
        const bool earlier = std::any_of(implants.begin(), implants.begin() + static_cast<std::ptrdiff_t>(m),
                                         [&](const image::Implant& other) { return other.contains(point); });
        if (earlier || !implants[m].contains(point)) continue;
        by_group[labels.voxels[v]] += each;
        if (labels.voxels[v] > 0) inside[m] += each;
      }
    }
  }
  for (std::size_t m = 0; m < implants.size(); ++m) {
    const double share = inside[m] / implants[m].volume();
    const Vec3d c = implants[m].center * 1e3;
    if (inside[m] <= 0.0)
      throw std::invalid_argument("implant \"" + implants[m].name + "\" lies in none of the regions: its centre is (" +
                                  detail::number_text(c.x) + ", " + detail::number_text(c.y) + ", " +
                                  detail::number_text(c.z) + ") mm in RAS; `glisson info IMAGE` gives their extents");
    if (share < 0.98)
      notes.push_back("implant: " + detail::number_text(100.0 * (1.0 - share), 3) + " % of \"" + implants[m].name +
                      "\" lies outside of the regions, and belongs to the body all the same");
  }
  return by_group;
}

int first_free_number(const LabelImage& image, const std::vector<LabelGroup>& groups) {
  int last = image.names.empty() ? 0 : image.names.rbegin()->first;
  for (const std::uint16_t label : image.voxels) last = std::max<int>(last, label);
  for (const LabelGroup& g : groups) last = std::max(last, *std::max_element(g.labels.begin(), g.labels.end()));
  return last + 1;
}

/// Labels beside the body, none of which is meshed.
std::vector<LabelGroup> beside_groups(const ImageBody& body, const std::vector<LabelGroup>& groups) {
  if (body.beside.empty()) return {};
  std::vector<LabelGroup> beside = label_groups(body.beside, image::label_names(body));
  for (const LabelGroup& b : beside) {
    for (const LabelGroup& g : groups) {
      for (const int label : b.labels) {
        if (std::find(g.labels.begin(), g.labels.end(), label) != g.labels.end())
          throw std::invalid_argument("beside: label " + std::to_string(label) + " is in the region \"" + g.name +
                                      "\", which is meshed; its surface is the set " + g.name + "_surface");
      }
    }
  }
  return beside;
}

RegionMeshOptions mesh_options(const ImageBody& body, const GroupImage& labels, std::function<bool(double)> progress) {
  RegionMeshOptions options;
  options.edge = body.edge;
  options.max_tets = body.max_tets;
  options.progress = std::move(progress);
  options.sizes = body.sizes;
  options.growth = body.growth;
  if (body.edges_across > 0.0)
    options.size_at = image::thin_part_sizes(labels, body.edges_across, body.edge, body.growth);
  if (!body.size_image.empty()) {
    options.size_at = [thin = std::move(options.size_at),
                       sizes = image::image_sizes(body.size_image, body.edge, body.growth)](const Vec3d& p) {
      return thin ? std::min(thin(p), sizes(p)) : sizes(p);
    };
  }
  return options;
}

/// Numbers and names of labels in place of places in the list of regions.
void renumber(const ImageRegions& from, RegionMesh& made) {
  std::map<int, std::string> names;
  for (int& region : made.mesh.regions) region = from.numbers[static_cast<std::size_t>(region) - 1];
  for (const auto& [place, name] : made.mesh.region_names)
    names[from.numbers[static_cast<std::size_t>(place) - 1]] = name;
  made.mesh.region_names = std::move(names);
  for (RegionVolume& v : made.report.regions) v.number = from.numbers[static_cast<std::size_t>(v.number) - 1];
}

}  // namespace

std::vector<std::string> image_set_names(const ImageBody& body) {
  const std::vector<LabelGroup> groups = label_groups(body.labels, image::label_names(body));
  std::vector<std::string> names;
  for (const LabelGroup& g : groups) names.push_back(g.name + "_surface");
  for (const std::string& name : implant_names(body, groups)) names.push_back(name + "_surface");
  for (const LabelGroup& g : beside_groups(body, groups)) names.push_back(g.name);
  names.emplace_back("image_border");
  return names;
}

void resolve_paths(ImageBody& body, const std::filesystem::path& folder) {
  const auto resolve = [&](std::filesystem::path& path) {
    if (!path.empty() && path.is_relative()) path = folder / path;
  };
  resolve(body.path);
  resolve(body.size_image);
  for (std::string& text : body.implants) {
    try {
      image::ImplantWord word = image::implant_word(text);
      if (word.kind != "labels") continue;
      resolve(word.file);
      text = word.text();
    } catch (const std::invalid_argument&) {  // image_set_names says what is wrong
    }
  }
}

double voxel_edge(const ImageBody& body) {
  return body.voxel > 0.0 ? body.voxel : std::cbrt(image::whole_grid(body).voxel_volume());
}

ImageRegions image_regions(const ImageBody& body) {
  detail::require_fields("image", body);
  const std::vector<LabelGroup> groups = label_groups(body.labels, image::label_names(body));
  implant_names(body, groups);
  ReadImageOptions reading;
  reading.margin = kMargin;
  for (const LabelGroup& g : groups) reading.crop_to.insert(reading.crop_to.end(), g.labels.begin(), g.labels.end());
  const std::vector<LabelGroup> beside = beside_groups(body, groups);
  if (!beside.empty()) {
    const Vec3d spacing = image::whole_grid(body).spacing();
    reading.margin +=
        static_cast<std::size_t>(std::ceil(body.beside_within / std::min({spacing.x, spacing.y, spacing.z}))) + 1;
  }
  const LabelImage image = image::body_labels(body, reading);
  ImageRegions out;
  out.labels = clean_labels(image, groups, cleaning_of(body));
  out.notes = image.notes;
  out.notes.insert(out.notes.end(), out.labels.report.begin(), out.labels.report.end());

  out.add_sets = [labels = out.labels, near = image::near_labels(image, beside),
                  within = body.beside_within](TetMesh& mesh) { image::add_body_sets(mesh, labels, near, within); };

  int number = first_free_number(image, groups);
  const std::vector<image::Implant> implants = implants_of(body);
  const std::vector<double> taken = covered(out.labels, implants, out.notes);
  for (const image::Implant& implant : implants) {
    out.regions.push_back(implant.region);
    out.numbers.push_back(number++);
    out.image_volumes.push_back(implant.volume());
    out.notes.insert(out.notes.end(), implant.notes.begin(), implant.notes.end());
  }
  for (const image::Implant& implant : implants) out.implant_pieces.push_back(implant.pieces());
  out.measure = [labels = out.labels, implants](const TetMesh& mesh, std::vector<ImageRegion>& regions) {
    image::measure_distances(labels, implants, mesh, regions);
  };
  const image::LabelFields fields = image::smooth_fields(out.labels, {body.smoothing});
  if (std::find(out.labels.cut.begin(), out.labels.cut.end(), true) != out.labels.cut.end()) {
    out.regions.push_back(border_region(out.labels, fields.bounds));
    out.numbers.push_back(0);
    out.image_volumes.push_back(0.0);
  }
  const std::vector<double> volumes = out.labels.volumes();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    out.regions.push_back(image::field_region(groups[g].name, fields.fields[g], fields.bounds[g]));
    out.numbers.push_back(groups[g].number());
    out.image_volumes.push_back(volumes[g] - taken[g + 1]);
  }
  return out;
}

namespace {

constexpr int kMostTries =
    40;  ///< meshes of a body, each finer where the last one tore or lost a region: all halvings of 12 regions
constexpr int kMostRefined =
    3;  ///< of them, where no region was lost: pieces that touch at edges may never come out as in the image
constexpr int kMostHalvings = 3;                       ///< of the edges in a region
constexpr double kVolumeOff = 0.03, kSmallOff = 0.05;  ///< of a region's volume
constexpr double kSmall = 5e-6;                        ///< region for which the second holds [m³]
constexpr double kMostOfBall =
    1.3;  ///< edge over the radius of the largest ball in a region above which it has been lost

/// Regions that a mesh has torn, joined, or of another volume than their voxels.
std::vector<std::string> poorly_meshed(const std::vector<ImageRegion>& regions) {
  std::vector<std::string> names;
  for (const ImageRegion& r : regions) {
    const double off = std::abs(r.volume / r.image_volume - 1.0);
    if (r.pieces != r.image_pieces || off > (r.image_volume < kSmall ? kSmallOff : kVolumeOff)) names.push_back(r.name);
  }
  return names;
}

/// The regions of a mesh that is numbered by labels, without distances.
std::vector<ImageRegion> measured(const ImageRegions& from, const TetMesh& mesh) {
  std::vector<ImageRegion> regions;
  std::map<int, std::size_t> place;
  const std::vector<std::size_t> image_pieces = from.labels.pieces();
  for (std::size_t r = 0; r < from.regions.size(); ++r) {
    if (from.numbers[r] == 0) continue;
    ImageRegion region;
    region.name = from.regions[r].name;
    region.label = from.numbers[r];
    region.image_volume = from.image_volumes[r];
    region.image_pieces = r < from.implant_pieces.size() ? from.implant_pieces[r] : 1;
    for (std::size_t g = 0; g < from.labels.groups.size(); ++g) {
      if (from.labels.groups[g].name == region.name) region.image_pieces = image_pieces[g];
    }
    place[region.label] = regions.size();
    regions.push_back(region);
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    ImageRegion& region = regions[place.at(mesh.regions[t])];
    ++region.tets;
    region.volume += six_rest_volume(mesh, t) / 6.0;
  }
  for (const auto& [label, pieces] : image::mesh_pieces(mesh)) regions[place.at(label)].pieces = pieces;
  return regions;
}

/// Takes what tets were given away into account: volumes and angles of the mesher's report.
void update_report(const std::vector<ImageRegion>& regions, RegionMeshReport& report) {
  for (RegionVolume& v : report.regions) {
    for (const ImageRegion& r : regions) {
      if (r.label == v.number) v.tets = r.tets, v.volume = r.volume;
    }
  }
}

void measure_angles(const TetMesh& mesh, RegionMeshReport& report) {
  report.min_dihedral_deg = 180.0, report.max_dihedral_deg = 0.0;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    for (const double angle : dihedral_angles(mesh, t)) {
      report.min_dihedral_deg = std::min(report.min_dihedral_deg, angle);
      report.max_dihedral_deg = std::max(report.max_dihedral_deg, angle);
    }
  }
}

RegionMesh numbered_mesh(const ImageRegions& from, const RegionMeshOptions& options, std::vector<std::string>& notes) {
  RegionMesh made = mesh_regions(from.regions, options);
  renumber(from, made);
  std::map<int, std::size_t> pieces;
  for (const ImageRegion& r : measured(from, made.mesh)) pieces[r.label] = r.image_pieces;
  image::flatten_border(made.mesh, from.labels, options.edge);
  measure_angles(made.mesh, made.report);
  const double voxel = from.labels.grid.voxel_volume();
  if (const std::size_t specks = image::absorb_specks(made.mesh, voxel, pieces))
    notes.push_back("mesh: " + detail::count_text(specks, "piece", "pieces") +
                    " of less than a voxel given to what is around");
  return made;
}

/// Those of the regions that came out poorly that may get shorter edges.
std::vector<std::string> refinable(const ImageBody& body, const std::vector<std::string>& poor, int tries,
                                   const std::map<std::string, int>& halved) {
  std::vector<std::string> names;
  if (!body.refine || tries >= kMostTries) return names;
  for (const std::string& name : poor) {
    const auto it = halved.find(name);
    if (it == halved.end() || it->second < kMostHalvings) names.push_back(name);
  }
  return names;
}

void refine(const std::string& name, double edge, std::vector<MeshSize>& sizes) {
  MeshSize size;
  size.edge = edge;
  size.near = name;
  sizes.push_back(size);
}

/// A place as a person finds it: the voxel of the image, resampled or not, and RAS.
std::string place_text(const ImageBody& body, const GroupImage& labels, std::size_t voxel) {
  const auto at = labels.grid.place(voxel);
  const Vec3d p =
      labels.grid.world({static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
  const Vec3d index = image::whole_grid(body).index(p);
  const auto whole = [](double x) { return std::to_string(std::lround(x)); };
  const auto mm = [](double x) { return detail::number_text(std::round(1e4 * x) / 10.0, 6); };
  return "voxel (" + whole(index.x) + ", " + whole(index.y) + ", " + whole(index.z) + "), at (" + mm(p.x) + ", " +
         mm(p.y) + ", " + mm(p.z) + ") mm in RAS";
}

/// A region of an image that came out without a tet, with its first voxel.
RegionLost lost_region(const RegionLost& lost, const ImageBody& body, const ImageRegions& from, double edge) {
  std::string place;
  for (std::size_t g = 0; g < from.labels.groups.size(); ++g) {
    if (from.labels.groups[g].name != lost.name) continue;
    const auto first = std::find(from.labels.voxels.begin(), from.labels.voxels.end(), g + 1);
    place = " (" + place_text(body, from.labels, static_cast<std::size_t>(first - from.labels.voxels.begin())) + ")";
  }
  return {lost.name,
          "region \"" + lost.name + "\"" + place + " is left without a tet by edges of " +
              detail::number_text(1e3 * edge, 3) +
              " mm: it is too thin for them, or regions before it cover it; give shorter edges there, join it "
              "with another label, or leave it out"};
}

/// Halvings of the edges of regions in which no ball fits that such edges mesh: these would be lost or torn.
std::map<std::string, int> first_halvings(const ImageBody& body, const GroupImage& labels) {
  std::map<std::string, int> halved;
  std::vector<char> set(labels.voxels.size());
  for (std::size_t g = 0; body.refine && g < labels.groups.size(); ++g) {
    for (std::size_t v = 0; v < set.size(); ++v) set[v] = labels.voxels[v] != g + 1;
    const std::vector<float> inner = image::distance_to(labels.grid.size, labels.grid.spacing(), set);
    double radius = 0.0;
    for (std::size_t v = 0; v < set.size(); ++v) {
      if (set[v] == 0) radius = std::max<double>(radius, inner[v]);
    }
    int& times = halved[labels.groups[g].name];
    while (times < kMostHalvings && body.edge * std::exp2(-times) > kMostOfBall * radius) ++times;
  }
  return halved;
}

void warn_of(const std::vector<std::string>& poor, double edge, RegionMeshReport& report) {
  for (const std::string& name : poor)
    report.warnings.push_back(
        "region \"" + name +
        "\" has other pieces or another volume than its voxels: parts of it are thin for edges of " +
        detail::number_text(1e3 * edge, 3) + " mm; give shorter ones, or edges_across");
}

}  // namespace

ImageMesh image_mesh(const ImageBody& body, std::function<bool(double)> progress) {
  ImageMesh out;
  out.from = image_regions(body);
  const ImageRegions& from = out.from;
  RegionMeshOptions options = mesh_options(body, from.labels, std::move(progress));
  out.notes = from.notes;
  std::map<std::string, int> halved =
      first_halvings(body, from.labels);  // regions whose edges were halved, and how often
  for (const auto& [name, times] : halved) {
    if (times == 0) continue;
    refine(name, body.edge * std::exp2(-times), options.sizes);
    out.notes.push_back("mesh: edges of " + detail::number_text(1e3 * body.edge * std::exp2(-times), 3) + " mm in " +
                        name + ", which is thin");
  }
  int refined = 0;
  for (int tries = 1;; ++tries) {
    std::vector<std::string> notes, poor;
    bool whole = true;
    try {
      RegionMesh made = numbered_mesh(from, options, notes);
      out.mesh = std::move(made.mesh);
      out.report = std::move(made.report);
      out.regions = measured(from, out.mesh);
      update_report(out.regions, out.report);
      poor = poorly_meshed(out.regions);
    } catch (const RegionLost& lost) {
      if (!body.refine || tries == kMostTries || halved[lost.name] == kMostHalvings)
        throw lost_region(lost, body, from, body.edge * std::exp2(-halved[lost.name]));
      poor = {lost.name};
      whole = false;
    }
    refined += whole;
    const std::vector<std::string> finer = refinable(body, poor, refined < kMostRefined ? tries : kMostTries, halved);
    if (finer.empty()) {
      out.notes.insert(out.notes.end(), notes.begin(), notes.end());
      warn_of(poor, body.edge, out.report);
      break;
    }
    for (const std::string& name : finer) {
      const double edge = body.edge * std::exp2(-++halved[name]);
      refine(name, edge, options.sizes);
      out.notes.push_back("mesh: edges of " + detail::number_text(1e3 * edge, 3) + " mm in " + name +
                          ", which longer ones would tear or shrink");
    }
  }
  from.add_sets(out.mesh);
  out.sizes = options.sizes;
  return out;
}

void measure_distances(ImageMesh& made) { made.from.measure(made.mesh, made.regions); }

std::vector<double> edges_asked(const ImageBody& body, const ImageMesh& made) {
  RegionMeshOptions options = mesh_options(body, made.from.labels, {});
  options.sizes = made.sizes;
  return edges_asked(made.mesh, made.from.regions, options);
}

}  // namespace glisson
