// stiffness.cpp — see stiffness.h.
//
// Bands are a fixed ladder of moduli, E_k = (1 + band)^k Pa, so that the name of a band is all that its tissue needs: it holds E_k to
// 5e-5 of it.
#include "scene/build/stiffness.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>

#include "base/text.h"
#include "glisson/image/body_image.h"
#include "glisson/image/read_image.h"
#include "scene/build/select.h"

namespace glisson {

Fault StiffnessImage::check() const {
  if (loss.empty())
    return {frequency > 0.0 ? "is given without `loss`, the image of G″ that it is of" : "", "frequency"};
  if (!(frequency > 0.0)) return {"is needed with `loss`: G″ is 2π f η", "frequency"};
  if (quantity != StiffnessQuantity::shear_modulus)
    return {"is G″, so the image is one of G′: quantity = \"shear_modulus\"", "loss"};
  return {};
}

namespace scene {
namespace {

constexpr std::string_view kBandUnit = " kPa";
constexpr const char* kWholeBody = "body";

double modulus_of(const StiffnessImage& image, long step) {
  return std::pow(1.0 + image.band, static_cast<double>(step));
}

std::string band_name(const std::string& region, double modulus) {
  return region + " " + detail::number_text(1e-3 * modulus, 4) + std::string(kBandUnit);
}

struct BandName {
  std::string region;
  double modulus = 0.0;  ///< [Pa]; 0: no band
};

BandName band_of(const std::string& name) {
  if (!name.ends_with(kBandUnit)) return {};
  const std::string_view text = std::string_view(name).substr(0, name.size() - kBandUnit.size());
  const std::size_t blank = text.rfind(' ');
  if (blank == text.npos) return {};
  double kilo = 0.0;
  const auto [end, error] = std::from_chars(text.data() + blank + 1, text.data() + text.size(), kilo);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return {std::string(text.substr(0, blank)), 1e3 * kilo};
}

/// Numbers of the regions of a name, bands of it among them; all where there is no name.
std::set<int> numbers_of(const TetMesh& mesh, const std::string& region) {
  std::set<int> numbers;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto name = mesh.region_names.find(mesh.region_of(t));
    const std::string own = name == mesh.region_names.end() ? std::to_string(mesh.region_of(t)) : name->second;
    if (region.empty() || own == region || std::to_string(mesh.region_of(t)) == region)
      numbers.insert(mesh.region_of(t));
  }
  return numbers;
}

const Tissue& tissue_of(const Variant& variant, const TetMesh& mesh, int number, const std::string& name) {
  const auto own = std::find_if(variant.regions.begin(), variant.regions.end(), [&](const RegionSpec& r) {
    return r.name == name || r.name == std::to_string(number) || region_number(mesh, r.name) == number;
  });
  return own == variant.regions.end() ? variant.tissue : own->tissue;
}

std::string name_of(const TetMesh& mesh, int number) {
  const auto name = mesh.region_names.find(number);
  if (name != mesh.region_names.end() && !name->second.empty()) return name->second;
  return mesh.region_names.empty() ? kWholeBody : std::to_string(number);
}

/// E [Pa] of each tet by an image; NaN where it has none.
std::vector<double> moduli_of(const StiffnessImage& image, const TetMesh& mesh, double poisson_ratio) {
  std::vector<double> moduli = tet_means(mesh, read_grey_image(image.path, {.gaps = true}));
  const double factor =
      image.unit * (image.quantity == StiffnessQuantity::shear_modulus ? 2.0 * (1.0 + poisson_ratio) : 1.0);
  for (double& e : moduli) e *= factor;
  return moduli;
}

void split_region(const Variant& variant, const StiffnessImage& image, int number, TetMesh& mesh, std::size_t& found) {
  const std::string name = name_of(mesh, number);
  const Tissue& tissue = tissue_of(variant, mesh, number, name);
  if (tissue.hyperelastic)
    throw std::invalid_argument(image.path.string() + ": the region \"" + name +
                                "\" has a hyperelastic law, which has no Young's modulus; give it another tissue, or "
                                "name other regions in [[stiffness]]");
  const std::vector<double> moduli = moduli_of(image, mesh, tissue.poisson_ratio);
  std::map<long, int> numbers;
  int last = *std::max_element(mesh.regions.begin(), mesh.regions.end());
  if (!mesh.region_names.empty()) last = std::max(last, mesh.region_names.rbegin()->first);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.regions[t] != number || !(moduli[t] > 0.0)) continue;
    ++found;
    const long step = std::lround(std::log(moduli[t]) / std::log1p(image.band));
    const auto [band, is_new] = numbers.try_emplace(step, last + 1);
    if (is_new) mesh.region_names[++last] = band_name(name, modulus_of(image, step));
    mesh.regions[t] = band->second;
  }
}

/// The mean of η = G″ / (2π f) over the tets of a band, by volume; none where the image has no value there.
std::optional<double> band_viscosity(const StiffnessImage& image, const TetMesh& mesh, const std::vector<double>& loss,
                                     int number) {
  double sum = 0.0, volume = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.region_of(t) != number || !(loss[t] >= 0.0)) continue;
    const double v = six_rest_volume(mesh, t);
    sum += v * loss[t] * image.unit;
    volume += v;
  }
  if (!(volume > 0.0)) return {};
  return sum / volume / (2.0 * std::numbers::pi * image.frequency);
}

}  // namespace

void split_by_stiffness(const Variant& variant, TetMesh& mesh) {
  for (const StiffnessImage& image : variant.stiffness) {
    if (mesh.regions.empty()) mesh.regions.assign(mesh.tets.size(), 0);
    const std::set<int> numbers = numbers_of(mesh, image.region);
    if (numbers.empty())
      throw std::invalid_argument(image.path.string() + ": [[stiffness]] names the region \"" + image.region +
                                  "\", which the mesh has not, or an earlier [[stiffness]] has split");
    std::size_t found = 0;
    for (const int number : numbers) split_region(variant, image, number, mesh, found);
    if (found == 0)
      throw std::invalid_argument(image.path.string() + ": has no value above 0 where the " +
                                  (image.region.empty() ? "body" : "region \"" + image.region + "\"") +
                                  " is; `glisson info " + image.path.string() + "` gives its extent");
  }
}

void set_band_tissues(const Variant& variant, const TetMesh& mesh, std::map<int, Tissue>& tissues) {
  for (const StiffnessImage& image : variant.stiffness) {
    std::vector<double> loss;
    if (!image.loss.empty()) loss = tet_means(mesh, read_grey_image(image.loss, {.gaps = true}));
    for (const auto& [number, name] : mesh.region_names) {
      const BandName band = band_of(name);
      const auto tissue = tissues.find(number);
      if (!(band.modulus > 0.0) || tissue == tissues.end()) continue;
      if (!image.region.empty() && band.region != image.region) continue;
      const auto base = std::find_if(mesh.region_names.begin(), mesh.region_names.end(),
                                     [&](const auto& region) { return region.second == band.region; });
      tissue->second = tissue_of(variant, mesh, base == mesh.region_names.end() ? 0 : base->first, band.region);
      tissue->second.youngs_modulus = band.modulus;
      if (loss.empty()) continue;
      if (const auto eta = band_viscosity(image, mesh, loss, number)) tissue->second.viscosity = *eta;
    }
  }
}

}  // namespace scene
}  // namespace glisson
