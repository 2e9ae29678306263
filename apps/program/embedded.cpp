// embedded.cpp — see embedded.h; the bytes come from embedded.S.in, the list of scene files from apps/CMakeLists.txt.
#include "program/embedded.h"

#include <map>
#include <stdexcept>
#include <string>

#define GLISSON_EMBEDDED(name) \
  extern "C" const char name[], name##_end[]  // NOLINT(bugprone-macro-parentheses): a declarator
#define GLISSON_SCENE_FILE(name, path) GLISSON_EMBEDDED(name);
#define GLISSON_DRAWING_FILE(name, path) GLISSON_EMBEDDED(name);
GLISSON_EMBEDDED(glisson_report_template);
GLISSON_EMBEDDED(glisson_live_page);
#include "embedded_list.h"
#undef GLISSON_SCENE_FILE
#undef GLISSON_DRAWING_FILE
#undef GLISSON_EMBEDDED

namespace glisson::app {
namespace {

std::string_view text_between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

const std::map<std::string_view, std::string_view>& scene_files() {
#define GLISSON_SCENE_FILE(name, path) {path, text_between(name, name##_end)},
#define GLISSON_DRAWING_FILE(name, path)
  static const std::map<std::string_view, std::string_view> files{
#include "embedded_list.h"
  };
#undef GLISSON_SCENE_FILE
#undef GLISSON_DRAWING_FILE
  return files;
}

}  // namespace

std::string_view report_template() { return text_between(glisson_report_template, glisson_report_template_end); }
std::string_view live_page() { return text_between(glisson_live_page, glisson_live_page_end); }

std::vector<std::pair<std::string_view, std::string_view>> drawing_files() {
#define GLISSON_SCENE_FILE(name, path)
#define GLISSON_DRAWING_FILE(name, path) {path, text_between(name, name##_end)},
  return {
#include "embedded_list.h"
  };
#undef GLISSON_SCENE_FILE
#undef GLISSON_DRAWING_FILE
}

std::string_view scene_file(std::string_view path) {
  const auto found = scene_files().find(path);
  if (found == scene_files().end()) throw std::out_of_range("the program has no scenes/" + std::string(path));
  return found->second;
}

std::vector<std::string_view> scene_files_in(std::string_view folder) {
  std::vector<std::string_view> paths;
  for (const auto& [path, text] : scene_files()) {
    if (path.starts_with(folder)) paths.push_back(path);
  }
  return paths;
}

}  // namespace glisson::app
