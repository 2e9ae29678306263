// problems.h — everything that is wrong with a scene, said at once and in the order of the file.
#pragma once

#include <string>
#include <vector>

#include "scene/parse/document.h"

namespace glisson::scene {

struct SectionSpec;

/// Collects what is wrong; a fault that several variants inherit is said once.
class Problems {
 public:
  /// @param sections  of the whole document: where a key that is unknown in its place may be at home
  explicit Problems(std::string file, std::vector<const SectionSpec*> sections = {})
      : file_(std::move(file)), sections_(std::move(sections)) {}

  /// @param path  dotted key; empty where the whole scene is meant
  void add(const Origin& where, const std::string& path, const std::string& what);
  /// Number of complaints so far, those inherited by several variants counted each time.
  std::size_t count() const { return complaints_; }
  /// `file:line:column: path`, or `file: --set KEY`.
  std::string locate(const Origin& where, const std::string& path) const;
  const std::string& file() const { return file_; }
  const std::vector<const SectionSpec*>& sections() const { return sections_; }
  /// @throws SceneError with one line for each problem; does nothing where there is none
  void throw_if_any();

 private:
  struct Problem {
    Origin where;
    std::string path, what;
  };
  std::string file_;
  std::vector<const SectionSpec*> sections_;
  std::vector<Problem> found_;
  std::size_t complaints_ = 0;
};

/// `a.b`, or `b` where a is empty.
std::string join_path(const std::string& path, const std::string& key);

}  // namespace glisson::scene
