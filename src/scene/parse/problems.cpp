#include "scene/parse/problems.h"

#include <algorithm>
#include <tuple>

#include "glisson/scene/scene.h"

namespace glisson::scene {
namespace {

constexpr std::size_t kMostShown = 20;

}  // namespace

void Problems::add(const Origin& where, const std::string& path, const std::string& what) {
  ++complaints_;
  const auto same = [&](const Problem& p) {
    return std::tie(p.where.line, p.where.column, p.where.override_key, p.what) ==
           std::tie(where.line, where.column, where.override_key, what);
  };
  if (std::none_of(found_.begin(), found_.end(), same)) found_.push_back({where, path, what});
}

std::string Problems::locate(const Origin& where, const std::string& path) const {
  if (!where.override_key.empty()) {
    const std::string origin = file_ + ": --set " + where.override_key;
    return path.empty() || path == where.override_key ? origin : origin + ": " + path;
  }
  const std::string origin = file_ + ":" + std::to_string(where.line) + ":" + std::to_string(where.column);
  return path.empty() ? origin : origin + ": " + path;
}

void Problems::throw_if_any() {
  if (found_.empty()) return;
  std::stable_sort(found_.begin(), found_.end(), [](const Problem& a, const Problem& b) {
    return std::tie(a.where.line, a.where.column) < std::tie(b.where.line, b.where.column);
  });
  std::string text;
  for (std::size_t i = 0; i < std::min(found_.size(), kMostShown); ++i) {
    if (i > 0) text += '\n';
    text += locate(found_[i].where, found_[i].path) + ": " + found_[i].what;
  }
  if (found_.size() > kMostShown) text += "\n… and " + std::to_string(found_.size() - kMostShown) + " more";
  throw SceneError(text);
}

std::string join_path(const std::string& path, const std::string& key) { return path.empty() ? key : path + "." + key; }

}  // namespace glisson::scene
