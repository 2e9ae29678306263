#include "fit/forward/offset_model.h"

#include <stdexcept>

namespace glisson::fit {
namespace {

constexpr std::string_view kPrefix = "curve.", kContact = "contact_mm", kForce = "force_offset_N";

bool ends_with(std::string_view text, std::string_view end) { return text.size() >= end.size() && text.ends_with(end); }

/// A curve key taken apart.
struct CurveKey {
  bool force = false;
  std::string curve;  ///< empty: all
};

CurveKey curve_key(const std::string& key) {
  const bool force = ends_with(key, kForce);
  const std::size_t last = key.size() - (force ? kForce : kContact).size() - 1;  // the dot before it
  std::string name;
  if (last >= kPrefix.size()) name = key.substr(kPrefix.size(), last - kPrefix.size());
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  return {force, name};
}

}  // namespace

bool is_curve_key(const std::string& key) {
  return key.starts_with(kPrefix) &&
         (ends_with(key, "." + std::string(kContact)) || ends_with(key, "." + std::string(kForce)));
}

std::vector<std::string> inner_keys(std::span<const std::string> keys) {
  std::vector<std::string> inner;
  for (const std::string& key : keys) {
    if (!is_curve_key(key)) inner.push_back(key);
  }
  return inner;
}

std::vector<ContactRange> contact_ranges(std::span<const Parameter> parameters, std::span<const Curve> curves) {
  std::vector<ContactRange> ranges(curves.size());
  for (const Parameter& p : parameters) {
    if (!is_curve_key(p.name)) continue;
    const auto [force, name] = curve_key(p.name);
    for (std::size_t c = 0; c < curves.size() && !force; ++c) {
      if (!name.empty() && curves[c].name != name) continue;
      ranges[c].low += 1e-3 * p.low;
      ranges[c].high += 1e-3 * p.high;
    }
  }
  return ranges;
}

OffsetModel::OffsetModel(std::shared_ptr<const MotionModel> inner, std::span<const std::string> keys)
    : inner_(std::move(inner)) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (!is_curve_key(keys[i])) {
      passed_.push_back(i);
      continue;
    }
    const auto [force, name] = curve_key(keys[i]);
    bool known = name.empty();
    std::string names;
    for (std::size_t c = 0; c < inner_->curves(); ++c) {
      known = known || inner_->curve(c).name == name;
      names += (c ? ", " : "") + inner_->curve(c).name;
    }
    if (!known) {
      std::string what = keys[i];
      throw std::invalid_argument(what.append(": no curve \"").append(name).append("\"; there are: ").append(names));
    }
    for (std::size_t c = 0; c < inner_->curves() && force; ++c) {
      const Curve& curve = inner_->curve(c);
      if (curve.measurement.loaded() && (name.empty() || curve.name == name))
        throw std::invalid_argument(keys[i] + ": curve \"" + curve.name +
                                    "\" is driven by its force, which has no offset; give contact_mm, or name "
                                    "another curve: curve.NAME.force_offset_N");
    }
    offsets_.push_back({i, force, name});
  }
}

Prediction OffsetModel::predict(std::size_t curve, std::span<const double> values) const {
  std::vector<double> passed;
  for (const std::size_t i : passed_) passed.push_back(values[i]);
  double contact = 0.0, force = 0.0;
  for (const Offset& o : offsets_) {
    if (!o.curve.empty() && o.curve != inner_->curve(curve).name) continue;
    (o.force ? force : contact) += o.force ? values[o.parameter] : 1e-3 * values[o.parameter];
  }
  Prediction result = inner_->predict_from(curve, passed, contact);
  for (double& f : result.force) f += force;
  return result;
}

}  // namespace glisson::fit
